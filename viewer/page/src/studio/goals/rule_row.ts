// SPDX-License-Identifier: GPL-3.0-or-later
// One goal, fault, clock or complication: whether it counts, and its numbers as their declaration allows them.
import { el, setText } from '../../hud/dom';
import { said } from '../../languages/said';
import { text } from '../../languages/text';
import { toggle } from '../fields';
import type { ElementKind, Parameter } from '../scene_editor/declarations';
import { faultOf, joined, partsOf, rangeText } from '../scene_editor/values';
import { complicationWords, parameterWords } from './parameter_words';
import type { Rule } from './rules';

export interface Asks {
  /** What was chosen for a parameter, '': whether it is left out; null: nothing. */
  chosen(parameter: string): string | null;
  /** null: as proposed. */
  choose(parameter: string, value: string | null): void;
}

/** Whether an author is asked for it: one number, of what a trainee does. */
const isAsked = (p: Parameter): boolean => p.numbers === 1 && p.reference === '';

export class RuleRow {
  readonly root: HTMLElement;

  constructor(
    readonly rule: Rule,
    kind: ElementKind,
    key: string,
    private readonly asks: Asks,
  ) {
    const words =
      rule.element === 'complication' ? complicationWords(rule.values.get('command') ?? '') : said(rule.text);
    const counts = toggle(words === '' ? kind.doc : words);
    counts.input.checked = asks.chosen('') !== 'off';
    counts.input.onchange = () => asks.choose('', counts.input.checked ? null : 'off');
    const fields = kind.parameters.filter(isAsked).map((p) => this.field(p, `${key}-${p.name}`));
    for (const field of fields) field.hidden = !counts.input.checked;
    this.root = el('div', { class: 'rule', role: 'group', 'aria-label': words || kind.doc }, counts.root, ...fields);
  }

  private field(p: Parameter, id: string): HTMLElement {
    const proposed = this.rule.values.get(p.name) ?? p.fallback;
    const value = this.asks.chosen(p.name) ?? proposed;
    const unit = partsOf(proposed)?.unit ?? '';
    const input = el('input', { type: 'text', autocomplete: 'off', id, 'aria-describedby': `${id}-about` });
    const parts = partsOf(value);
    input.value = parts && parts.unit === unit ? parts.numbers : value;
    const about = el('p', { class: 'hint', id: `${id}-about` });
    const typed = () => {
      const given = partsOf(input.value);
      return given && given.unit === '' ? joined({ ...given, unit }) : input.value.trim();
    };
    const tell = () => {
      const fault = faultOf(p, typed());
      about.className = fault === '' ? 'hint' : 'bad';
      input.setAttribute('aria-invalid', String(fault !== ''));
      const range = rangeText(p);
      setText(about, fault || (range === '' ? '' : text('Range: {range}', { range })));
      return fault === '';
    };
    input.oninput = tell;
    input.onchange = () => {
      if (input.value.trim() === '') return this.asks.choose(p.name, null);
      if (tell()) this.asks.choose(p.name, typed() === proposed ? null : typed());
    };
    tell();
    const words = parameterWords(this.rule.element, p.name);
    const label = el('label', { for: id }, words === '' ? el('span', { lang: 'en' }, p.doc) : words);
    return el('div', { class: 'rule-value' }, label, el('span', {}, input, ' ', unit), about);
  }
}
