import type { Client, Pixel, State } from './protocol';
import { luminance, srgbFromLinear } from './color';
import { byId, make, setText } from './dom';
import { Latest } from './latest';
import { kindOf, titleOf } from './layers';
import { formatInterval, formatNumber, formatWithError } from './numbers';
import { Signal } from './signal';
import { photometry, shownFactor, shownUnit } from './units';

interface Point {
  x: number;
  y: number;
}

/// What is known of the pixel under the pointer, or of the one that was clicked.
export class Probe {
  readonly pinned = new Signal<Point | null>(null);
  readonly hovered = new Signal<Point | null>(null);
  private readonly answer = new Signal<Pixel | null>(null);
  private readonly asker: Latest<Point>;
  private readonly fields = { x: byId<HTMLInputElement>('probe-x'), y: byId<HTMLInputElement>('probe-y') };
  private readonly unpin = byId<HTMLButtonElement>('probe-unpin');
  private lastRefresh = 0;

  constructor(
    client: Client,
    private readonly state: Signal<State | null>,
    onError: (error: unknown) => void,
  ) {
    this.asker = new Latest<Point>(async ({ x, y }) => {
      try {
        this.answer.value = await client.pixel(x, y);
      } catch (error) {
        onError(error);
      }
    }, 70);
    this.pinned.onChange(() => this.ask());
    this.hovered.onChange(() => this.pinned.value || this.ask());
    this.answer.onChange(() => this.show());
    photometry.onChange(() => this.show());
    this.unpin.addEventListener('click', () => (this.pinned.value = null));
    for (const field of Object.values(this.fields)) field.addEventListener('change', () => this.pinTyped());
    this.show();
  }

  /// A new frame came: what stands still is asked for again, twice a second at most.
  refresh(): void {
    if (performance.now() - this.lastRefresh < 500) return;
    this.ask();
  }

  /// The pinned pixel goes along, pixel by pixel.
  step(dx: number, dy: number): void {
    const at = this.pinned.value ?? this.hovered.value;
    if (at) this.pin({ x: at.x + dx, y: at.y + dy });
  }

  pin(at: Point): void {
    const { width, height } = this.state.value ?? { width: 1, height: 1 };
    const inside = (v: number, size: number) => Math.min(size - 1, Math.max(0, Math.round(v)));
    this.pinned.value = { x: inside(at.x, width), y: inside(at.y, height) };
  }

  private pinTyped(): void {
    this.pin({ x: Number(this.fields.x.value) || 0, y: Number(this.fields.y.value) || 0 });
  }

  private ask(): void {
    const at = this.pinned.value ?? this.hovered.value;
    this.showPlace(at);
    if (!at) return;
    this.lastRefresh = performance.now();
    this.asker.push(at);
  }

  private showPlace(at: Point | null): void {
    this.unpin.hidden = !this.pinned.value;
    for (const axis of ['x', 'y'] as const)
      if (document.activeElement !== this.fields[axis]) this.fields[axis].value = at ? String(at[axis]) : this.fields[axis].value;
  }

  private show(): void {
    const pixel = this.answer.value;
    byId('probe-none').hidden = pixel !== null;
    byId('probe-values').hidden = pixel === null;
    if (!pixel) return;
    const factor = shownFactor();
    const unit = shownUnit(this.state.value?.unit ?? '');
    const error = pixel.standard_error;
    setText(byId('probe-luminance'), formatWithError(pixel.luminance * factor, error === null ? null : error * factor));
    setText(byId('probe-unit'), unit);
    setText(
      byId('probe-interval'),
      pixel.interval
        ? formatInterval(pixel.interval, factor)
        : 'not known yet',
    );
    const relative = error !== null && pixel.luminance > 0 ? error / pixel.luminance : null;
    setText(byId('probe-relative'), relative === null ? '–' : `${formatNumber(100 * relative, 2)} %`);
    setText(byId('probe-bias'), pixel.bias ? formatNumber(luminance(pixel.bias) * factor, 3) : 'none estimated');
    pixel.value.forEach((value, c) => setText(byId(`probe-${'rgb'[c]}`), formatNumber(value)));
    showSwatch(pixel);
    this.showLayers(pixel, factor);
  }

  /// Parts of the light as bars: shares of the pixel's luminance.
  private showLayers(pixel: Pixel, factor: number): void {
    const parts = Object.entries(pixel.layers).filter(([name]) => kindOf(name).id === 'light');
    const rows = parts.map(([name, rgb]) => {
      const value = luminance(rgb);
      const share = pixel.luminance > 0 ? Math.min(1, Math.max(0, value / pixel.luminance)) : 0;
      const fill = make('i');
      fill.style.width = `${100 * share}%`;
      return make(
        'div',
        { class: 'layer-row', role: 'row' },
        make('span', { role: 'rowheader' }, titleOf(name)),
        make('span', { class: 'bar', 'aria-hidden': 'true' }, fill),
        make('span', { class: 'number', role: 'cell' }, formatNumber(value * factor, 3)),
      );
    });
    byId('probe-layers').replaceChildren(...rows);
  }
}

function showSwatch(pixel: Pixel): void {
  const most = Math.max(...pixel.value, 1e-30);
  const [r, g, b] = pixel.value.map((v) => Math.round(255 * srgbFromLinear(v / most)));
  byId('probe-swatch').style.background = `rgb(${r} ${g} ${b})`;
}
