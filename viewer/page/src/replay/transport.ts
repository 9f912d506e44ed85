// SPDX-License-Identifier: GPL-3.0-or-later
// The controls under the field: play, speed, jumps, the timeline and what it shows.
import { el, setText } from '../hud/dom';
import { clockText } from '../hud/state';
import { TimelineChart } from './chart';
import { type ReplayClock, speeds } from './clock';
import type { Series, Timeline } from './timeline';

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
  private readonly play = el('button', { class: 'play', title: 'Space' }, 'Play');
  private readonly time = el('span', { class: 'clock' });
  private readonly speed = el('select', { title: 'speed', 'aria-label': 'speed' });
  private readonly curve = el('select', { title: 'second curve', 'aria-label': 'second curve' });
  private readonly video = el('button', { title: 'WebM of the chosen stretch' }, 'Video');
  private readonly stretch = el('span', { class: 'stretch' });

  constructor(
    private readonly clock: ReplayClock,
    private readonly timeline: Timeline,
    private readonly actions: TransportActions,
  ) {
    this.chart = new TimelineChart(clock, () => actions.moved());
    for (const s of speeds) this.speed.append(el('option', { value: String(s) }, `${s}×`));
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
    setText(this.play, clock.playing ? 'Pause' : 'Play');
    setText(this.time, `${clockText(clock.timeS)} / ${clockText(clock.durationS)}`);
    if (Number(this.speed.value) !== clock.speed) this.speed.value = String(clock.speed);
    setText(this.video, recording ? 'Recording …' : 'Video');
    this.video.disabled = recording;
    const s = clock.stretch;
    setText(this.stretch, s ? `${clockText(s.fromS)} to ${clockText(s.toS)}` : 'whole recording');
    this.chart.draw();
  }

  jumpToFault(direction: 1 | -1): void {
    const found = this.timeline.fault(this.clock.timeS, direction);
    if (!found) return;
    this.clock.seek(found.timeS);
    this.actions.moved();
  }

  private makeButtons(): HTMLElement[] {
    const button = (text: string, title: string, run: () => void) => {
      const b = el('button', { title }, text);
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
      button('◂ Fault', 'B', () => this.jumpToFault(-1)),
      button('Fault ▸', 'F', () => this.jumpToFault(1)),
      el('span', { class: 'gap' }),
      el('label', {}, arrows, 'Forces'),
      this.curve,
      button('Moments', 'M', () => this.actions.moments()),
      button('Note', 'N', () => this.actions.note()),
      button('From here', '[', mark('from')),
      button('To here', ']', mark('to')),
      this.stretch,
      this.video,
      button('Debrief', 'a page to talk about and to print', () => this.actions.debrief()),
    ];
  }

  private fillCurves(): void {
    const { hands, metrics, channels } = this.timeline;
    const separation = hands[2]!;
    const groups: [string, readonly Series[]][] = [
      ['Hands', [separation]],
      ['Metrics', metrics],
      ['Channels', channels],
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
