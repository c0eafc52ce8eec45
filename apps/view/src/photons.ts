import type { Client, State } from './protocol';
import { byId, fitCanvas, make, setText } from './dom';
import type { Frame } from './frame';
import { formatCount } from './numbers';
import { PhotonCanvas } from './photon_canvas';
import { type PhotonColour, PhotonCloud, photonColours } from './photon_cloud';
import type { Placement } from './picture';
import { Signal } from './signal';
import { store, stored } from './stored';

const most = 30000;

/// Photons over the picture: asks for them while they are shown, whenever the scene is another,
/// and says what their colours mean.
export class Photons {
  readonly changed = new Signal(0);
  private isShown = false;
  private colour: PhotonColour;
  private hidden = new Set<number>();
  private cloud: PhotonCloud | null = null;
  private canvas: PhotonCanvas | null = null;
  private revision = -1; // of the scene that was asked about last
  private asks = 0; // the last counts
  private isWaiting = false;
  private cannotShow = ''; // why

  private readonly element = byId<HTMLCanvasElement>('photons');
  private readonly button = byId('show-photons');
  private readonly box = byId('photon-legend');
  private readonly choice = byId<HTMLSelectElement>('photon-colour');

  constructor(
    private readonly client: Client,
    private readonly state: Signal<State | null>,
    private readonly onError: (error: unknown) => void,
  ) {
    this.colour = photonColours.find((name) => name === stored('photons')) ?? 'kind';
    this.choice.value = this.colour;
    this.choice.addEventListener('change', () => this.colourBy(this.choice.value as PhotonColour));
    this.button.addEventListener('click', () => this.toggle());
    state.onChange(() => this.follow());
    this.update();
  }

  toggle(): void {
    this.isShown = !this.isShown;
    this.revision = -1;
    this.follow();
    this.update();
  }

  /// Over a picture that lies there; `ratio`: pixels of the canvas for one of CSS.
  draw(frame: Frame | null, size: { width: number; height: number }, at: Placement, ratio: number): void {
    this.element.hidden = !this.isShown;
    if (!this.isShown) return;
    this.showWhy(frame && !frame.projection ? 'This camera sees no straight lines: no points can be drawn.' : '');
    if (!this.canvas) return;
    fitCanvas(this.element);
    const zoom = (at.right - at.left) / ratio / size.width;
    if (frame?.projection && this.cloud)
      this.canvas.draw(frame.projection, size, at, ratio * Math.min(7, Math.max(2, 1.1 * zoom)));
    else this.canvas.clear();
  }

  private colourBy(colour: PhotonColour): void {
    this.colour = colour;
    this.hidden.clear();
    store('photons', colour);
    this.update();
  }

  /// Moves of the camera change nothing; what else does is known at rest.
  private follow(): void {
    const now = this.state.value;
    if (!this.isShown || !now || now.revision === this.revision) return;
    if (now.is_moving && this.cloud) return;
    this.revision = now.revision;
    void this.ask();
  }

  private async ask(): Promise<void> {
    const ask = ++this.asks;
    this.isWaiting = true;
    this.showLegend();
    try {
      const answer = await this.client.photons(most, this.cloud?.head.key ?? null);
      if (ask !== this.asks) return;
      if (answer) this.cloud = PhotonCloud.read(await answer.arrayBuffer());
      if (answer) this.hidden.clear();
    } catch (error) {
      if (ask !== this.asks) return;
      this.revision = -1; // the next state asks again
      this.onError(error);
    }
    this.isWaiting = false;
    this.update();
  }

  private update(): void {
    this.button.setAttribute('aria-pressed', String(this.isShown));
    this.box.hidden = !this.isShown;
    if (this.isShown && this.cloud) this.fill(this.cloud);
    this.showLegend();
    this.changed.value += 1;
  }

  private fill(cloud: PhotonCloud): void {
    try {
      this.canvas ??= new PhotonCanvas(this.element);
    } catch (error) {
      return this.onError(error);
    }
    this.canvas.setPositions(cloud.positions);
    this.canvas.setClasses(cloud.classes(this.colour), cloud.classOf(this.colour), this.hidden);
  }

  private showWhy(text: string): void {
    if (text === this.cannotShow) return;
    this.cannotShow = text;
    this.showLegend();
  }

  private showLegend(): void {
    const { cloud } = this;
    const about = cloud ? `${formatCount(cloud.head.count)} of ${formatCount(cloud.head.total)} photons` : '';
    setText(byId('photon-count'), this.isWaiting && !cloud ? 'tracing …' : about);
    const none = cloud && cloud.head.total === 0 ? 'The scene has no photons.' : '';
    setText(byId('photon-note'), this.cannotShow || none);
    const rows = (cloud?.classes(this.colour) ?? []).flatMap(({ title, colour, count }, index) => {
      if (count === 0) return [];
      const isHidden = this.hidden.has(index);
      const dot = make('i', { 'aria-hidden': 'true' });
      dot.style.background = `rgb(${colour.join(' ')})`;
      const row = make('button', { type: 'button', 'aria-pressed': !isHidden ? 'true' : 'false', title: isHidden ? 'Show' : 'Hide' }, dot, make('span', {}, title), make('span', { class: 'number' }, formatCount(count)));
      row.addEventListener('click', () => {
        if (!this.hidden.delete(index)) this.hidden.add(index);
        this.update();
      });
      return [row];
    });
    byId('photon-classes').replaceChildren(...rows);
  }
}
