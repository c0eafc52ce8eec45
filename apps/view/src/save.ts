import { type Client, Refusal } from './protocol';
import { byId, setText } from './dom';

/// A name within the server's output folder: no folders, no hidden files.
const plainName = /^[^\\/:*?"<>|.\s][^\\/:*?"<>|]*\.(exr|png)$/i;

/// Asks for a name and has the server write the picture.
export class SaveDialog {
  private readonly dialog = byId<HTMLDialogElement>('save-dialog');
  private readonly name = byId<HTMLInputElement>('save-name');
  private readonly message = byId('save-message');

  constructor(
    private readonly client: Client,
    private readonly saved: (file: string) => void,
    private readonly onError: (error: unknown) => void,
  ) {
    byId('save').addEventListener('click', () => this.open());
    byId<HTMLFormElement>('save-form').addEventListener('submit', (event) => {
      event.preventDefault();
      void this.save();
    });
    byId('save-cancel').addEventListener('click', () => this.dialog.close());
    for (const button of this.dialog.querySelectorAll<HTMLButtonElement>('[data-ending]'))
      button.addEventListener('click', () => this.setEnding(button.dataset.ending!));
    this.name.addEventListener('input', () => this.showEnding());
  }

  open(): void {
    if (this.dialog.open) return;
    this.tell('');
    this.showEnding();
    this.dialog.showModal();
    this.name.focus();
    this.name.setSelectionRange(0, this.name.value.lastIndexOf('.'));
  }

  private setEnding(ending: string): void {
    this.name.value = `${this.name.value.replace(/\.[^.]*$/, '')}.${ending}`;
    this.showEnding();
    this.name.focus();
  }

  private showEnding(): void {
    const ending = /\.([^.]*)$/.exec(this.name.value)?.[1]?.toLowerCase();
    for (const button of this.dialog.querySelectorAll<HTMLButtonElement>('[data-ending]'))
      button.setAttribute('aria-pressed', String(button.dataset.ending === ending));
  }

  private async save(): Promise<void> {
    const name = this.name.value.trim();
    if (!plainName.test(name)) return this.tell('Give a plain name that ends in .exr or .png, without folders.');
    try {
      const { file } = await this.client.command({ save: { name } });
      this.dialog.close();
      this.saved(file ?? name);
    } catch (error) {
      if (error instanceof Refusal) this.tell([error.message, error.remedy].filter(Boolean).join(' – '));
      else this.onError(error);
    }
  }

  private tell(text: string): void {
    setText(this.message, text);
    this.message.hidden = text === '';
  }
}
