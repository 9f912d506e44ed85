// SPDX-License-Identifier: GPL-3.0-or-later
// The controls under the field: play, speed, jumps, the timeline and what it shows.
import { el, setText } from '../hud/dom';
import { clockText } from '../hud/state';
import { TimelineChart } from './chart';
import { type ReplayClock, speeds } from './clock';
import type { Series, Timeline } from './timeline';
import { significant } from '../languages/numbers';
import { text } from '../languages/text';

export interface TransportActions {
  /** The time was moved by hand. */
  moved(): void;
  arrows(on: boolean): void;
  note(): void;
  video(): void;
  debrief(): void;
  /** Shows or hides the list of moments. */
  moments(): void;
}

export class Transport {
  readonly root: HTMLElement;
  readonly chart: TimelineChart;
  private readonly play = el('button', { class: 'play', title: text('Space') }, text('Play'));
  private readonly time = el('span', { class: 'clock' });
  private readonly speed = el('select', { title: text('speed'), 'aria-label': text('speed') });
  private readonly curve = el('select', { title: text('second curve'), 'aria-label': text('second curve') });
  private readonly video = el('button', { title: text('WebM of the chosen stretch') }, text('Video'));
  private readonly stretch = el('span', { class: 'stretch' });

  constructor(
    private readonly clock: ReplayClock,
    private readonly timeline: Timeline,
    private readonly actions: TransportActions,
  ) {
    this.chart = new TimelineChart(clock, () => actions.moved());
    for (const s of speeds) this.speed.append(el('option', { value: String(s) }, `${significant(s, 3)}×`));
    this.play.onclick = () => clock.toggle();
    this.speed.onchange = () => (clock.speed = Number(this.speed.value));
    this.fillCurves();
    this.root = el(
      'section',
      { class: 'panel transport' },
      el('div', { class: 'row' }, ...this.makeButtons()),
      this.chart.root,
    );
  }

  /** Once a picture. */
  draw(recording: boolean): void {
    const { clock } = this;
    setText(this.play, clock.playing ? text('Pause') : text('Play'));
    setText(this.time, `${clockText(clock.timeS)} / ${clockText(clock.durationS)}`);
    if (Number(this.speed.value) !== clock.speed) this.speed.value = String(clock.speed);
    setText(this.video, recording ? text('Recording …') : text('Video'));
    this.video.disabled = recording;
    const s = clock.stretch;
    setText(
      this.stretch,
      s ? text('{from} to {to}', { from: clockText(s.fromS), to: clockText(s.toS) }) : text('whole recording'),
    );
    this.chart.draw();
  }

  jumpToFault(direction: 1 | -1): void {
    const found = this.timeline.fault(this.clock.timeS, direction);
    if (!found) return;
    this.clock.seek(found.timeS);
    this.actions.moved();
  }

  private makeButtons(): HTMLElement[] {
    const button = (words: string, title: string, run: () => void) => {
      const b = el('button', { title }, words);
      b.onclick = run;
      return b;
    };
    const arrows = el('input', { type: 'checkbox' });
    arrows.onchange = () => this.actions.arrows(arrows.checked);
    this.video.onclick = () => this.actions.video();
    const mark = (which: 'from' | 'to') => () => this.clock.mark(which);
    return [
      this.play,
      this.time,
      this.speed,
      button(text('◂ Fault'), 'B', () => this.jumpToFault(-1)),
      button(text('Fault ▸'), 'F', () => this.jumpToFault(1)),
      el('span', { class: 'gap' }),
      el('label', {}, arrows, text('Forces')),
      this.curve,
      button(text('Moments'), 'M', () => this.actions.moments()),
      button(text('Note'), 'N', () => this.actions.note()),
      button(text('From here'), '[', mark('from')),
      button(text('To here'), ']', mark('to')),
      this.stretch,
      this.video,
      button(text('Debrief'), text('a page to talk about and to print'), () => this.actions.debrief()),
    ];
  }

  private fillCurves(): void {
    const { hands, metrics, channels } = this.timeline;
    const separation = hands[2]!;
    const groups: [string, readonly Series[]][] = [
      [text('Hands'), [separation]],
      [text('Metrics'), metrics],
      [text('Channels'), channels],
    ];
    const all = groups.flatMap(([, series]) => series);
    let n = 0;
    for (const [label, series] of groups) {
      const group = el('optgroup', { label });
      for (const s of series) group.append(el('option', { value: String(n++) }, s.text));
      if (series.length > 0) this.curve.append(group);
    }
    const show = () => this.chart.show(hands.slice(0, 2), all[Number(this.curve.value)] ?? null);
    this.curve.onchange = show;
    show();
  }
}
