import type { Client, Rectangle, RegionMean, State } from './protocol';
import { byId, setText } from './dom';
import { Latest } from './latest';
import { formatInterval, formatWithError } from './numbers';
import { Signal } from './signal';
import { photometry, shownFactor, shownUnit } from './units';

interface Point {
  x: number;
  y: number;
}

const sides = ['x', 'y', 'width', 'height'] as const;

/// Mean and interval of a rectangle of the picture.
export class Region {
  readonly rectangle = new Signal<Rectangle | null>(null);
  readonly text = new Signal('');
  private answer: RegionMean | null = null;
  private readonly asker: Latest<Rectangle>;
  private lastRefresh = 0;

  constructor(
    client: Client,
    private readonly state: Signal<State | null>,
    onError: (error: unknown) => void,
  ) {
    this.asker = new Latest<Rectangle>(async (rectangle) => {
      try {
        this.answer = await client.region(rectangle);
      } catch (error) {
        this.answer = null;
        onError(error);
      }
      this.show();
    }, 100);
    this.rectangle.onChange(() => this.show());
    photometry.onChange(() => this.show());
    byId('region-clear').addEventListener('click', () => this.clear());
    for (const side of sides) field(side).addEventListener('change', () => this.takeTyped());
    this.show();
  }

  draw(from: Point, to: Point, isDone: boolean): void {
    const { width, height } = this.state.value ?? { width: 1, height: 1 };
    const inside = (v: number, size: number) => Math.min(size, Math.max(0, v));
    const [left, right] = [Math.min(from.x, to.x), Math.max(from.x, to.x)];
    const [top, bottom] = [Math.min(from.y, to.y), Math.max(from.y, to.y)];
    const x = inside(Math.floor(left), width - 1);
    const y = inside(Math.floor(top), height - 1);
    const drawn = {
      x,
      y,
      width: Math.max(1, inside(Math.ceil(right), width) - x),
      height: Math.max(1, inside(Math.ceil(bottom), height) - y),
    };
    this.answer = null;
    this.rectangle.value = drawn;
    if (isDone) this.asker.push(drawn);
  }

  clear(): void {
    this.answer = null;
    this.rectangle.value = null;
  }

  refresh(): void {
    const now = performance.now();
    if (!this.rectangle.value || !this.answer || now - this.lastRefresh < 1000) return;
    this.lastRefresh = now;
    this.asker.push(this.rectangle.value);
  }

  private takeTyped(): void {
    const [x, y, width, height] = sides.map((side) => Math.max(0, Math.round(Number(field(side).value) || 0)));
    this.draw({ x: x!, y: y! }, { x: x! + Math.max(1, width!), y: y! + Math.max(1, height!) }, true);
  }

  private show(): void {
    const { answer } = this;
    const rectangle = this.rectangle.value;
    byId('region-clear').hidden = !rectangle;
    byId('region-none').hidden = rectangle !== null;
    byId('region-values').hidden = rectangle === null || answer === null;
    for (const side of sides)
      if (document.activeElement !== field(side)) field(side).value = rectangle ? String(rectangle[side]) : '';
    const unit = shownUnit(this.state.value?.unit ?? '');
    const mean = answer ? meanText(answer) : '';
    this.text.value = mean && `mean ${mean} ${unit}`;
    if (!answer) return;
    setText(byId('region-mean'), mean);
    setText(byId('region-unit'), unit);
    setText(
      byId('region-interval'),
      answer.interval
        ? formatInterval(answer.interval, shownFactor())
        : 'not known yet',
    );
    setText(byId('region-pixels'), String(answer.pixels));
  }
}

function meanText(answer: RegionMean): string {
  const factor = shownFactor();
  const error = answer.standard_error;
  return formatWithError(answer.mean * factor, error === null ? null : error * factor);
}

function field(side: (typeof sides)[number]): HTMLInputElement {
  return byId<HTMLInputElement>(`region-${side}`);
}
