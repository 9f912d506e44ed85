// SPDX-License-Identifier: GPL-3.0-or-later
// The instructor's side: everything the scene's components can be asked for, made from their own declarations; messages to the
// trainee; forces; a log of what happened.
import type { Bundle, CommandData } from '../bundle';
import { ask, find_command, message, number_argument, takes_number, type UserCommand } from './commands';
import { ForceCurves } from './curves';
import { el } from './dom';
import { clock_text } from './state';

const new_placement = 'Please take the clip off and place it again.';
const log_lines = 120;
/** What belongs to the trainee's own hands is no complication. */
const trainees = new Set(['load', 'release', 'take']);
/** Rules that know of placements offer this; it has its own button. */
const ask_again = 'ask_again';

export class InstructorPanel {
  readonly root = el('section', { class: 'panel instructor' });
  readonly curves = new ForceCurves();
  private readonly commands = el('div', { class: 'commands' });
  private bundle: Bundle | null = null;
  private readonly log = el('ol', { class: 'log', 'aria-label': 'events' });

  constructor(private readonly run: (c: UserCommand) => void) {
    const text = el('input', { type: 'text', placeholder: 'Message to the trainee', maxlength: '380', 'aria-label': 'message to the trainee' });
    const send = el('button', {}, 'Send');
    const form = el('form', { class: 'ask' }, text, send);
    form.onsubmit = (e) => {
      e.preventDefault();
      const c = message(text.value);
      if (c) this.run(c);
      text.value = '';
      text.blur();
      send.blur();
    };
    const again = el('button', { class: 'wide', 'data-ask': 'placement' }, 'Ask for a new placement');
    again.onclick = () => {
      const rule = this.bundle && find_command(this.bundle.commands, ask_again);
      // Without such a rule it is only said.
      const c = rule ? ask(rule.id, ask_again) : message(new_placement);
      if (c) this.run(c);
      again.blur();
    };
    this.root.append(el('h2', {}, 'Forces'), this.curves.root, el('h2', {}, 'Trainee'), form, again, this.commands, el('h2', {}, 'Events'), this.log);
  }

  show_scene(bundle: Bundle): void {
    this.bundle = bundle;
    const groups = bundle.commands.map((g) => ({ ...g, commands: g.commands.filter((c) => !trainees.has(c.name) && c.name !== ask_again) })).filter((g) => g.commands.length > 0);
    this.commands.replaceChildren(...groups.flatMap((g) => [
      el('h2', {}, spoken(g.id)),
      ...g.commands.map((c) => this.make_command(g.id, c)),
    ]));
    this.log.replaceChildren();
  }

  add_event(time_s: number, kind: string, id: string, text: string): void {
    const line = el('li', { 'data-kind': kind }, el('time', {}, clock_text(time_s)), el('b', {}, spoken(kind)), ` ${[spoken(id), text].filter((x) => x !== '').join(': ')}`);
    this.log.prepend(line);
    while (this.log.childElementCount > log_lines) this.log.lastElementChild!.remove();
  }

  private make_command(id: string, c: CommandData): HTMLElement {
    const go = el('button', { title: c.doc, 'data-ask': `${id} ${c.name}` }, spoken(c.name));
    if (takes_number(c)) {
      const middle = (c.min + c.max) / 2;
      const slider = el('input', { type: 'range', min: String(c.min), max: String(c.max), step: String(step_of(c)), value: String(middle), 'aria-label': `${c.name} ${c.argument}` });
      const shown = el('output', {}, label(middle, c));
      slider.oninput = () => { shown.textContent = label(Number(slider.value), c); };
      slider.onchange = () => slider.blur();
      go.onclick = () => { this.run(ask(id, c.name, number_argument(Number(slider.value), c))); go.blur(); };
      return el('div', { class: 'ask' }, go, slider, shown);
    }
    if (c.argument !== '') {
      const text = el('input', { type: 'text', placeholder: spoken(c.argument), 'aria-label': c.argument });
      go.onclick = () => { this.run(ask(id, c.name, text.value)); text.value = ''; go.blur(); };
      return el('div', { class: 'ask' }, go, text);
    }
    go.classList.add('wide');
    go.onclick = () => { this.run(ask(id, c.name)); go.blur(); };
    return go;
  }
}

const spoken = (s: string): string => s.replace(/_/g, ' ');

/** About a hundred stops, a round one. */
export function step_of(c: Pick<CommandData, 'min' | 'max'>): number {
  return 10 ** Math.floor(Math.log10((c.max - c.min) / 60));
}

/** "pressure_mmHg" says its unit after the last underscore. */
export function label(value: number, c: Pick<CommandData, 'argument' | 'min' | 'max'>): string {
  const at = c.argument.replace(/_per_([a-z]+)$/, '_/$1').match(/_(\/?[A-Za-z]+)$/);
  const unit = at?.[1] ?? '';
  const digits = Math.max(0, -Math.floor(Math.log10(step_of(c))));
  return `${value.toFixed(digits)}${unit ? ` ${unit}` : ''}`;
}
