/// Sends values one at a time, not more often than the interval allows, and of several that wait
/// only the newest (or what `merge` makes of two).
export class Latest<T> {
  private waiting: { value: T } | null = null;
  private isBusy = false;
  private last = -Infinity;

  constructor(
    private readonly send: (value: T) => Promise<void>,
    private readonly intervalMs: number,
    private readonly merge: (older: T, newer: T) => T = (_, newer) => newer,
  ) {}

  push(value: T): void {
    this.waiting = { value: this.waiting ? this.merge(this.waiting.value, value) : value };
    if (!this.isBusy) void this.work();
  }

  /// Nothing waits and nothing is under way.
  get isIdle(): boolean {
    return !this.isBusy && !this.waiting;
  }

  private async work(): Promise<void> {
    this.isBusy = true;
    while (this.waiting) {
      const pause = this.last + this.intervalMs - performance.now();
      if (pause > 0) await new Promise((done) => setTimeout(done, pause));
      const { value } = this.waiting;
      this.waiting = null;
      this.last = performance.now();
      try {
        await this.send(value);
      } catch {
        // Whoever sends tells of errors; the next value is sent all the same.
      }
    }
    this.isBusy = false;
  }
}
