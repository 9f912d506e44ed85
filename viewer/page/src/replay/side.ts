// SPDX-License-Identifier: GPL-3.0-or-later
// One recording on the page: its field, what the exercise said, and its name. Two stand side by side.
import { el, setText } from '../hud/dom';
import { ExercisePanel } from '../hud/exercise_panel';
import { Vitals } from '../hud/vitals';
import type { QualityName } from '../options';
import { controlMicroscope } from './microscope_control';
import type { RunGhost } from './run_ghost';
import type { RecordedSession } from './session';
import { SessionView } from './session_view';
import { beganText } from '../languages/numbers';
import { text } from '../languages/text';

export class Side {
  readonly root: HTMLElement;
  readonly left: HTMLElement;
  readonly view: SessionView;
  /** Added to the time of the page. */
  shiftS = 0;
  ghost: RunGhost | null = null;
  private readonly exercise = new ExercisePanel();
  private readonly vitals = new Vitals();
  private readonly problem = el('p', { class: 'bad' });

  constructor(
    readonly session: RecordedSession,
    quality: QualityName | null,
  ) {
    const canvas = el('canvas', {
      tabindex: '0',
      'aria-label': text('recorded field of {name}', { name: session.name }),
    });
    const name = el('h1', { class: 'session-name' }, session.name, el('small', {}, beganText(session.began)));
    this.left = el('div', { class: 'column left' }, name, this.vitals.root, this.exercise.root, this.problem);
    this.root = el('div', { class: 'side' }, canvas, this.left);
    this.view = new SessionView(canvas, quality);
    controlMicroscope(this.view.stage);
  }

  async open(): Promise<void> {
    const bundle = await this.view.open(this.session);
    await this.view.drawFirst(0);
    await this.session.readTimeline();
    this.exercise.showScene(bundle);
    this.vitals.showScene(bundle);
    if (this.ghost) this.view.stage.scene.add(this.ghost.root);
  }

  /** The next picture is that of the time that the page is at, s. */
  async seek(pageS: number): Promise<void> {
    const timeS = Math.min(this.session.durationS, Math.max(0, pageS + this.shiftS));
    this.view.show(await this.view.find(timeS));
    const { moment, world } = this.view;
    if (moment && world) this.ghost?.show(world.bundle, moment.before.frame.sim_time_s);
  }

  /** What the exercise said at the picture's time. */
  showPanels(): void {
    const { reading, moment } = this.view;
    const lines = [...(moment ? [] : [text('There is no picture at this time.')]), ...this.session.damage];
    setText(this.problem, lines.join('\n'));
    if (!moment) return;
    const frame = moment.before.frame;
    if (reading.state) {
      this.exercise.showState(reading.state);
      this.exercise.showClock(reading.state.elapsedS ?? frame.sim_time_s);
    }
    this.vitals.show(reading.channels, new Set(), frame.sim_time_s);
  }
}
