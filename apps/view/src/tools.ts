import { byId } from './dom';
import { Signal } from './signal';

/// What a drag on the picture does.
export type Tool = 'camera' | 'picture' | 'probe' | 'region';

export const tool = new Signal<Tool>('camera');

export function startTools(stage: HTMLElement): void {
  const bar = byId('tools');
  bar.addEventListener('click', (event) => {
    const chosen = (event.target as Element).closest<HTMLElement>('[data-tool]')?.dataset.tool;
    if (chosen) tool.value = chosen as Tool;
  });
  tool.watch((now) => {
    for (const button of bar.querySelectorAll<HTMLElement>('[data-tool]'))
      button.setAttribute('aria-pressed', String(button.dataset.tool === now));
    stage.dataset.tool = now;
  });
}
