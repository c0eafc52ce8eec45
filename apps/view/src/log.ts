import type { LogLine } from './protocol';
import { byId, make } from './dom';

const most = 500;

/// What the renderer and the page have to say.
export class Log {
  private readonly list = byId('log');
  private readonly none = byId('log-none');
  private readonly count = byId('log-count');
  private unread = 0;

  constructor(private readonly isShown: () => boolean) {
    byId('log-clear').addEventListener('click', () => {
      this.list.replaceChildren();
      this.none.hidden = false;
    });
  }

  add({ level, text }: LogLine): void {
    const isAtEnd = this.list.scrollTop + this.list.clientHeight >= this.list.scrollHeight - 20;
    const time = new Date().toTimeString().slice(0, 8);
    const name = { info: 'Note', warning: 'Warning', error: 'Error' }[level] ?? level;
    this.list.append(
      make('li', { class: level }, make('time', {}, time), make('b', {}, name), make('span', {}, text)),
    );
    while (this.list.children.length > most) this.list.firstElementChild?.remove();
    this.none.hidden = true;
    if (isAtEnd) this.list.scrollTop = this.list.scrollHeight;
    if (level !== 'info' && !this.isShown()) this.setUnread(this.unread + 1);
  }

  read(): void {
    this.setUnread(0);
  }

  private setUnread(count: number): void {
    this.unread = count;
    this.count.textContent = String(count);
    this.count.hidden = count === 0;
  }
}
