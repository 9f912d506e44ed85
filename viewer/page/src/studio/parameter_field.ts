// SPDX-License-Identifier: GPL-3.0-or-later
// A field for one parameter of a case, with the unit and the range of its declaration.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import type { Parameter } from './scene_editor/declarations';
import { faultOf, joined, partsOf, rangeText } from './scene_editor/values';

export interface ParameterValue {
  proposed: string;
  /** In which it is shown; that of the proposal if it is not given. */
  unit?: string;
  /** null: nothing. */
  chosen: string | null;
  /** null: as proposed. */
  choose(value: string | null): void;
  /** What else is wrong with a value that its declaration allows; '': nothing. */
  fault?(value: string): string;
}

/** words: the label, '': the declaration's own, in English. */
export function parameterField(p: Parameter, id: string, words: string, value: ParameterValue): HTMLElement {
  const unit = value.unit ?? partsOf(value.proposed)?.unit ?? '';
  const input = el('input', { type: 'text', autocomplete: 'off', id, 'aria-describedby': `${id}-about` });
  const shown = value.chosen ?? value.proposed;
  const parts = partsOf(shown);
  // What is typed later differs from it.
  input.defaultValue = parts && parts.unit === unit ? parts.numbers : shown;
  const about = el('p', { class: 'hint', id: `${id}-about` });
  const typed = () => {
    const given = partsOf(input.value);
    return given && given.unit === '' ? joined({ ...given, unit }) : input.value.trim();
  };
  const tell = () => {
    const fault = faultOf(p, typed()) || (value.fault?.(typed()) ?? '');
    about.className = fault === '' ? 'hint' : 'bad';
    input.setAttribute('aria-invalid', String(fault !== ''));
    const range = rangeText(p);
    setText(about, fault || (range === '' ? '' : text('Range: {range}', { range })));
    return fault === '';
  };
  input.oninput = tell;
  input.onchange = () => {
    const empty = input.value.trim() === '';
    if (!empty && !tell()) return;
    input.defaultValue = input.value;
    value.choose(empty || typed() === value.proposed ? null : typed());
  };
  tell();
  const label = el('label', { for: id }, words === '' ? el('span', { lang: 'en' }, p.doc) : words);
  return el('div', { class: 'rule-value' }, label, el('span', {}, input, ' ', unit), about);
}
