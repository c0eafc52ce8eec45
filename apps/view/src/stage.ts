import type { Connection } from './connection';
import type { Display } from './display';
import { byId, fitCanvas, onNextFrame, setText } from './dom';
import type { Frame } from './frame';
import type { FrameLoop } from './frame_loop';
import { luminance } from './color';
import { titleOf } from './layers';
import { formatNumber, formatZoom } from './numbers';
import { Overlay } from './overlay';
import { PictureCanvas } from './picture';
import type { Photons } from './photons';
import type { Probe } from './probe';
import type { Region } from './region';
import { photometry, shownFactor, shownUnit } from './units';
import type { View } from './view';

/// The picture on the screen: draws it when anything changes, asks for frames of the size that is
/// looked at, and tells of the pixel under the pointer.
export class Stage {
  private readonly canvas = byId<HTMLCanvasElement>('picture');
  private readonly picture: PictureCanvas;
  private readonly overlay: Overlay;
  private readonly redraw = onNextFrame(() => this.draw());
  private shownFrame: Frame | null = null;

  /// Throws where the browser cannot draw.
  constructor(
    private readonly connection: Connection,
    private readonly frames: FrameLoop,
    private readonly display: Display,
    private readonly view: View,
    private readonly probe: Probe,
    private readonly region: Region,
    private readonly photons: Photons,
  ) {
    this.picture = new PictureCanvas(this.canvas);
    this.overlay = new Overlay(byId<HTMLCanvasElement>('overlay'), view);
    const stage = byId('stage');
    new ResizeObserver(() => view.setStage(stage.clientWidth, stage.clientHeight)).observe(stage);
    view.setStage(stage.clientWidth, stage.clientHeight);
    connection.state.onChange((state) => state && view.setPicture(state.width, state.height));
    frames.frame.onChange((frame) => frame && this.display.see(frame));
    view.changed.onChange(() => this.askForSize());
    display.asked.onChange(() => this.askForSize());
    connection.state.onChange(() => this.askForSize());
    const shown = [view.changed, display.look, frames.frame, probe.pinned, probe.hovered, region.rectangle, region.text, photons.changed, photometry];
    for (const signal of shown) (signal as { onChange(f: () => void): void }).onChange(this.redraw);
    byId('zoom-fit').addEventListener('click', () => view.fit());
    byId('zoom-one').addEventListener('click', () => view.zoomTo(1 / (window.devicePixelRatio || 1)));
    byId('zoom-in').addEventListener('click', () => view.zoomBy(2));
    byId('zoom-out').addEventListener('click', () => view.zoomBy(0.5));
  }

  /// No more pixels than the screen shows; the server reduces by whole numbers.
  private askForSize(): void {
    const state = this.connection.state.value;
    if (!state) return;
    const shown = this.view.zoom * (window.devicePixelRatio || 1);
    const reduction = Math.max(1, Math.floor(1 / shown + 1e-6));
    const { kind, asked } = this.display;
    this.frames.want({
      layer: asked.value,
      format: kind.format,
      width: reduction === 1 ? null : Math.ceil(state.width / reduction),
    });
  }

  private draw(): void {
    const frame = this.frames.frame.value;
    fitCanvas(this.canvas);
    if (frame && frame !== this.shownFrame) {
      this.picture.show(frame);
      this.shownFrame = frame;
    }
    const ratio = this.canvas.width / Math.max(1, this.canvas.clientWidth);
    this.picture.draw(this.display.look.value, this.view.placement(ratio));
    this.photons.draw(frame, this.view.pictureSize, this.view.placement(ratio), ratio);
    const { pinned, hovered } = this.probe;
    this.overlay.draw({
      frame,
      pinned: pinned.value,
      hovered: hovered.value,
      region: this.region.rectangle.value,
      regionText: this.region.text.value,
    });
    this.writeStatus();
  }

  private writeStatus(): void {
    const frame = this.frames.frame.value;
    const { width, height } = this.view.pictureSize;
    setText(byId('zoom-value'), formatZoom(this.view.zoom * (window.devicePixelRatio || 1)));
    setText(byId('picture-size'), `${width} × ${height}`);
    const kind = frame?.kind === 'preview' ? 'preview' : frame?.isMoving ? 'moving' : '';
    setText(byId('picture-kind'), kind);
    setText(byId('status-layer'), titleOf(frame?.layer ?? this.display.layer.value));
    const at = this.probe.hovered.value ?? this.probe.pinned.value;
    const readout = byId('readout');
    readout.hidden = !at || !frame;
    if (!at || !frame) return;
    // Of a reduced frame: the mean of the pixels around.
    const x = Math.min(frame.width - 1, Math.floor((at.x * frame.width) / width));
    const y = Math.min(frame.height - 1, Math.floor((at.y * frame.height) / height));
    const rgb = frame.rgb(x, y);
    setText(byId('readout-place'), `${at.x}, ${at.y}`);
    rgb.forEach((value, c) => setText(byId(`readout-${'rgb'[c]}`), formatNumber(value, 3)));
    const isLight = this.display.kind.isLight;
    const unit = isLight ? shownUnit(this.connection.state.value?.unit ?? '') : '';
    setText(byId('readout-y'), formatNumber(luminance(rgb) * (isLight ? shownFactor() : 1), 3));
    setText(byId('readout-unit'), unit);
  }
}
