// SPDX-License-Identifier: GPL-3.0-or-later
// The start and the end of a session: what it shall be (watch, try, be tested), and what was reached.
import type { Bundle } from '../bundle_types';
import type { Role } from '../options';
import type { UserCommand } from './commands';
import { Dialog } from './dialog';
import { el } from './dom';
import type { Metrics } from './metrics';
import { type HudState, isOver } from './state';
import { summaryOf } from './summary';
import { text } from '../languages/text';

/** Names of the modes as a trainee reads them. */
export const modeTitles: Record<string, string> = {
  demonstration: text('Demonstration'),
  practice: text('Practice'),
  test: text('Test'),
};

const choices: { mode: string; text: string; detail: string }[] = [
  {
    mode: 'demonstration',
    text: text('Watch'),
    detail: text('The simulator shows the exercise. Its result is not yours.'),
  },
  {
    mode: 'practice',
    text: text('Try'),
    detail: text('Practise with targets for your hands. The report says practice.'),
  },
  { mode: 'test', text: text('Be tested'), detail: text('No targets and no help. The report says test.') },
];

/** Leads to the start page: other exercises, and how one gets on. */
const allExercises = () => el('a', { href: 'start.html' }, text('All exercises'));

export class SessionPanel {
  private readonly start: Dialog;
  private readonly end: Dialog;
  private readonly question: Dialog;
  readonly roots: HTMLElement[];
  private bundle: Bundle | null = null;
  private shownEnd = '';
  private metrics: Metrics = { values: [], atEnd: false };
  private tried = false;

  constructor(
    private readonly run: (c: UserCommand) => void,
    private readonly role: Role,
    field: () => HTMLElement | null,
  ) {
    this.start = new Dialog('start', field);
    this.end = new Dialog('summary', field);
    this.question = new Dialog('question', field);
    this.roots = [this.start.root, this.end.root, this.question.root];
  }

  /** Whether something waits for an answer; then nothing else should stand over the picture. */
  get open(): boolean {
    return this.start.open || this.end.open;
  }

  showScene(bundle: Bundle): void {
    this.bundle = bundle;
    this.metrics = { values: [], atEnd: false };
    this.shownEnd = '';
    this.start.close();
    this.end.close();
  }

  showMetrics(metrics: Metrics): void {
    this.metrics = metrics;
  }

  /** ready: a picture of the scene is there. */
  show(state: HudState, ready: boolean): void {
    if (state.mode !== 'waiting') this.start.close();
    else if (ready && !this.start.open) this.askStart();
    if (!isOver(state)) {
      this.shownEnd = '';
      this.metrics.atEnd = false;
      this.end.close();
      return;
    }
    // The last metrics and the report's path come a moment after the end.
    const key = `${state.state} ${state.report} ${this.metrics.atEnd}`;
    if (key === this.shownEnd) return;
    const first = this.shownEnd === '';
    this.shownEnd = key;
    if (first || this.end.open) this.showEnd(state);
  }

  /** Asks before what was done is left behind. */
  askReset(): void {
    this.question.show(
      text('Start again?'),
      [
        el(
          'p',
          {},
          text(
            'Both hands go home and the exercise starts again. What was reached until now goes into its own report.',
          ),
        ),
      ],
      [
        { name: 'reset', text: text('Start again'), run: () => this.run({ command: 'reset', argument: '' }) },
        { name: 'stay', text: text('Go on'), run: () => undefined },
      ],
      () => undefined,
    );
  }

  private answers(): { name: string; text: string; detail: string; enabled: boolean; run(): void }[] {
    const motions = this.bundle?.exercise?.motions ?? [];
    return choices.map(({ mode, text: answer, detail }) => ({
      name: mode,
      text: answer,
      detail: mode === 'demonstration' && motions.length === 0 ? text('This scene has no demonstration.') : detail,
      enabled: mode !== 'demonstration' || motions.length > 0,
      run: () => this.begin(mode),
    }));
  }

  private begin(mode: string): void {
    this.tried = mode === 'practice';
    this.run({ command: 'begin', argument: mode });
  }

  private askStart(): void {
    const exercise = this.bundle?.exercise;
    const title = exercise?.title || this.bundle?.title || 'Insula';
    const note = el('p', { class: 'quiet' }, text('For training only. Not for patient care.'));
    if (this.role === 'observer') {
      this.start.show(title, [el('p', {}, text('Waiting until the trainee or the instructor begins.'))], []);
      return;
    }
    // A scene that its author has saved again goes on being tried.
    if (this.tried) return this.begin('practice');
    const recorded = el('a', { href: 'replay.html', target: '_blank', rel: 'noopener' }, text('Recorded sessions'));
    const links = el('p', { class: 'links' }, ...(this.role === 'trainee' ? [allExercises()] : []), recorded);
    this.start.show(title, [el('p', {}, exercise?.text ?? ''), note, links], this.answers());
  }

  private showEnd(state: HudState): void {
    const again = this.role === 'observer' ? [] : this.answers();
    this.end.show(
      state.state === 'done' ? text('Exercise complete') : text('Exercise failed'),
      [...summaryOf(state, this.metrics.values), ...(this.role === 'trainee' ? [allExercises()] : [])],
      [...again, { name: 'close', text: text('Look at the field'), run: () => undefined }],
      () => undefined,
    );
  }
}
