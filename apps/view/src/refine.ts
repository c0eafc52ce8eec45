import type { Client, Rectangle, RefinedRegion, State } from './protocol';
import { byId, setText } from './dom';
import type { Signal } from './signal';

const usualPasses = 16;
const mostPasses = 4096; // that the server takes at a time

/// More samples in the region that is drawn.
export class Refine {
  private readonly box = byId('refine');
  private readonly button = byId<HTMLButtonElement>('refine-more');
  private readonly passes = byId<HTMLInputElement>('refine-passes');

  constructor(
    private readonly client: Client,
    private readonly state: Signal<State | null>,
    private readonly rectangle: Signal<Rectangle | null>,
    private readonly onError: (error: unknown) => void,
  ) {
    this.button.addEventListener('click', () => void this.ask());
    this.passes.addEventListener('change', () => (this.passes.value = String(this.wanted())));
    state.onChange(() => this.show());
    rectangle.onChange(() => this.show());
    this.show();
  }

  async ask(): Promise<void> {
    const region = this.rectangle.value;
    if (!region || this.button.disabled) return;
    byId('refine-note').scrollIntoView({ block: 'nearest' });
    try {
      await this.client.command({ refine: { ...region, passes: this.wanted() } });
    } catch (error) {
      this.onError(error);
    }
  }

  private wanted(): number {
    const typed = Math.round(Number(this.passes.value));
    return Math.min(mostPasses, Math.max(1, Number.isFinite(typed) && typed > 0 ? typed : usualPasses));
  }

  private show(): void {
    const region = this.rectangle.value;
    const state = this.state.value;
    this.box.hidden = !region;
    if (!region || !state) return;
    const canRefine = (state.state === 'rendering' || state.state === 'paused') && !state.is_moving;
    this.button.disabled = !canRefine;
    setText(byId('refine-note'), canRefine ? noteOf(state, region) : 'Once the render has a pass at rest.');
  }
}

function noteOf(state: State, region: Rectangle): string {
  const known = state.regions.find((other) => isSame(other, region));
  const others = state.regions.filter((other) => other !== known && other.waiting > 0);
  const pending = others.reduce((sum, { waiting }) => sum + waiting, 0);
  if (!known) return pending ? `${pending} passes of other regions come first.` : '';
  if (known.waiting === 0) return `${known.passes} passes of its own, beside ${state.passes} of the picture.`;
  const paused = state.state === 'paused' ? ' It goes on with the render.' : '';
  return `${known.passes} of ${known.passes + known.waiting} passes of its own.${paused}`;
}

function isSame(a: RefinedRegion, b: Rectangle): boolean {
  return a.x === b.x && a.y === b.y && a.width === b.width && a.height === b.height;
}
