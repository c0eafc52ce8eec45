import { byId } from './dom';
import { Signal } from './signal';

/// What a drag on the picture does.
export type Tool = 'camera' | 'picture' | 'probe' | 'region';

export const tool = new Signal<Tool>('camera');
let offersCamera = true;

export function chooseTool(name: Tool): void {
  if (name !== 'camera' || offersCamera) tool.value = name;
}

/// Whether there is a camera to be moved.
export function offerCamera(isOffered: boolean): void {
  offersCamera = isOffered;
  byId('tools').querySelector<HTMLButtonElement>('[data-tool=camera]')!.disabled = !isOffered;
  if (!isOffered && tool.value === 'camera') tool.value = 'picture';
}

export function startTools(stage: HTMLElement): void {
  const bar = byId('tools');
  bar.addEventListener('click', (event) => {
    const chosen = (event.target as Element).closest<HTMLElement>('[data-tool]')?.dataset.tool;
    if (chosen) chooseTool(chosen as Tool);
  });
  tool.watch((now) => {
    for (const button of bar.querySelectorAll<HTMLElement>('[data-tool]'))
      button.setAttribute('aria-pressed', String(button.dataset.tool === now));
    stage.dataset.tool = now;
  });
}
