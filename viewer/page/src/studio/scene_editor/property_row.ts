// SPDX-License-Identifier: GPL-3.0-or-later
// One parameter: its value as a field, its unit, its help, and what is wrong with what is typed.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import { select } from '../fields';
import type { Parameter } from './declarations';
import { converted, faultOf, isPoint, joined, partsOf, rangeText } from './values';

export interface Asks {
  /** null: back to the default. */
  set(value: string | null): void;
  /** A point is to be placed with the mouse. */
  place(): void;
}

export class PropertyRow {
  readonly root: HTMLElement;
  private readonly input: HTMLInputElement | HTMLSelectElement;
  private readonly unit: HTMLSelectElement | null;
  private readonly fault: HTMLElement;
  /** As written in the text. */
  private value: string | null = null;

  constructor(
    readonly parameter: Parameter,
    private readonly asks: Asks,
  ) {
    const id = `parameter-${parameter.name}`;
    this.fault = el('p', { class: 'fault', id: `${id}-fault`, role: 'status' });
    this.input = this.makeInput(id);
    this.unit = parameter.units.length > 0 ? this.makeUnit() : null;
    const field = el('div', { class: 'value' }, this.input);
    if (this.unit) field.append(this.unit);
    if (isPoint(parameter)) field.append(this.makePlace());
    const help = el('p', { class: 'hint', id: `${id}-help` }, el('span', { lang: 'en' }, parameter.doc));
    const facts = this.facts();
    if (facts !== '') help.append(el('br', {}), facts);
    const label = el('label', { for: id }, parameter.name);
    if (parameter.required) label.append(' ', el('span', { class: 'hint' }, text('(required)')));
    this.root = el('div', { class: 'property' }, label, field, this.fault, help);
  }

  private facts(): string {
    const { fallback } = this.parameter;
    const range = rangeText(this.parameter);
    return [
      range === '' ? '' : text('Range: {range}', { range }),
      fallback === '' ? '' : text('Default: {value}', { value: fallback }),
    ]
      .filter(Boolean)
      .join(' · ');
  }

  private makeInput(id: string): HTMLInputElement | HTMLSelectElement {
    const { parameter: p } = this;
    const about = { id, 'aria-describedby': `${id}-help ${id}-fault` };
    if (p.choices.length > 0) {
      const none = p.fallback === '' ? text('not set') : text('default: {value}', { value: p.fallback });
      const choice = select([['', none], ...p.choices.map((c) => [c, c] as const)]);
      for (const [name, value] of Object.entries(about)) choice.setAttribute(name, value);
      choice.onchange = () => this.leave();
      return choice;
    }
    const input = el('input', { type: 'text', autocomplete: 'off', spellcheck: 'false', ...about });
    const fallback = partsOf(p.fallback);
    input.placeholder = p.units.length > 0 && fallback ? fallback.numbers : p.fallback;
    if (p.reference !== '') input.setAttribute('list', 'scene-ids');
    if (p.type === 'file') input.setAttribute('list', 'scene-files');
    input.oninput = () => this.check();
    input.onchange = () => this.leave();
    return input;
  }

  /** Shown while the picture is. */
  private makePlace(): HTMLButtonElement {
    const { name } = this.parameter;
    const label = text('Place {name} with the mouse', { name });
    const place = el('button', { type: 'button', class: 'place', title: label, 'aria-label': label }, '✥');
    place.onclick = () => this.asks.place();
    return place;
  }

  private makeUnit(): HTMLSelectElement {
    const unit = select(this.parameter.units.map((u) => [u.symbol, u.symbol] as const));
    unit.setAttribute('aria-label', text('Unit of {name}', { name: this.parameter.name }));
    unit.onchange = () => {
      if (this.value !== null) this.asks.set(converted(this.parameter, this.value, unit.value));
    };
    return unit;
  }

  /** value: as written in the text; null: the default. */
  show(value: string | null): void {
    if (value === this.value && document.activeElement === this.input) return;
    this.value = value;
    const parts = this.unit && value !== null ? partsOf(value) : null;
    const listed = parts && this.parameter.units.some((u) => u.symbol === parts.unit);
    this.input.value = value === null ? '' : listed ? parts.numbers : value;
    if (this.unit) {
      // A variable, or a unit that is not listed, stands in the field itself.
      this.unit.disabled = value !== null && !listed;
      this.unit.value = listed ? parts.unit : (partsOf(this.parameter.fallback)?.unit ?? '');
      if (this.unit.selectedIndex < 0) this.unit.selectedIndex = 0;
    }
    this.root.classList.toggle('given', value !== null);
    if (this.input instanceof HTMLSelectElement && this.input.selectedIndex < 0) this.keepUnlisted(value!);
    this.check();
  }

  /** A choice that is none of the declared ones, such as a variable. */
  private keepUnlisted(value: string): void {
    this.input.append(el('option', { value }, value));
    this.input.value = value;
  }

  /** What is typed, with its unit. */
  private get typed(): string | null {
    const value = this.input.value.trim();
    if (value === '') return null;
    const parts = this.unit ? partsOf(value) : null;
    return parts && parts.unit === '' ? joined({ ...parts, unit: this.unit!.value }) : value;
  }

  private check(): void {
    const { typed, parameter } = this;
    const fault = typed !== null ? faultOf(parameter, typed) : parameter.required ? text('A value is needed.') : '';
    setText(this.fault, fault);
    this.input.setAttribute('aria-invalid', String(fault !== ''));
  }

  private leave(): void {
    this.check();
    const { typed } = this;
    // A value that is needed stays in the text, though empty.
    if (typed !== this.value) this.asks.set(typed === null && this.parameter.required ? '' : typed);
  }
}
