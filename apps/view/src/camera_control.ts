import type { Camera, Client, State } from './protocol';
import { Latest } from './latest';
import { Signal } from './signal';
import { dollied, orbited, panned, withFov } from './camera';

const restMs = 600;

/// The camera as the page sees it. While somebody moves it, the page's own counts; at rest the
/// server's. Sends at most 30 cameras a second, the newest only.
export class CameraControl {
  readonly camera = new Signal<Camera | null>(null);
  private home: Camera | null = null;
  private scene = '';
  private movedAt = -Infinity;
  private canMove = true;
  private readonly sender: Latest<Camera>;

  constructor(client: Client, onError: (error: unknown) => void) {
    this.sender = new Latest<Camera>(async (camera) => {
      try {
        await client.command({ camera });
      } catch (error) {
        onError(error);
      }
    }, 1000 / 30);
  }

  follow(state: State): void {
    this.canMove = state.can_edit;
    if (state.scene !== this.scene) {
      this.scene = state.scene;
      this.home = state.camera;
    }
    if (this.sender.isIdle && performance.now() - this.movedAt > restMs) this.camera.value = state.camera;
  }

  orbit(toRight: number, upward: number): void {
    this.change((camera) => orbited(camera, toRight, upward));
  }

  pan(toRight: number, upward: number): void {
    this.change((camera) => panned(camera, toRight, upward));
  }

  dolly(factor: number): void {
    this.change((camera) => dollied(camera, factor));
  }

  setFov(fov: number): void {
    this.change((camera) => withFov(camera, fov));
  }

  scaleFov(factor: number): void {
    this.change((camera) => withFov(camera, (camera.fov ?? 40) * factor));
  }

  /// Back to where it stood when the page was opened.
  goHome(): void {
    this.change(() => this.home);
  }

  private change(next: (camera: Camera) => Camera | null): void {
    const before = this.camera.value;
    const after = before && next(before);
    if (!after || after === before || !this.canMove) return;
    this.movedAt = performance.now();
    this.camera.value = after;
    this.sender.push(after);
  }
}
