import type { State } from './protocol';
import { byId } from './dom';
import type { Signal } from './signal';
import { offerCamera } from './tools';

/// Where a program renders the scene, what would change it rests.
export function startReadOnly(state: Signal<State | null>): void {
  let canEdit = true;
  state.onChange((now) => {
    if (!now || now.can_edit === canEdit) return;
    canEdit = now.can_edit;
    byId('scene-note').hidden = canEdit;
    byId('scene-parameters').hidden = !canEdit;
    byId<HTMLSelectElement>('integrator').disabled = !canEdit;
    byId<HTMLInputElement>('fov').disabled = !canEdit;
    byId<HTMLButtonElement>('home').disabled = !canEdit;
    offerCamera(canEdit);
  });
}
