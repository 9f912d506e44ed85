// SPDX-License-Identifier: GPL-3.0-or-later
// What is to be done, what presses most first: clocks, goals, faults, measures, and the text last.
import type { Bundle } from '../bundle_types';
import { el, setText } from './dom';
import { Progress } from './progress';
import { modeTitles } from './session_panel';
import { clockText, type HudState } from './state';
import { said } from '../languages/said';
import { text } from '../languages/text';

export class ExercisePanel {
  readonly root: HTMLElement;
  private readonly title = el('h1', {}, 'Insula');
  private readonly clock = el('span', { class: 'clock' }, '0:00.0');
  private readonly mode = el('span', { class: 'mode' });
  private readonly recording = el('span', { class: 'recording' });
  private readonly text = el('p', { class: 'text' });
  private readonly goals = el('ul', { class: 'goals' });
  private readonly faults = el('ul', { class: 'faults' });
  private readonly progress = new Progress();
  private shown = '';

  constructor() {
    const head = el('header', {}, this.title, this.clock);
    this.root = el(
      'section',
      { class: 'panel exercise' },
      head,
      this.mode,
      this.recording,
      this.progress.clocks,
      this.goals,
      this.faults,
      this.progress.root,
      this.text,
    );
  }

  showScene({ exercise, title, description }: Bundle): void {
    setText(this.title, exercise?.title || title || 'Insula');
    setText(this.text, exercise?.text || description);
    this.progress.clear();
    const goals = (exercise?.goals ?? []).map((g) => ({ ...g, done: false }));
    this.showLists(goals, []);
  }

  showClock(seconds: number): void {
    setText(this.clock, clockText(seconds));
  }

  showState(s: HudState): void {
    setText(this.mode, modeTitles[s.mode] ?? '');
    this.mode.hidden = !modeTitles[s.mode];
    this.mode.dataset.mode = s.mode;
    this.showRecording(s);
    this.showLists(s.goals, s.faults);
    this.progress.show(s.timers, s.measures);
  }

  private showRecording({ recording, unrecorded }: HudState): void {
    setText(
      this.recording,
      unrecorded ? text('Not recorded: {why}', { why: said(unrecorded) }) : recording ? text('● Recorded') : '',
    );
    this.recording.title = recording;
    this.recording.hidden = !recording && !unrecorded;
    this.recording.classList.toggle('bad', unrecorded !== '');
  }

  private showLists(goals: HudState['goals'], faults: HudState['faults']): void {
    // The clock changes the state with every frame; the lists seldom.
    const key = JSON.stringify([goals, faults]);
    if (key === this.shown) return;
    this.shown = key;
    this.goals.replaceChildren(...goals.map((g) => el('li', { class: g.done ? 'done' : '' }, g.text)));
    const made = faults.filter((f) => f.count > 0);
    this.faults.replaceChildren(...made.map((f) => el('li', {}, el('b', {}, `✗ ${f.count}`), ` ${f.text}`)));
  }
}
