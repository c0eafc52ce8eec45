import { byId } from './dom';

/// Tabs as the ARIA practices describe them: arrows move, only the chosen one has the focus order.
export class Tabs {
  private readonly list = byId('tabs');
  private readonly buttons = [...this.list.querySelectorAll<HTMLButtonElement>('[role=tab]')];

  constructor(private readonly changed: (name: string) => void) {
    for (const button of this.buttons) button.addEventListener('click', () => this.choose(button.id));
    this.list.addEventListener('keydown', (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      const now = this.buttons.findIndex((button) => button.id === this.chosen);
      const next = this.buttons[(now + step + this.buttons.length) % this.buttons.length]!;
      this.choose(next.id);
      next.focus();
    });
    this.choose(this.chosen);
  }

  get chosen(): string {
    return this.buttons.find((button) => button.getAttribute('aria-selected') === 'true')?.id ?? this.buttons[0]!.id;
  }

  choose(id: string): void {
    for (const button of this.buttons) {
      const isChosen = button.id === id;
      button.setAttribute('aria-selected', String(isChosen));
      button.tabIndex = isChosen ? 0 : -1;
      byId(button.getAttribute('aria-controls')!).hidden = !isChosen;
    }
    this.changed(id);
  }
}
