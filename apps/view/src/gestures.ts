import type { CameraControl } from './camera_control';
import type { Display } from './display';
import { tool } from './tools';
import type { View } from './view';

interface Point {
  x: number;
  y: number;
}

export interface GestureTargets {
  hover(pixel: Point | null): void;
  pin(pixel: Point): void;
  drawRegion(from: Point, to: Point, isDone: boolean): void; // places in the picture
}

type Drag = 'orbit' | 'camera-pan' | 'picture-pan' | 'probe' | 'region';

const clickDistance = 4; // CSS pixels
const orbitSpeed = Math.PI; // for a drag over the stage's width

/// Mouse, pen and fingers on the picture.
export class Gestures {
  private readonly down = new Map<number, Point>();
  private drag: Drag | null = null;
  private start: Point = { x: 0, y: 0 };
  private hasMoved = false;

  constructor(
    private readonly stage: HTMLElement,
    private readonly view: View,
    private readonly camera: CameraControl,
    private readonly display: Display,
    private readonly targets: GestureTargets,
  ) {
    stage.addEventListener('pointerdown', (event) => this.pressed(event));
    stage.addEventListener('pointermove', (event) => this.moved(event));
    stage.addEventListener('pointerup', (event) => this.released(event));
    stage.addEventListener('pointercancel', (event) => this.cancelled(event));
    stage.addEventListener('pointerleave', () => this.down.size || targets.hover(null));
    stage.addEventListener('wheel', (event) => this.wheeled(event), { passive: false });
    stage.addEventListener('contextmenu', (event) => event.preventDefault());
    stage.addEventListener('dblclick', () => tool.value === 'picture' && this.toggleZoom());
  }

  private at(event: MouseEvent): Point {
    const box = this.stage.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private pressed(event: PointerEvent): void {
    if ((event.target as Element).closest('button, input, a, dialog')) return;
    this.stage.setPointerCapture(event.pointerId);
    const at = this.at(event);
    this.down.set(event.pointerId, at);
    if (this.down.size > 1) {
      this.endRegion();
      this.drag = null;
      this.hasMoved = true;
      return;
    }
    this.start = at;
    this.hasMoved = false;
    this.drag = dragOf(event);
    if (this.drag === 'probe') this.pinAt(at);
  }

  private moved(event: PointerEvent): void {
    const at = this.at(event);
    const before = this.down.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== 'touch') this.targets.hover(this.view.pixelAt(at.x, at.y));
      return;
    }
    if (this.down.size === 2) this.pinched(event.pointerId, before, at);
    this.down.set(event.pointerId, at);
    if (this.down.size > 1) return;
    this.hasMoved ||= Math.hypot(at.x - this.start.x, at.y - this.start.y) > clickDistance;
    if (this.hasMoved) this.dragged(at, at.x - before.x, at.y - before.y);
  }

  private dragged(at: Point, dx: number, dy: number): void {
    const size = Math.max(1, this.stage.clientWidth);
    const shown = this.view.pictureSize.width * this.view.zoom;
    if (this.drag === 'orbit') this.camera.orbit((-dx / size) * orbitSpeed, (dy / size) * orbitSpeed);
    if (this.drag === 'camera-pan') this.camera.pan(-dx / shown, dy / shown);
    if (this.drag === 'picture-pan') this.view.pan(dx, dy);
    if (this.drag === 'probe') this.pinAt(at);
    if (this.drag === 'region') this.showRegion(at, false);
  }

  private released(event: PointerEvent): void {
    if (!this.down.delete(event.pointerId)) return;
    const at = this.at(event);
    if (this.drag === 'region' && this.hasMoved) this.showRegion(at, true);
    else if (this.drag && !this.hasMoved && event.button === 0) this.pinAt(at);
    if (this.down.size === 0) this.drag = null;
  }

  private cancelled(event: PointerEvent): void {
    this.down.delete(event.pointerId);
    this.drag = null;
  }

  private endRegion(): void {
    const last = [...this.down.values()][0];
    if (this.drag === 'region' && this.hasMoved && last) this.showRegion(last, true);
  }

  /// Two fingers: apart and together, and both along.
  private pinched(id: number, before: Point, now: Point): void {
    const other = [...this.down].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const apart = (p: Point) => Math.max(1, Math.hypot(p.x - other.x, p.y - other.y));
    const factor = apart(now) / apart(before);
    const dx = (now.x - before.x) / 2;
    const dy = (now.y - before.y) / 2;
    if (tool.value === 'camera') {
      const shown = this.view.pictureSize.width * this.view.zoom;
      this.camera.dolly(1 / factor);
      this.camera.pan(-dx / shown, dy / shown);
    } else {
      this.view.zoomBy(factor, { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 });
      this.view.pan(dx, dy);
    }
  }

  private wheeled(event: WheelEvent): void {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
    // Browsers turn a wheel with Shift sideways.
    const turned = ((event.deltaY || event.deltaX) * lines) / 100;
    const amount = Math.min(3, Math.max(-3, turned));
    if (event.shiftKey) this.display.exposeBy(-0.25 * Math.sign(amount));
    else if (event.altKey) this.camera.scaleFov(1.06 ** amount);
    else if (event.ctrlKey || event.metaKey || tool.value !== 'camera')
      this.view.zoomBy(1.25 ** -amount, this.at(event));
    else this.camera.dolly(1.1 ** amount);
  }

  private toggleZoom(): void {
    if (this.view.isFitted) this.view.zoomTo(8, this.start);
    else this.view.fit();
  }

  private pinAt(at: Point): void {
    const pixel = this.view.pixelAt(at.x, at.y);
    if (pixel) this.targets.pin(pixel);
  }

  private showRegion(at: Point, isDone: boolean): void {
    const place = (p: Point) => this.view.toPicture(p.x, p.y);
    this.targets.drawRegion(place(this.start), place(at), isDone);
  }
}

function dragOf(event: PointerEvent): Drag | null {
  if (tool.value === 'camera') {
    if (event.button === 0) return event.shiftKey || event.ctrlKey ? 'camera-pan' : 'orbit';
    return event.button === 1 || event.button === 2 ? 'camera-pan' : null;
  }
  if (event.button !== 0) return 'picture-pan';
  return tool.value === 'picture' ? 'picture-pan' : tool.value;
}
