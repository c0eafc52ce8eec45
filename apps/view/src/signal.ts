/// A value that tells when it changes.
export class Signal<T> {
  private readonly listeners: ((value: T) => void)[] = [];

  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }

  set value(next: T) {
    if (Object.is(next, this.current)) return;
    this.current = next;
    for (const listener of this.listeners) listener(next);
  }

  /// Calls at each change, and once now.
  watch(listener: (value: T) => void): void {
    this.onChange(listener);
    listener(this.current);
  }

  onChange(listener: (value: T) => void): void {
    this.listeners.push(listener);
  }
}
