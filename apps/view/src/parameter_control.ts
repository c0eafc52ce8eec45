import type { Parameter, ParameterValue } from './protocol';
import { hexFromLinear, linearFromHex } from './color';
import { make } from './dom';

/// One control for one parameter: shows values, tells of new ones.
export interface Control {
  element: HTMLElement;
  show(value: ParameterValue): void;
  isBusy(): boolean; // somebody is at it: values from elsewhere wait
}

type Changed = (value: ParameterValue) => void;

export function controlFor(parameter: Parameter, label: string, changed: Changed): Control {
  if (parameter.kind === 'boolean') return switchControl(label, changed);
  if (parameter.kind === 'choice') return choiceControl(parameter, label, changed);
  if (parameter.kind === 'color' && isColor(parameter.value)) return colorControl(label, changed);
  const isNumber = typeof parameter.value === 'number';
  if ((parameter.kind === 'number' || parameter.kind === 'integer') && isNumber)
    return numberControl(parameter, label, changed);
  return textControl(parameter.kind, label, changed);
}

function isColor(value: ParameterValue): value is number[] {
  return Array.isArray(value) && value.length === 3;
}

function has(element: Element): boolean {
  return element.contains(document.activeElement);
}

function switchControl(label: string, changed: Changed): Control {
  const box = make('input', { type: 'checkbox', role: 'switch', 'aria-label': label });
  box.addEventListener('change', () => changed(box.checked));
  return { element: make('div', { class: 'control' }, box), show: (v) => (box.checked = v === true), isBusy: () => false };
}

function choiceControl(parameter: Parameter, label: string, changed: Changed): Control {
  const list = make('select', { 'aria-label': label });
  list.append(...(parameter.choices ?? []).map((choice) => new Option(choice, choice)));
  list.addEventListener('change', () => changed(list.value));
  return {
    element: make('div', { class: 'control' }, list),
    show: (value) => (list.value = String(value ?? '')),
    isBusy: () => has(list),
  };
}

/// Also for what has no value yet, and no default.
function textControl(kind: Parameter['kind'], label: string, changed: Changed): Control {
  const field = make('input', { type: 'text', 'aria-label': label, spellcheck: 'false' });
  let isList = false;
  field.addEventListener('change', () => {
    const numbers = field.value.split(/[\s,]+/).filter(Boolean).map(Number);
    if (numbers.length === 0 && kind !== 'text') return;
    const areNumbers = numbers.every(Number.isFinite);
    if (areNumbers && (kind === 'number' || kind === 'integer') && numbers.length === 1) changed(numbers[0]!);
    else changed(areNumbers && (isList || kind === 'color') ? numbers : field.value);
  });
  const show = (value: ParameterValue) => {
    isList = Array.isArray(value);
    field.placeholder = value === null ? 'as in the scene' : '';
    field.value = Array.isArray(value) ? value.map(short).join(', ') : String(value ?? '');
  };
  return { element: make('div', { class: 'control' }, field), show, isBusy: () => has(field) };
}

/// Slider and field. Where a table gives no upper end, the slider's goes with the value.
function numberControl(parameter: Parameter, label: string, changed: Changed): Control {
  const isWhole = parameter.kind === 'integer';
  const slider = make('input', { type: 'range', 'aria-label': label, min: 0, max: 1, step: 'any' });
  const field = make('input', { type: 'text', inputmode: 'decimal', 'aria-label': `${label}, number` });
  let track = trackOf(parameter, Number(parameter.value), isWhole);
  const show = (value: ParameterValue) => {
    const number = Number(value);
    field.value = short(number);
    if (document.activeElement !== slider || number > track.maximum || number < track.minimum)
      track = trackOf(parameter, number, isWhole);
    slider.value = String(track.position(number));
    slider.setAttribute('aria-valuetext', `${short(number)} ${parameter.unit ?? ''}`.trim());
  };
  slider.addEventListener('input', () => {
    const value = track.value(Number(slider.value));
    field.value = short(value);
    slider.setAttribute('aria-valuetext', `${short(value)} ${parameter.unit ?? ''}`.trim());
    changed(value);
  });
  slider.addEventListener('change', () => {
    const value = track.value(Number(slider.value));
    track = trackOf(parameter, value, isWhole);
    slider.value = String(track.position(value));
  });
  field.addEventListener('change', () => {
    const typed = Number(field.value.replace(',', '.'));
    if (!Number.isFinite(typed)) return show(track.value(Number(slider.value)));
    const value = Math.min(parameter.maximum ?? Infinity, Math.max(parameter.minimum ?? -Infinity, typed));
    show(isWhole ? Math.round(value) : value);
    changed(isWhole ? Math.round(value) : value);
  });
  field.addEventListener('keydown', (event) => {
    if (event.key !== 'ArrowUp' && event.key !== 'ArrowDown') return;
    event.preventDefault();
    const step = isWhole ? 1 / (track.maximum - track.minimum || 1) : event.shiftKey ? 0.1 : 0.01;
    const place = track.position(Number(field.value)) + (event.key === 'ArrowUp' ? step : -step);
    const value = track.value(Math.min(1, Math.max(0, place)));
    show(value);
    changed(value);
  });
  show(parameter.value);
  return {
    element: make('div', { class: 'control pair' }, slider, field),
    show,
    isBusy: () => has(field) || slider.matches(':active'),
  };
}

interface Track {
  minimum: number;
  maximum: number;
  position(value: number): number; // from 0 to 1
  value(position: number): number;
}

function trackOf(parameter: Parameter, value: number, isWhole: boolean): Track {
  const usual = Math.max(Math.abs(value), Math.abs(Number(parameter.default) || 0)) || 1;
  const isFinite = (v: number | null | undefined): v is number => v !== null && v !== undefined && Math.abs(v) < 1e30;
  const minimum = isFinite(parameter.minimum) ? parameter.minimum : value < 0 || !isFinite(parameter.maximum) ? -4 * usual : 0;
  const ample = isWhole ? Math.ceil(4 * usual) : 4 * usual;
  const isFar = isFinite(parameter.maximum) && parameter.maximum > 1000 * usual;
  const maximum = isFinite(parameter.maximum) && !isFar ? parameter.maximum : Math.max(ample, minimum + 1e-6);
  const rounded = (v: number) => (isWhole ? Math.round(v) : Number(v.toPrecision(4)));
  if (minimum > 0 && maximum / minimum > 1000) {
    const span = Math.log(maximum / minimum);
    return {
      minimum,
      maximum,
      position: (v) => Math.log(Math.max(v, minimum) / minimum) / span,
      value: (p) => rounded(minimum * Math.exp(p * span)),
    };
  }
  return {
    minimum,
    maximum,
    position: (v) => (v - minimum) / (maximum - minimum),
    value: (p) => rounded(minimum + p * (maximum - minimum)),
  };
}

/// A colour's hue, and its largest component as a number: radiances are seldom below one.
function colorControl(label: string, changed: Changed): Control {
  const swatch = make('input', { type: 'color', 'aria-label': label });
  const size = make('input', { type: 'text', inputmode: 'decimal', 'aria-label': `${label}, largest component` });
  const parts = make('output', { class: 'number parts' });
  let value: number[] = [0, 0, 0];
  const largest = () => Math.max(...value, 0);
  const show = (next: ParameterValue) => {
    if (!isColor(next)) return;
    value = next;
    const most = largest();
    swatch.value = hexFromLinear(most > 0 ? value.map((v) => v / most) : [1, 1, 1]);
    size.value = short(most);
    parts.textContent = value.map(short).join('  ');
  };
  const take = () => {
    const hue = linearFromHex(swatch.value);
    const most = Math.max(...hue, 1e-6);
    const wanted = Math.max(0, Number(size.value.replace(',', '.')) || 0);
    const next = hue.map((v) => Number(((v / most) * wanted).toPrecision(5)));
    show(next);
    changed(next);
  };
  swatch.addEventListener('input', take);
  size.addEventListener('change', take);
  return { element: make('div', { class: 'control color' }, swatch, size, parts), show, isBusy: () => has(size) || has(swatch) };
}

function short(value: number): string {
  return String(Number(value.toPrecision(4)));
}
