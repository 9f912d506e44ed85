// SPDX-License-Identifier: GPL-3.0-or-later
// Goals, faults, clocks and complications of the exercises, as forms that are made of their declarations. Changes are
// choices like any other, and are taken over by the next build.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Project } from '../api';
import type { Asks } from '../editor';
import { exerciseText } from '../exercise_text';
import type { ScenesApi } from '../scene_editor/api';
import type { Declarations } from '../scene_editor/declarations';
import { field, replaceRows, select } from '../fields';
import { reason } from '../wording';
import { RuleRow } from './rule_row';
import { changeOf, type Rule, withChange } from './rules';

export class GoalsPanel {
  readonly root: HTMLElement;
  private readonly exercise = select([]);
  private readonly rows = el('div', { class: 'rules' });
  private readonly proposed = el('button', { type: 'button' }, text('All as proposed'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private declarations: Declarations | null = null;
  private project: Project | null = null;
  private shown = '';

  constructor(
    private readonly asks: Asks,
    private readonly api: ScenesApi,
  ) {
    this.exercise.onchange = () => this.fill();
    this.proposed.onclick = () => void asks.choose({ rules: [] });
    this.root = el(
      'section',
      { class: 'goals' },
      el('h3', {}, text('6. Goals and limits')),
      el(
        'p',
        { class: 'hint' },
        text('What trainees are to reach, and what counts against them. Build again afterwards.'),
      ),
      field(text('Exercise'), this.exercise),
      this.rows,
      this.proposed,
      this.say,
    );
  }

  show(p: Project): void {
    const all = p.built?.rules ?? [];
    this.root.hidden = all.length === 0;
    const before = this.project?.built?.rules ?? [];
    this.project = p;
    if (all.length === 0) return;
    if (JSON.stringify(all.map((e) => e.file)) !== JSON.stringify(before.map((e) => e.file))) {
      const chosen = this.exercise.value || '3';
      this.exercise.replaceChildren(
        ...all.map((e) => el('option', { value: String(e.exercise) }, exerciseText(e.file))),
      );
      this.exercise.value = all.some((e) => String(e.exercise) === chosen) ? chosen : String(all[0]!.exercise);
    }
    this.proposed.disabled = p.choices.rules.length === 0;
    void this.load();
  }

  /** Declarations are asked for when they are first needed. */
  private async load(): Promise<void> {
    try {
      this.declarations ??= await this.api.declarations();
      this.fill();
    } catch (e) {
      setText(this.say, reason(e));
    }
  }

  private fill(): void {
    const [project, declarations] = [this.project, this.declarations];
    const exercise = project?.built?.rules.find((e) => String(e.exercise) === this.exercise.value);
    if (!project || !declarations || !exercise) return;
    const now = JSON.stringify([project.name, exercise.file, this.exercise.value, project.choices.rules]);
    if (now === this.shown) return;
    this.shown = now;
    const { rules } = project.choices;
    const strands = this.rowsOf(exercise.exercise, exercise.strands, declarations, rules);
    const heading = strands.length > 0 ? [el('h4', {}, text('Strands'))] : [];
    const goals = this.rowsOf(exercise.exercise, exercise.rules, declarations, rules);
    replaceRows(this.rows, [...goals, ...heading, ...strands]);
  }

  private rowsOf(exercise: number, rules: Rule[], declarations: Declarations, changes: string[]): HTMLElement[] {
    return rules.flatMap((rule) => {
      const kind = declarations.get(rule.element);
      if (!kind) return [];
      const row = new RuleRow(rule, kind, `rule-${exercise}-${rule.id}`, {
        chosen: (parameter) => changeOf(changes, exercise, rule.id, parameter),
        choose: (parameter, value) =>
          void this.asks.choose((now) => ({ rules: withChange(now.rules, exercise, rule.id, parameter, value) })),
      });
      return [row.root];
    });
  }
}
