import { paletteBytes } from './color';
import { byId, fitCanvas, make, setText } from './dom';
import type { Display } from './display';
import { formatNumber } from './numbers';
import { positionOf, ticksOf } from './scale';
import type { Signal } from './signal';
import type { State } from './protocol';
import { photometry, shownFactor, shownUnit } from './units';

/// The scale of false colours beside the picture.
export class Legend {
  private readonly box = byId('legend');
  private readonly bar = byId<HTMLCanvasElement>('legend-bar');
  private readonly ticks = byId('legend-ticks');
  private readonly unit = byId('legend-unit');

  constructor(
    private readonly display: Display,
    private readonly state: Signal<State | null>,
  ) {
    for (const signal of [display.look, display.asked, state, photometry] as Signal<unknown>[])
      signal.onChange(() => this.draw());
  }

  draw(): void {
    const { look, kind } = this.display;
    this.box.hidden = look.value.operator !== 'falsecolor';
    if (this.box.hidden) return;
    const unit = this.state.value?.unit ?? '';
    setText(this.unit, kind.isLight ? shownUnit(unit) : kind.id === 'depth' ? 'scene units' : '');
    this.drawBar();
    const factor = kind.isLight ? shownFactor() : 1;
    const { scale } = look.value;
    this.ticks.replaceChildren(
      ...ticksOf(scale).map((value) => {
        const tick = make('span', {}, formatNumber(value * factor, 3));
        tick.style.bottom = `${100 * positionOf(value, scale)}%`;
        return tick;
      }),
    );
  }

  private drawBar(): void {
    fitCanvas(this.bar);
    const context = this.bar.getContext('2d')!;
    const { width, height } = this.bar;
    const colours = paletteBytes(this.display.look.value.isSigned);
    for (let y = 0; y < height; ++y) {
      const i = 4 * Math.round((255 * (height - 1 - y)) / Math.max(1, height - 1));
      context.fillStyle = `rgb(${colours[i]}, ${colours[i + 1]}, ${colours[i + 2]})`;
      context.fillRect(0, y, width, 1);
    }
  }
}
