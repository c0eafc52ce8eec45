import { byId, isTyping, make } from './dom';

/// One table: what keys do, and what the help says of them.
export interface Shortcut {
  keys: string[]; // as KeyboardEvent.key has them; 'Shift+' where a letter needs it
  shown: string;
  text: string;
  group: string;
  run(event: KeyboardEvent): void;
}

/// What has no key of its own, for the help.
export interface Hint {
  shown: string;
  text: string;
  group: string;
}

/// '+' joins keys, unless it stands alone.
function isKey(part: string, shown: string): boolean {
  return /^[A-Z?0-9−[\]]$|^(Space|Shift|Ctrl|Alt|Esc|Arrows)$/.test(part) || (part === '+' && shown === '+');
}

export class Keyboard {
  private readonly help = byId<HTMLDialogElement>('help-dialog');

  constructor(
    private readonly shortcuts: Shortcut[],
    hints: Hint[],
  ) {
    document.addEventListener('keydown', (event) => this.pressed(event));
    byId('help').addEventListener('click', () => this.toggleHelp());
    byId('help-close').addEventListener('click', () => this.help.close());
    this.help.addEventListener('click', (event) => event.target === this.help && this.help.close());
    this.writeHelp([...shortcuts, ...hints]);
  }

  toggleHelp(): void {
    if (this.help.open) this.help.close();
    else this.help.showModal();
  }

  private pressed(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
    const isOnControl = event.target instanceof Element && event.target.closest('button, a, summary, input, [role=tab]');
    if (isOnControl && (event.key === ' ' || event.key === 'Enter' || event.key.startsWith('Arrow'))) return;
    if (document.querySelector('dialog[open]') && event.key !== '?') return;
    const key = event.shiftKey && event.key.length === 1 && /[a-z]/i.test(event.key) ? `Shift+${event.key.toLowerCase()}` : event.key;
    const shortcut = this.shortcuts.find(({ keys }) => keys.includes(key));
    if (!shortcut) return;
    event.preventDefault();
    shortcut.run(event);
  }

  private writeHelp(lines: (Shortcut | Hint)[]): void {
    const groups = new Map<string, HTMLElement>();
    for (const { shown, text, group } of lines) {
      let list = groups.get(group);
      if (!list) {
        list = make('dl');
        groups.set(group, list);
      }
      const keys = shown.split(' ').map((part) => (isKey(part, shown) ? make('kbd', {}, part) : part));
      const term = make('dt');
      keys.forEach((key, i) => term.append(...(i ? [' ', key] : [key])));
      list.append(make('div', {}, term, make('dd', {}, text)));
    }
    byId('help-text').replaceChildren(
      ...[...groups].map(([title, list]) => make('section', {}, make('h3', {}, title), list)),
    );
  }
}
