// SPDX-License-Identifier: GPL-3.0-or-later
// The built case: pictures, what was measured, problems with what to do, and its exercises to be played.
import { el, setText } from '../hud/dom';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';
import type { Built, Project, StudioApi } from './api';
import type { Asks } from './editor';
import { exerciseText } from './exercise_text';
import { editButton } from './scene_editor/edit_button';
import { forThePage } from './wording';

const waitMs = 300;
const patienceMs = 120_000;

export class ResultPanel {
  readonly root: HTMLElement;
  private readonly stale = el('p', { class: 'mended' }, text('Choices have changed since: build again.'));
  private readonly pictures = el('div', { class: 'pictures' });
  private readonly facts = el('table', {});
  private readonly problems = el('ul', { class: 'problems' });
  private readonly play = el('div', { class: 'buttons' });
  private readonly report = el('a', { target: '_blank', rel: 'noopener' }, text('The full report'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private name = '';
  private readonly edit = editButton(
    () => this.name,
    (words) => setText(this.say, words),
  );
  private shown = '';

  constructor(
    private readonly asks: Asks,
    private readonly api: StudioApi,
  ) {
    this.root = el(
      'section',
      { class: 'result' },
      el('h3', {}, text('5. The result')),
      this.stale,
      this.pictures,
      this.facts,
      this.problems,
      el('p', {}, this.report),
      el('h4', {}, text('Play')),
      el('p', { class: 'hint' }, text('The case is added to this installation, where the start page shows it.')),
      this.play,
      el('div', { class: 'buttons' }, this.edit),
      this.say,
    );
  }

  show(p: Project): void {
    const { built } = p;
    this.root.hidden = !built;
    if (!built) return;
    this.stale.hidden = built.current;
    if (p.play.error !== '') setText(this.say, forThePage(p.play.error));
    const now = JSON.stringify([p.name, { ...built, current: true }]);
    if (now === this.shown) return;
    this.shown = now;
    this.name = p.name;
    this.report.href = this.api.file(p.name, 'report', built.number);
    const picture = (kind: string, alt: string) => el('img', { src: this.api.file(p.name, kind, built.number), alt });
    this.pictures.replaceChildren(
      picture('side', text('The wall’s regions and the plane of the neck, from the side')),
      picture('fissure', text('The vessel in the fissure, from the surgeon’s side')),
    );
    const row = ([what, value]: [string, string]) =>
      el('tr', {}, el('th', { scope: 'row' }, what), el('td', {}, value));
    this.facts.replaceChildren(el('tbody', {}, ...this.measured(built).map(row)));
    this.problems.replaceChildren(
      ...built.problems.map((one) => el('li', {}, el('b', {}, forThePage(one.text)), ' ', forThePage(one.whatToDo))),
    );
    this.play.replaceChildren(...built.exercises.map((file) => this.button(p.name, file)));
  }

  private measured(b: Built): [string, string][] {
    const worst = Math.max(0, ...b.overlapMm.map((o) => o.mm));
    const out: [string, string][] = [[text('Neck'), text('{mm} mm wide', { mm: fixed(b.neckMm, 2) })]];
    if (b.confidence !== null) out.push([text('Agreement on the neck'), `${Math.round(100 * b.confidence)} %`]);
    out.push(
      [text('Overlap with lobes and retractors'), `${fixed(worst, 2)} mm`],
      [
        text('Time of a step'),
        text('{ms} ms of {budget} ms', { ms: fixed(b.stepMs, 1), budget: fixed(b.budgetMs, 1) }),
      ],
      [text('Clip'), b.clip],
      [
        text('Clipped by scripted hands'),
        b.clipping
          ? text('grade {grade}, {remnant} % of the neck left', {
              grade: b.clipping.grade,
              remnant: fixed(b.clipping.remnantPct, 0),
            })
          : text('not played'),
      ],
    );
    return out;
  }

  private button(name: string, file: string): HTMLButtonElement {
    const button = el('button', { type: 'button', 'data-exercise': file }, exerciseText(file));
    button.onclick = () => void this.open(name, file);
    return button;
  }

  /** A window of its own is opened at the click, before the session runs, or the browser would block it. */
  private async open(name: string, exercise: string): Promise<void> {
    const page = window.open('about:blank', 'insula_studio_play');
    setText(this.say, text('The exercise is being started …'));
    let { play } = (await this.asks.act('play', { exercise })) ?? { play: null };
    const end = performance.now() + patienceMs;
    while (play && play.state !== 'running' && play.error === '' && performance.now() < end) {
      await new Promise((r) => setTimeout(r, waitMs));
      play = await this.api.project(name).then(
        (p) => p.play,
        () => play,
      );
    }
    if (!play || !/^https?:\/\//.test(play.url)) {
      page?.close();
      setText(this.say, play?.error ? forThePage(play.error) : text('The exercise did not start.'));
      return;
    }
    setText(this.say, text('The exercise runs in its own window.'));
    if (page) page.location.href = play.url;
  }
}
