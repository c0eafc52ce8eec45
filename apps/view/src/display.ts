import { byId, setText } from './dom';
import type { Frame } from './frame';
import { type LayerKind, type Operator, kindOf, titleOf } from './layers';
import { formatFixed, formatNumber } from './numbers';
import type { Look } from './picture';
import { type Scale, chosenScale, usable } from './scale';
import { Signal } from './signal';
import { photometry, shownFactor } from './units';

interface Settings {
  operator: Operator;
  exposure: number;
  isExposed: boolean; // by somebody, or once by itself
  isLogarithmic: boolean;
  minimum: number | null; // null: chosen; both in the renderer's unit
  maximum: number | null;
}

const exposureRange = { minimum: -12, maximum: 12 };
const middleGrey = 0.18;

/// How the picture is shown: layer, exposure, operator, scale of false colours. Each kind of layer
/// keeps settings of its own.
export class Display {
  readonly layer = new Signal(''); // that was chosen
  readonly asked = new Signal(''); // that is asked for: while the camera moves only the picture is there
  readonly look: Signal<Look>;
  private readonly settings = new Map<string, Settings>();
  private frame: Frame | null = null;
  private there: string[] = [''];

  private readonly layers = byId<HTMLSelectElement>('layer');
  private readonly slider = byId<HTMLInputElement>('exposure');
  private readonly field = byId<HTMLInputElement>('exposure-number');
  private readonly auto = byId<HTMLButtonElement>('exposure-auto');
  private readonly operators = byId('operators');
  private readonly limits = {
    minimum: byId<HTMLInputElement>('scale-minimum'),
    maximum: byId<HTMLInputElement>('scale-maximum'),
  };
  private readonly logarithmic = byId<HTMLInputElement>('scale-logarithmic');

  constructor() {
    this.look = new Signal(this.madeLook());
    this.slider.min = this.field.min = String(exposureRange.minimum);
    this.slider.max = this.field.max = String(exposureRange.maximum);
    this.listen();
    this.layer.onChange(() => this.ask());
    this.asked.onChange(() => this.update());
    photometry.onChange(() => this.update());
    this.update();
  }

  get kind(): LayerKind {
    return kindOf(this.asked.value);
  }

  setLayers(names: string[]): void {
    this.there = names;
    const shown = [...this.layers.options].map((option) => option.value);
    // The list stays while the camera moves; only what is there is asked for.
    if (names.some((name) => !shown.includes(name)))
      this.layers.replaceChildren(...names.map((name) => new Option(titleOf(name), name)));
    this.ask();
  }

  nextLayer(step: number): void {
    const names = [...this.layers.options].map((option) => option.value);
    const now = names.indexOf(this.layer.value);
    this.layer.value = names[(now + step + names.length) % names.length] ?? '';
  }

  /// A new frame: scales that are chosen from it follow; so does the exposure, the first time.
  see(frame: Frame): void {
    this.frame = frame;
    const settings = this.now();
    if (!settings.isExposed && this.kind.exposes) this.exposeByItself();
    else this.update();
  }

  setExposure(stops: number): void {
    const settings = this.now();
    const { minimum, maximum } = exposureRange;
    settings.exposure = Math.min(maximum, Math.max(minimum, Math.round(stops * 100) / 100));
    settings.isExposed = true;
    this.update();
  }

  exposeBy(stops: number): void {
    this.setExposure(this.now().exposure + stops);
  }

  /// The mean of what is lit, on a scale of logarithms, becomes middle grey.
  exposeByItself(): void {
    const lit = this.frame?.layer === this.asked.value ? this.frame.someLuminances().filter((v) => v > 0) : null;
    if (!lit?.length) return;
    let sum = 0;
    for (const value of lit) sum += Math.log2(value);
    this.setExposure(Math.round((Math.log2(middleGrey) - sum / lit.length) * 10) / 10);
  }

  setOperator(operator: Operator): void {
    this.now().operator = operator;
    this.update();
  }

  private ask(): void {
    this.layers.value = this.layer.value;
    this.asked.value = this.there.includes(this.layer.value) ? this.layer.value : '';
  }

  private now(): Settings {
    const { kind } = this;
    let settings = this.settings.get(kind.id);
    if (!settings) {
      settings = {
        operator: kind.operator, exposure: 0, isExposed: false,
        isLogarithmic: false, minimum: null, maximum: null,
      };
      this.settings.set(kind.id, settings);
    }
    return settings;
  }

  private scale(): Scale {
    const { isLogarithmic, minimum, maximum } = this.now();
    const values = this.frame?.layer === this.asked.value ? this.frame.someLuminances() : new Float64Array();
    const chosen = chosenScale(values, isLogarithmic && !this.kind.isSigned, this.kind.isSigned);
    return usable({
      minimum: minimum ?? chosen.minimum,
      maximum: maximum ?? chosen.maximum,
      isLogarithmic: chosen.isLogarithmic,
    });
  }

  private madeLook(): Look {
    const { operator, exposure } = this.now();
    const showsDirections = this.kind.id === 'N' && operator !== 'falsecolor';
    return {
      operator: showsDirections ? 'directions' : operator,
      exposure,
      scale: operator === 'falsecolor' ? this.scale() : { minimum: 0, maximum: 1, isLogarithmic: false },
      isSigned: this.kind.isSigned,
    };
  }

  private update(): void {
    const settings = this.now();
    // The frame before is shown as it was until there is one of the layer that was asked for.
    if (!this.frame || this.frame.layer === this.asked.value) this.look.value = this.madeLook();
    this.slider.value = String(settings.exposure);
    this.slider.setAttribute('aria-valuetext', `${formatFixed(settings.exposure, 1)} stops`);
    if (document.activeElement !== this.field) this.field.value = settings.exposure.toFixed(1);
    for (const button of this.operators.querySelectorAll('button'))
      button.setAttribute('aria-pressed', String(button.dataset.operator === settings.operator));
    const isFalse = settings.operator === 'falsecolor';
    byId('exposure-group').hidden = isFalse;
    byId('scale-group').hidden = !isFalse;
    this.showScale(settings);
  }

  private showScale(settings: Settings): void {
    const { scale } = this.look.value;
    this.logarithmic.checked = settings.isLogarithmic;
    this.logarithmic.disabled = this.kind.isSigned;
    const factor = this.kind.isLight ? shownFactor() : 1;
    for (const side of ['minimum', 'maximum'] as const) {
      const field = this.limits[side];
      if (document.activeElement !== field) field.value = Number((scale[side] * factor).toPrecision(4)).toString();
      field.classList.toggle('chosen', settings[side] !== null);
    }
    const isChosen = settings.minimum !== null || settings.maximum !== null;
    byId<HTMLButtonElement>('scale-auto').setAttribute('aria-pressed', String(!isChosen));
    setText(byId('scale-about'), `From ${formatNumber(scale.minimum * factor)} to ${formatNumber(scale.maximum * factor)}`);
  }

  private listen(): void {
    this.layers.addEventListener('change', () => (this.layer.value = this.layers.value));
    this.slider.addEventListener('input', () => this.setExposure(Number(this.slider.value)));
    this.field.addEventListener('change', () => this.setExposure(Number(this.field.value) || 0));
    byId('exposure-group').addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        this.exposeBy(event.deltaY < 0 ? 0.1 : -0.1);
      },
      { passive: false },
    );
    this.slider.addEventListener('dblclick', () => this.setExposure(0));
    this.auto.addEventListener('click', () => this.exposeByItself());
    this.operators.addEventListener('click', (event) => {
      const operator = (event.target as Element).closest('button')?.dataset.operator;
      if (operator) this.setOperator(operator as Operator);
    });
    this.logarithmic.addEventListener('change', () => {
      this.now().isLogarithmic = this.logarithmic.checked;
      this.update();
    });
    for (const side of ['minimum', 'maximum'] as const)
      this.limits[side].addEventListener('change', () => {
        const typed = this.limits[side].value.trim();
        const factor = this.kind.isLight ? shownFactor() : 1;
        this.now()[side] = typed === '' || !Number.isFinite(Number(typed)) ? null : Number(typed) / factor;
        this.update();
      });
    byId('scale-auto').addEventListener('click', () => {
      const settings = this.now();
      settings.minimum = settings.maximum = null;
      this.update();
    });
  }
}
