import { Signal } from './signal';
import type { Placement } from './picture';
import type { Rectangle } from './protocol';

/// Which part of the picture is on the screen, and how large. Lengths on the screen are CSS pixels
/// from the stage's top left corner; places in the picture are its pixels.
export class View {
  readonly changed = new Signal(0);
  private stage = { width: 1, height: 1 };
  private picture = { width: 1, height: 1 };
  private centre = { x: 0.5, y: 0.5 };
  private scale = 1;
  private fits = true;

  /// CSS pixels for a pixel of the picture.
  get zoom(): number {
    return this.scale;
  }

  get isFitted(): boolean {
    return this.fits;
  }

  get pictureSize(): { width: number; height: number } {
    return this.picture;
  }

  setStage(width: number, height: number): void {
    this.stage = { width, height };
    this.update();
  }

  setPicture(width: number, height: number): void {
    if (width === this.picture.width && height === this.picture.height) return;
    this.picture = { width, height };
    this.fits = true;
    this.update();
  }

  fit(): void {
    this.fits = true;
    this.update();
  }

  /// Zooms so that the place under the point stays there.
  zoomTo(zoom: number, point = { x: this.stage.width / 2, y: this.stage.height / 2 }): void {
    const before = this.toPicture(point.x, point.y);
    this.fits = false;
    this.scale = Math.min(256, Math.max(this.fitted() / 8, zoom));
    const after = this.toPicture(point.x, point.y);
    this.centre.x += before.x - after.x;
    this.centre.y += before.y - after.y;
    this.update();
  }

  zoomBy(factor: number, point?: { x: number; y: number }): void {
    this.zoomTo(this.scale * factor, point);
  }

  pan(dx: number, dy: number): void {
    this.fits = false;
    this.centre.x -= dx / this.scale;
    this.centre.y -= dy / this.scale;
    this.update();
  }

  toPicture(x: number, y: number): { x: number; y: number } {
    return {
      x: this.centre.x + (x - this.stage.width / 2) / this.scale,
      y: this.centre.y + (y - this.stage.height / 2) / this.scale,
    };
  }

  toScreen(x: number, y: number): { x: number; y: number } {
    return {
      x: (x - this.centre.x) * this.scale + this.stage.width / 2,
      y: (y - this.centre.y) * this.scale + this.stage.height / 2,
    };
  }

  /// The pixel below a point of the screen; null beside the picture.
  pixelAt(x: number, y: number): { x: number; y: number } | null {
    const at = this.toPicture(x, y);
    const pixel = { x: Math.floor(at.x), y: Math.floor(at.y) };
    const { width, height } = this.picture;
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < height ? pixel : null;
  }

  /// In the canvas's own pixels.
  placement(ratio: number): Placement {
    const start = this.toScreen(0, 0);
    const end = this.toScreen(this.picture.width, this.picture.height);
    const at = (v: number) => (this.fits ? Math.round(v * ratio) : v * ratio);
    return { left: at(start.x), top: at(start.y), right: at(end.x), bottom: at(end.y) };
  }

  /// Pixels of the picture that are on the screen.
  visible(): Rectangle {
    const start = this.toPicture(0, 0);
    const end = this.toPicture(this.stage.width, this.stage.height);
    const x = Math.max(0, Math.floor(start.x));
    const y = Math.max(0, Math.floor(start.y));
    const right = Math.min(this.picture.width, Math.ceil(end.x));
    const bottom = Math.min(this.picture.height, Math.ceil(end.y));
    return { x, y, width: Math.max(0, right - x), height: Math.max(0, bottom - y) };
  }

  private fitted(): number {
    const { width, height } = this.picture;
    return Math.max(1e-3, Math.min(this.stage.width / width, this.stage.height / height));
  }

  private update(): void {
    if (this.fits) {
      this.scale = this.fitted();
      this.centre = { x: this.picture.width / 2, y: this.picture.height / 2 };
    }
    // Some of the picture always stays on the screen.
    const { width, height } = this.picture;
    this.centre.x = Math.min(width, Math.max(0, this.centre.x));
    this.centre.y = Math.min(height, Math.max(0, this.centre.y));
    this.changed.value += 1;
  }
}
