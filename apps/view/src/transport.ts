import type { Action, Client, State } from './protocol';
import { byId, setText } from './dom';
import { formatCount, formatPercent, formatTime } from './numbers';
import type { Signal } from './signal';

const words: Record<State['state'], string> = {
  idle: 'Stopped', building: 'Building', rendering: 'Rendering', paused: 'Paused', finished: 'Finished', failed: 'Failed',
};

/// Start, pause, stop; how far the render is; which integrator.
export class Transport {
  private readonly play = byId<HTMLButtonElement>('play');
  private readonly stopButton = byId<HTMLButtonElement>('stop');
  private readonly integrators = byId<HTMLSelectElement>('integrator');

  constructor(
    private readonly client: Client,
    private readonly state: Signal<State | null>,
    private readonly onError: (error: unknown) => void,
  ) {
    this.play.addEventListener('click', () => this.toggle());
    this.stopButton.addEventListener('click', () => this.act('stop'));
    byId('undo-edits').addEventListener('click', () => this.act('reset'));
    this.integrators.addEventListener('change', () => void this.send({ integrator: this.integrators.value }));
    state.onChange((value) => value && this.show(value));
  }

  toggle(): void {
    if (this.play.disabled) return;
    const now = this.state.value?.state;
    if (now === 'rendering' || now === 'building') this.act('pause');
    else this.act(now === 'paused' ? 'resume' : 'start');
  }

  private act(action: Action): void {
    void this.send({ do: action });
  }

  private async send(command: { do: Action } | { integrator: string }): Promise<void> {
    try {
      await this.client.command(command);
    } catch (error) {
      this.onError(error);
      const { value } = this.state;
      if (value) this.integrators.value = value.integrator;
    }
  }

  private show(state: State): void {
    const isRunning = state.state === 'rendering' || state.state === 'building';
    this.play.dataset.shows = isRunning ? 'pause' : 'play';
    const label = isRunning ? 'Pause' : state.state === 'paused' ? 'Resume' : 'Start';
    this.play.setAttribute('aria-label', label);
    this.play.title = `${label} (Space)`;
    // A program begins its renders itself.
    this.play.disabled = label === 'Start' && !state.can_edit;
    this.stopButton.disabled = state.state === 'idle' || state.state === 'finished' || state.state === 'failed';
    this.integrators.dataset.now = state.integrator;
    if (document.activeElement !== this.integrators) this.integrators.value = state.integrator;
    const chip = byId('state');
    chip.dataset.state = state.state;
    setText(chip, words[state.state] ?? state.state);
    setText(byId('passes'), String(state.passes));
    setText(byId('samples'), formatCount(state.samples));
    setText(byId('elapsed'), formatTime(state.elapsed_s));
    setText(byId('error'), state.error === null ? '–' : formatPercent(state.error));
  }
}
