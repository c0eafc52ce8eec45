import type { Client, FrameFormat } from './protocol';
import { Frame } from './frame';
import { Signal } from './signal';

export interface Wish {
  layer: string;
  format: FrameFormat;
  width: number | null;
}

/// Asks for one frame after another, each as soon as the one before is on the screen: a slow
/// browser skips frames, and a hidden page asks for none.
export class FrameLoop {
  readonly frame = new Signal<Frame | null>(null);
  private wish: Wish | null = null;
  private after = 0;
  private stop: AbortController | null = null;
  private isRunning = false;

  constructor(
    private readonly client: Client,
    private readonly onError: (error: unknown) => void,
  ) {
    document.addEventListener('visibilitychange', () => this.go());
  }

  /// What to ask for from now on. Another layer or size is fetched at once.
  want(wish: Wish): void {
    const old = this.wish;
    if (old && old.layer === wish.layer && old.format === wish.format && old.width === wish.width) return;
    this.wish = wish;
    this.restart();
  }

  /// After the server was started again.
  restart(): void {
    this.after = 0;
    this.stop?.abort();
    this.go();
  }

  private go(): void {
    if (!this.isRunning && this.wish && !document.hidden) void this.run();
  }

  private async run(): Promise<void> {
    this.isRunning = true;
    while (this.wish && !document.hidden) {
      const { layer, format, width } = this.wish;
      const stop = new AbortController();
      this.stop = stop;
      try {
        const answer = await this.client.frame({ after: this.after, layer, format, width }, stop.signal);
        if (!answer) continue;
        const frame = await Frame.read(answer, layer, format);
        if (stop.signal.aborted) continue;
        this.after = frame.number;
        this.frame.value = frame;
        await new Promise(requestAnimationFrame);
      } catch (error) {
        if (stop.signal.aborted) continue;
        this.isRunning = false;
        this.onError(error);
        return;
      }
    }
    this.isRunning = false;
  }
}
