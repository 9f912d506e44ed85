// SPDX-License-Identifier: GPL-3.0-or-later
// One goal, fault, clock or complication: whether it counts, and its numbers as their declaration allows them.
import { el } from '../../hud/dom';
import { said } from '../../languages/said';
import { toggle } from '../fields';
import { parameterField } from '../parameter_field';
import type { ElementKind, Parameter } from '../scene_editor/declarations';
import { complicationWords, isOfStrands, parameterWords, strandWords } from './parameter_words';
import type { Rule } from './rules';

export interface Asks {
  /** What was chosen for a parameter, '': whether it is left out; null: nothing. */
  chosen(parameter: string): string | null;
  /** null: as proposed. */
  choose(parameter: string, value: string | null): void;
}

/** Whether an author is asked for it: one number, of what a trainee does; of strands, what a hand feels. */
const isAsked = (element: string, p: Parameter): boolean =>
  p.numbers === 1 && p.reference === '' && (!isOfStrands(element) || parameterWords(element, p.name) !== '');

function wordsOf(rule: Rule): string {
  if (isOfStrands(rule.element)) return strandWords(rule.element, rule.id);
  return rule.element === 'complication' ? complicationWords(rule.values.get('command') ?? '') : said(rule.text);
}

export class RuleRow {
  readonly root: HTMLElement;

  constructor(
    readonly rule: Rule,
    kind: ElementKind,
    key: string,
    private readonly asks: Asks,
  ) {
    const words = wordsOf(rule);
    const counts = toggle(words === '' ? kind.doc : words);
    counts.input.checked = asks.chosen('') !== 'off';
    counts.input.onchange = () => asks.choose('', counts.input.checked ? null : 'off');
    const fields = kind.parameters
      .filter((p) => isAsked(rule.element, p))
      .map((p) => this.field(p, `${key}-${p.name}`));
    for (const field of fields) field.hidden = !counts.input.checked;
    this.root = el('div', { class: 'rule', role: 'group', 'aria-label': words || kind.doc }, counts.root, ...fields);
  }

  private field(p: Parameter, id: string): HTMLElement {
    const words = parameterWords(this.rule.element, p.name);
    return parameterField(p, id, words, {
      proposed: this.rule.values.get(p.name) ?? p.fallback,
      chosen: this.asks.chosen(p.name),
      choose: (value) => this.asks.choose(p.name, value),
    });
  }
}
