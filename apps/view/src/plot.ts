import type { ErrorHistory } from './protocol';
import { byId, fitCanvas, onNextFrame } from './dom';
import { formatNumber } from './numbers';
import type { Signal } from './signal';

interface Range {
  low: number;
  high: number; // powers of ten
}

const margin = { left: 44, right: 10, top: 8, bottom: 20 };

/// The picture's error over time, both on scales of logarithms, beside the slope of a halved error
/// for four times the time.
export class ErrorPlot {
  private readonly canvas = byId<HTMLCanvasElement>('plot');
  private readonly note = byId('plot-note');
  private readonly redraw = onNextFrame(() => this.draw());
  private pointer: number | null = null;

  constructor(private readonly history: Signal<ErrorHistory>) {
    history.onChange(this.redraw);
    new ResizeObserver(this.redraw).observe(this.canvas);
    this.canvas.addEventListener('pointermove', (event) => this.point(event.offsetX));
    this.canvas.addEventListener('pointerleave', () => this.point(null));
    this.redraw();
  }

  /// Colours have changed.
  refresh(): void {
    this.redraw();
  }

  private point(x: number | null): void {
    this.pointer = x;
    this.redraw();
  }

  private points(): [number, number][] {
    const { elapsed_s, error } = this.history.value;
    return elapsed_s
      .map((time, i): [number, number] => [time, error[i] ?? NaN])
      .filter(([time, value]) => time > 0 && value > 0 && Number.isFinite(value));
  }

  private draw(): void {
    fitCanvas(this.canvas);
    const context = this.canvas.getContext('2d')!;
    const ratio = this.canvas.width / Math.max(1, this.canvas.clientWidth);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    const points = this.points();
    this.note.hidden = points.length > 1;
    if (points.length < 2) return;
    const x = rangeOf(points.map(([time]) => time));
    const y = rangeOf(points.map(([, value]) => value));
    const style = getComputedStyle(this.canvas);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    const width = this.canvas.clientWidth - margin.left - margin.right;
    const height = this.canvas.clientHeight - margin.top - margin.bottom;
    const across = (v: number) => margin.left + (width * (Math.log10(v) - x.low)) / (x.high - x.low);
    const down = (v: number) => margin.top + height - (height * (Math.log10(v) - y.low)) / (y.high - y.low);

    context.font = '10.5px Inter, system-ui, sans-serif';
    context.fillStyle = colour('--text-soft');
    context.lineWidth = 1;
    context.strokeStyle = colour('--line');
    context.textAlign = 'center';
    context.textBaseline = 'top';
    for (const tick of ticks(x, Math.floor(width / 46))) {
      line(context, [[across(tick), margin.top], [across(tick), margin.top + height]]);
      context.fillText(timeText(tick), across(tick), margin.top + height + 5);
    }
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    for (const tick of ticks(y, Math.floor(height / 20))) {
      line(context, [[margin.left, down(tick)], [margin.left + width, down(tick)]]);
      context.fillText(`${formatNumber(tick * 100, 2)} %`, margin.left - 6, down(tick));
    }
    context.save();
    context.beginPath();
    context.rect(margin.left, margin.top, width, height);
    context.clip();
    this.drawSlope(context, points, across, down, colour('--text-soft'));
    context.setLineDash([]);
    context.lineWidth = 2;
    context.lineJoin = 'round';
    context.strokeStyle = colour('--accent');
    line(context, points.map(([time, value]) => [across(time), down(value)]));
    context.restore();
    this.drawReading(context, points, across, down, colour);
  }

  private drawSlope(
    context: CanvasRenderingContext2D,
    points: [number, number][],
    across: (v: number) => number,
    down: (v: number) => number,
    colour: string,
  ): void {
    const [time, value] = points[points.length - 1]!;
    const at = (t: number): [number, number] => [across(t), down(value * Math.sqrt(time / t))];
    context.lineWidth = 1;
    context.setLineDash([3, 4]);
    context.strokeStyle = colour;
    line(context, [at(time / 1e4), at(time * 1e4)]);
  }

  private drawReading(
    context: CanvasRenderingContext2D,
    points: [number, number][],
    across: (v: number) => number,
    down: (v: number) => number,
    colour: (name: string) => string,
  ): void {
    let chosen = points[points.length - 1]!;
    if (this.pointer !== null)
      for (const point of points)
        if (Math.abs(across(point[0]) - this.pointer) < Math.abs(across(chosen[0]) - this.pointer)) chosen = point;
    const [x, y] = [across(chosen[0]), down(chosen[1])];
    context.fillStyle = colour('--accent');
    context.beginPath();
    context.arc(x, y, 3.5, 0, 2 * Math.PI);
    context.fill();
    if (this.pointer === null) return;
    const text = `${formatNumber(chosen[1] * 100, 3)} % after ${timeText(chosen[0])}`;
    const width = context.measureText(text).width;
    const left = Math.min(x + 8, this.canvas.clientWidth - width - 14);
    context.fillStyle = colour('--raised');
    context.fillRect(left - 4, Math.max(2, y - 22), width + 8, 18);
    context.fillStyle = colour('--text');
    context.textAlign = 'left';
    context.fillText(text, left, Math.max(2, y - 22) + 9.5);
  }
}

function line(context: CanvasRenderingContext2D, points: [number, number][]): void {
  context.beginPath();
  points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.stroke();
}

/// In powers of ten, with a little room.
function rangeOf(values: number[]): Range {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = Math.min(low, Math.log10(value));
    high = Math.max(high, Math.log10(value));
  }
  const room = Math.max(0.06, 0.5 * (0.4 - (high - low)));
  return { low: low - room, high: high + room };
}

/// At most that many: powers of ten, with 1, 2, 5 and others between them where they are few.
function ticks(range: Range, most: number): number[] {
  let coarser: number[] = [];
  for (const factors of [[1], [1, 3], [1, 2, 5], [1, 2, 3, 5, 7]]) {
    const result: number[] = [];
    for (let e = Math.floor(range.low); e <= range.high; ++e)
      for (const factor of factors) {
        const place = e + Math.log10(factor);
        if (place >= range.low && place <= range.high) result.push(factor * 10 ** e);
      }
    if (result.length > most || coarser.length > 3) break;
    coarser = result;
  }
  return coarser;
}

function timeText(seconds: number): string {
  if (seconds < 60) return `${formatNumber(seconds, 2)} s`;
  if (seconds < 3600) return `${formatNumber(seconds / 60, 2)} min`;
  return `${formatNumber(seconds / 3600, 2)} h`;
}
