import { fitCanvas } from './dom';
import type { Frame } from './frame';
import { formatNumber } from './numbers';
import type { Rectangle } from './protocol';
import type { View } from './view';

const valuesFrom = 64; // CSS pixels for a pixel: then its values have room
const gridFrom = 16;

export interface Marks {
  frame: Frame | null;
  pinned: { x: number; y: number } | null;
  hovered: { x: number; y: number } | null;
  region: Rectangle | null;
  regionText: string;
}

/// What is drawn over the picture: marks, and the values of large pixels.
export class Overlay {
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly view: View,
  ) {}

  draw(marks: Marks): void {
    fitCanvas(this.canvas);
    const context = this.canvas.getContext('2d')!;
    const ratio = this.canvas.width / Math.max(1, this.canvas.clientWidth);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    const { frame } = marks;
    const { width } = this.view.pictureSize;
    if (frame && frame.width === width && this.view.zoom >= valuesFrom) this.drawValues(context, frame);
    if (marks.hovered && this.view.zoom >= gridFrom) this.drawPixel(context, marks.hovered, 1);
    if (marks.region) this.drawRegion(context, marks.region, marks.regionText);
    if (marks.pinned) this.drawPin(context, marks.pinned);
  }

  private drawValues(context: CanvasRenderingContext2D, frame: Frame): void {
    const { x, y, width, height } = this.view.visible();
    const { zoom } = this.view;
    const size = Math.min(13, zoom / 6.2);
    context.font = `${size}px Inter, system-ui, sans-serif`;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    for (let row = y; row < y + height; ++row)
      for (let column = x; column < x + width; ++column) {
        const at = this.view.toScreen(column + 0.5, row + 0.5);
        const rgb = frame.rgb(column, row);
        context.fillStyle = 'rgb(12 13 15 / 0.62)';
        context.beginPath();
        context.roundRect(at.x - 2.5 * size, at.y - 2.1 * size, 5 * size, 4.2 * size, 4);
        context.fill();
        for (let c = 0; c < 3; ++c) {
          context.fillStyle = ['#ff9d92', '#9be59a', '#a3c4ff'][c]!;
          context.fillText(formatNumber(rgb[c]!, 3), at.x, at.y + (c - 1) * 1.25 * size);
        }
      }
  }

  private box(context: CanvasRenderingContext2D, area: Rectangle, grow: number): void {
    const start = this.view.toScreen(area.x, area.y);
    const end = this.view.toScreen(area.x + area.width, area.y + area.height);
    const sides = [start.x - grow, start.y - grow, end.x - start.x + 2 * grow, end.y - start.y + 2 * grow] as const;
    context.lineWidth = 3;
    context.strokeStyle = 'rgb(0 0 0 / 0.6)';
    context.strokeRect(...sides);
    context.lineWidth = 1;
    context.strokeStyle = '#fff';
    context.strokeRect(...sides);
  }

  private drawPixel(context: CanvasRenderingContext2D, at: { x: number; y: number }, grow: number): void {
    this.box(context, { ...at, width: 1, height: 1 }, grow);
  }

  private drawPin(context: CanvasRenderingContext2D, at: { x: number; y: number }): void {
    const { zoom } = this.view;
    if (zoom >= gridFrom) return this.drawPixel(context, at, 2);
    const { x, y } = this.view.toScreen(at.x + 0.5, at.y + 0.5);
    for (const [width, colour] of [[3.5, 'rgb(0 0 0 / 0.6)'], [1.5, '#fff']] as const) {
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.beginPath();
      context.arc(x, y, 7, 0, 2 * Math.PI);
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
        context.moveTo(x + 4 * dx, y + 4 * dy);
        context.lineTo(x + 12 * dx, y + 12 * dy);
      }
      context.stroke();
    }
  }

  private drawRegion(context: CanvasRenderingContext2D, region: Rectangle, text: string): void {
    this.box(context, region, 0.5);
    if (!text) return;
    const at = this.view.toScreen(region.x, region.y);
    context.font = '12px Inter, system-ui, sans-serif';
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    const width = context.measureText(text).width + 12;
    const left = Math.max(2, Math.min(at.x, this.canvas.clientWidth - width - 2));
    const top = at.y > 26 ? at.y - 24 : at.y + 4;
    context.fillStyle = 'rgb(12 13 15 / 0.82)';
    context.beginPath();
    context.roundRect(left, top, width, 20, 4);
    context.fill();
    context.fillStyle = '#fff';
    context.fillText(text, left + 6, top + 10.5);
  }
}
