// SPDX-License-Identifier: GPL-3.0-or-later
// The instructor's side: everything the scene's components can be asked for, made from their own declarations;
// messages to the trainee; forces and channels as curves; a log of what happened.
import { spoken } from '../bundle';
import type { Bundle, CommandData } from '../bundle_types';
import type { Channels } from '../step_data/channels';
import { label, stepOf } from './command_number';
import { ask, message, numberArgument, sceneCommands, takesNumber, type UserCommand } from './commands';

import { CausesPanel } from './causes_panel';
import { ChannelCurves } from './channel_curves';
import { TimeChart } from './curves';
import type { HintView } from '../tutor/state';
import { el } from './dom';
import { MetricTable } from './metric_table';
import type { MetricView } from './metrics';
import { clockText } from './state';
import { said } from '../languages/said';
import { text } from '../languages/text';

const logLines = 120;
export class InstructorPanel {
  readonly root = el('section', { class: 'panel instructor' });
  private readonly forces = new TimeChart(text('forces of the hands over ten seconds'), 'N', [
    text('left'),
    text('right'),
  ]);
  private readonly curves = new ChannelCurves();
  private readonly causes = new CausesPanel();
  private readonly metrics = new MetricTable(text('Metrics until now'));
  private readonly commands = el('div', { class: 'commands' });
  /** By component and command, what sets a slider to a value that has been set, by whomever. */
  private readonly sliders = new Map<string, { start: number; set: (value: number) => void }>();
  private readonly log = el('ol', { class: 'log', 'aria-label': text('events') });

  constructor(private readonly run: (c: UserCommand) => void) {
    const words = el('input', {
      type: 'text',
      placeholder: text('Message to the trainee'),
      maxlength: '380',
      'aria-label': text('message to the trainee'),
    });
    const send = el('button', {}, text('Send'));
    const form = el('form', { class: 'ask' }, words, send);
    form.onsubmit = (e) => {
      e.preventDefault();
      const c = message(words.value);
      if (c) this.run(c);
      words.value = '';
    };
    this.root.append(
      // What an emergency needs comes first.
      this.commands,
      el('h2', {}, text('Trainee')),
      form,
      el('h2', {}, text('What is near its limit')),
      this.causes.root,
      el('h2', {}, text('Events')),
      this.log,
      el('h2', {}, text('Forces')),
      this.forces.root,
      this.metrics.root,
      el('h2', {}, text('Channels')),
      this.curves.root,
    );
  }

  showScene(bundle: Bundle): void {
    this.sliders.clear();
    this.curves.showScene(bundle.channels);
    this.commands.replaceChildren(
      ...sceneCommands(bundle).flatMap((g) => [
        el('h2', {}, spoken(g.id)),
        ...g.commands.map((c) => this.makeCommand(g.id, c)),
      ]),
    );
    this.log.replaceChildren();
    this.causes.show([]);
    this.forces.clear();
    this.metrics.clear();
  }

  /** Five times a second. */
  showMetrics(metrics: readonly MetricView[]): void {
    this.metrics.show(metrics);
  }

  showCauses(causes: readonly HintView[]): void {
    this.causes.show(causes);
  }

  /** forces: of the left and the right hand, N. */
  show(channels: Channels, stowed: ReadonlySet<string>, forces: (number | null)[], timeS: number): void {
    this.forces.add(timeS, forces);
    this.forces.draw();
    this.curves.show(channels, stowed, timeS);
  }

  addEvent(timeS: number, kind: string, id: string, what: string): void {
    if (kind === 'command' && id === 'ask') {
      const [component, command, value] = what.split(' ');
      this.sliders.get(`${component} ${command}`)?.set(Number(value));
    }
    if (kind === 'reset') for (const s of this.sliders.values()) s.set(s.start);
    const line = el(
      'li',
      { 'data-kind': kind },
      el('time', {}, clockText(timeS)),
      el('b', {}, spoken(kind)),
      ` ${[spoken(id), kind === 'command' ? what : said(what)].filter((x) => x !== '').join(': ')}`,
    );
    this.log.prepend(line);
    while (this.log.childElementCount > logLines) this.log.lastElementChild!.remove();
  }

  private makeCommand(id: string, c: CommandData): HTMLElement {
    const go = el('button', { title: said(c.doc), 'data-ask': `${id} ${c.name}` }, spoken(c.name));
    if (takesNumber(c)) {
      const start = c.start ?? (c.min + c.max) / 2;
      const slider = el('input', {
        type: 'range',
        min: String(c.min),
        max: String(c.max),
        step: String(stepOf(c)),
        value: String(start),
        'aria-label': `${spoken(c.name)} ${spoken(c.argument)}`,
      });
      const shown = el('output', {}, label(start, c));
      slider.oninput = () => {
        shown.textContent = label(Number(slider.value), c);
      };
      const set = (value: number) => {
        if (!Number.isFinite(value) || slider === document.activeElement) return;
        slider.value = String(value);
        shown.textContent = label(value, c);
      };
      this.sliders.set(`${id} ${c.name}`, { start, set });
      go.onclick = () => {
        this.run(ask(id, c.name, numberArgument(Number(slider.value), c)));
      };
      return el('div', { class: 'ask' }, go, slider, shown);
    }
    if (c.argument !== '') {
      const words = el('input', { type: 'text', placeholder: spoken(c.argument), 'aria-label': spoken(c.argument) });
      go.onclick = () => {
        this.run(ask(id, c.name, words.value));
        words.value = '';
      };
      return el('div', { class: 'ask' }, go, words);
    }
    go.classList.add('wide');
    go.onclick = () => {
      this.run(ask(id, c.name));
    };
    return go;
  }
}
