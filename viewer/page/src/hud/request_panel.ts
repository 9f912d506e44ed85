// SPDX-License-Identifier: GPL-3.0-or-later
// What the surgeon asks the anaesthetist for: a drug with its dose, another ventilation. It is said when each was done.
import { spoken } from '../bundle';
import type { Bundle } from '../bundle_types';
import { said } from '../languages/said';
import { text } from '../languages/text';
import type { SimEvent } from '../lcm';
import { ask, numberArgument, type Request, surgeonRequests, takesNumber, type UserCommand } from './commands';
import { stepOf, unitOf } from './command_number';
import { el, setText } from './dom';
import { clockText } from './state';

export class RequestPanel {
  readonly root = el('details', { class: 'requests' });
  private readonly rows = el('div', { class: 'rows' });
  /** By component and command: when it was done. */
  private readonly done = new Map<string, HTMLElement>();

  constructor(private readonly run: (c: UserCommand) => void) {
    this.root.append(el('summary', {}, text('Ask the anaesthetist')), this.rows);
    this.root.hidden = true;
  }

  showScene(bundle: Bundle): void {
    this.done.clear();
    const all = bundle.inventory ? [] : surgeonRequests(bundle);
    this.rows.replaceChildren(...all.map((r) => this.makeRow(r)));
    this.root.hidden = all.length === 0;
  }

  addEvent(e: SimEvent): void {
    if (e.kind === 'reset') for (const place of this.done.values()) setText(place, '');
    if (e.kind !== 'command' || e.id !== 'ask') return;
    const place = this.done.get(e.text.split(' ', 2).join(' '));
    if (place) setText(place, text('done at {time}', { time: clockText(e.sim_time_s) }));
  }

  private makeRow({ id, command, usual }: Request): HTMLElement {
    const { name } = command;
    const go = el('button', { type: 'button', title: said(command.doc), 'data-ask': `${id} ${name}` }, spoken(name));
    const done = el('small', { role: 'status' });
    this.done.set(`${id} ${name}`, done);
    if (!takesNumber(command)) {
      go.onclick = () => this.run(ask(id, name));
      return el('div', { class: 'request' }, go, done);
    }
    const number = el('input', {
      type: 'number',
      min: String(command.min),
      max: String(command.max),
      step: String(stepOf(command)),
      value: String(usual),
      'aria-label': `${spoken(name)} ${spoken(command.argument)}`,
    });
    go.onclick = () => this.run(ask(id, name, numberArgument(number.valueAsNumber, command)));
    return el('div', { class: 'request' }, go, el('label', {}, number, ' ', unitOf(command)), done);
  }
}
