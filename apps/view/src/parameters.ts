import type { Client, Parameter, ParameterValue, Parameters, SceneObject } from './protocol';
import { Refusal } from './protocol';
import { byId, make, setText } from './dom';
import { Latest } from './latest';
import { type Control, controlFor } from './parameter_control';

interface Row {
  parameter: Parameter;
  initial: ParameterValue; // as the scene had it when the page first saw it
  control: Control;
  element: HTMLElement;
  message: HTMLElement;
  back: HTMLButtonElement;
}

/// Families in the order in which they are changed most; others follow.
const families = ['emitter', 'bsdf', 'texture', 'medium', 'shape', 'sensor', 'film', 'integrator'];
const sendMs = 100;
const readMs = 800;

/// The scene's objects with a control for each parameter. Edits go out at most ten times a second;
/// a refused one is told at its row, and the picture stays.
export class ParametersPanel {
  private readonly list = byId('objects');
  private readonly filter = byId<HTMLInputElement>('parameter-filter');
  private readonly integrators = byId<HTMLSelectElement>('integrator');
  private readonly rows = new Map<string, Row>();
  private shape = '';
  private reading = 0;
  private readonly sender: Latest<Record<string, ParameterValue>>;

  constructor(
    private readonly client: Client,
    private readonly onError: (error: unknown) => void,
  ) {
    this.sender = new Latest(
      (edits) => this.send(edits),
      sendMs,
      (older, newer) => ({ ...older, ...newer }),
    );
    this.filter.addEventListener('input', () => this.applyFilter());
  }

  /// Reads the tables soon, and once for several changes.
  readSoon(ms = readMs): void {
    clearTimeout(this.reading);
    this.reading = window.setTimeout(() => void this.read(), ms);
  }

  private async read(): Promise<void> {
    if (!this.sender.isIdle) return this.readSoon();
    try {
      this.show(await this.client.parameters());
    } catch (error) {
      this.onError(error);
    }
  }

  private show({ objects, integrators }: Parameters): void {
    this.showIntegrators(integrators);
    const shape = JSON.stringify(objects.map(({ id, type, parameters }) => [id, type, parameters.map((p) => p.name)]));
    if (shape !== this.shape) {
      this.shape = shape;
      this.rows.clear();
      const shown = ordered(objects.filter((o) => o.parameters.length > 0));
      this.list.replaceChildren(...shown.map((o, i) => this.section(o, i < 4 && o.parameters.length <= 8)));
      byId('objects-none').hidden = this.rows.size > 0;
      this.applyFilter();
    }
    for (const object of objects)
      for (const parameter of object.parameters) {
        const row = this.rows.get(`${object.id}.${parameter.name}`);
        if (row && !row.control.isBusy()) this.showValue(row, parameter.value);
      }
  }

  private showIntegrators(names: string[]): void {
    const shown = [...this.integrators.options].map((option) => option.value);
    if (shown.join('\n') === names.join('\n')) return;
    const now = this.integrators.value || this.integrators.dataset.now;
    this.integrators.replaceChildren(...names.map((name) => new Option(name, name)));
    if (now) this.integrators.value = now;
  }

  private section(object: SceneObject, isOpen: boolean): HTMLElement {
    const title = make('summary', {}, make('b', {}, object.id), make('span', {}, `${object.family} · ${object.type}`));
    const rows = object.parameters.map((parameter) => this.row(object.id, parameter));
    return make('details', { class: 'object', open: isOpen, 'data-object': object.id }, title, ...rows);
  }

  private row(id: string, parameter: Parameter): HTMLElement {
    const name = `${id}.${parameter.name}`;
    const label = parameter.name.replaceAll('_', ' ');
    const message = make('p', { class: 'row-message', role: 'alert', hidden: true });
    const control = controlFor(parameter, `${id}: ${label}`, (value) => this.changed(name, value));
    const back = make('button', { class: 'back', type: 'button', title: 'Back to the value that the scene had', 'aria-label': `${label}: back to the value that the scene had`, hidden: true }, '↺');
    const element = make(
      'div',
      { class: `parameter ${parameter.kind}`, 'data-parameter': name, title: parameter.about ?? undefined },
      make('span', { class: 'name' }, label, ...(parameter.unit ? [make('small', {}, parameter.unit)] : [])),
      control.element,
      back,
      message,
    );
    const row = { parameter, initial: parameter.value, control, element, message, back };
    control.show(parameter.value);
    back.addEventListener('click', () => {
      control.show(row.initial);
      this.changed(name, row.initial);
    });
    this.rows.set(name, row);
    return element;
  }

  private showValue(row: Row, value: ParameterValue): void {
    row.parameter.value = value;
    row.control.show(value);
    row.back.hidden = isSame(value, row.initial);
  }

  private changed(name: string, value: ParameterValue): void {
    const row = this.rows.get(name);
    if (!row) return;
    row.parameter.value = value;
    row.back.hidden = isSame(value, row.initial);
    row.message.hidden = true;
    this.sender.push({ [name]: value });
  }

  private async send(edits: Record<string, ParameterValue>): Promise<void> {
    try {
      await this.client.command({ set: edits });
    } catch (error) {
      if (error instanceof Refusal && error.status !== 403) this.tell(Object.keys(edits), error);
      else this.onError(error);
    }
  }

  private tell(names: string[], refusal: Refusal): void {
    const text = [refusal.message, refusal.remedy].filter(Boolean).join(' – ');
    for (const name of names) {
      const row = this.rows.get(name);
      if (!row) continue;
      setText(row.message, text);
      row.message.hidden = false;
    }
  }

  private applyFilter(): void {
    const words = this.filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const section of this.list.querySelectorAll<HTMLDetailsElement>('details')) {
      let shown = 0;
      for (const row of section.querySelectorAll<HTMLElement>('.parameter')) {
        const text = `${row.dataset.parameter} ${section.querySelector('summary')?.textContent}`.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
        shown += row.hidden ? 0 : 1;
      }
      section.hidden = shown === 0;
      if (words.length > 0 && shown > 0) section.open = true;
    }
  }
}

function ordered(objects: SceneObject[]): SceneObject[] {
  const place = ({ family }: SceneObject) => (families.includes(family) ? families.indexOf(family) : families.length);
  return [...objects].sort((a, b) => place(a) - place(b));
}

function isSame(a: ParameterValue, b: ParameterValue): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}
