// SPDX-License-Identifier: GPL-3.0-or-later
// A page about a recorded session, to talk about and to print: what was reached, what to work on, pictures of key
// moments, curves of forces and of the distance of the tips, earlier runs, notes, and metrics.
import { el } from '../hud/dom';
import { clockText } from '../hud/state';
import { summaryOf } from '../hud/summary';
import { extremesByPixel } from './chart';
import { keyMoments } from './key_moments';
import type { RecordedSession } from './session';
import type { SessionView } from './session_view';
import type { Note } from './source';
import { type Review, type Series, valueAt } from './timeline';
import { beganText, quantity, significant } from '../languages/numbers';
import { text } from '../languages/text';

const pictureWide = 360;
const pictureHigh = 270;
const curveWide = 720;
const curveHigh = 120;
const colours = ['#1f6fb2', '#c2410c'];

/** The middle of the field at a time, as an image of that width. The view shows that time afterwards. */
async function pictureAt(view: SessionView, timeS: number): Promise<HTMLCanvasElement> {
  const source = view.stage.canvas;
  const picture = el('canvas', { width: String(pictureWide), height: String(pictureHigh) });
  view.show(await view.find(timeS));
  // The context keeps its picture only until the task ends.
  view.draw(performance.now(), 1);
  const wide = Math.min(source.width, (source.height * pictureWide) / pictureHigh);
  const high = (wide * pictureHigh) / pictureWide;
  const from = [(source.width - wide) / 2, (source.height - high) / 2] as const;
  picture.getContext('2d')?.drawImage(source, ...from, wide, high, 0, 0, pictureWide, pictureHigh);
  return picture;
}

function svg(name: string, attributes: Record<string, string>): SVGElement {
  const e = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
  return e;
}

/** scale: from the curve's unit to the shown one. */
function curves(title: string, unit: string, series: readonly Series[], durationS: number, scale = 1): HTMLElement {
  const top = Math.max(1e-9, ...series.flatMap((s) => [...s.values].filter(Number.isFinite))) * scale;
  const y = (v: number) => curveHigh - 14 - ((v * scale) / top) * (curveHigh - 26);
  const chart = svg('svg', { viewBox: `0 0 ${curveWide} ${curveHigh}`, role: 'img', 'aria-label': title });
  chart.append(svg('line', { x1: '0', x2: String(curveWide), y1: String(y(0)), y2: String(y(0)), stroke: '#999' }));
  series.forEach((s, k) => {
    const points = extremesByPixel(s, durationS, curveWide).flatMap((p) => [
      `${p.x},${y(p.low).toFixed(1)}`,
      `${p.x},${y(p.high).toFixed(1)}`,
    ]);
    chart.append(svg('polyline', { points: points.join(' '), fill: 'none', stroke: colours[k] ?? '#000' }));
  });
  const label = svg('text', { x: '2', y: '10', 'font-size': '11' });
  label.textContent = `${significant(top, 2)} ${unit}`;
  const end = svg('text', { x: String(curveWide), y: String(curveHigh - 2), 'font-size': '11', 'text-anchor': 'end' });
  end.textContent = clockText(durationS);
  chart.append(label, end);
  const legend = series.map((s, k) => {
    const name = el('span', {}, s.text);
    name.style.color = colours[k] ?? '#000';
    return name;
  });
  return el('figure', {}, el('figcaption', {}, title, ' ', ...legend), chart);
}

/** What is known and not zero at a time. */
function metricsList(series: readonly Series[], timeS: number): HTMLElement {
  const rows = series
    .map((s) => ({ ...s, value: valueAt(s, timeS) }))
    .filter((s) => Number.isFinite(s.value) && s.value !== 0)
    .map((s) => el('li', {}, el('span', {}, s.text), el('span', {}, quantity(significant(s.value, 3), s.unit))));
  return el('ul', { class: 'figures' }, ...rows);
}

/** What lies farthest beyond the band of a group, with the moment to look at. */
function toWorkOn(review: Review): HTMLElement[] {
  if (review.group === '') return [];
  const { sessions, group } = review;
  const of = text('What lies farthest beyond the middle half of {sessions} sessions of the group {group}.', {
    sessions,
    group,
  });
  const things = review.toWorkOn.map((t) =>
    el(
      'li',
      {},
      el('b', {}, t.text),
      `: ${text('{value}, where the group has {low} to {high}.', { value: t.value, low: t.low, high: t.high })}`,
      t.worstS === null ? '' : ` ${text('Look at {time}, where it became worse most.', { time: clockText(t.worstS) })}`,
    ),
  );
  return [
    el('h2', {}, text('Three things to work on')),
    el('p', {}, of),
    things.length > 0
      ? el('ol', {}, ...things)
      : el('p', {}, text('✓ Every metric lies within its band or on its better side.')),
  ];
}

/** This run beside the person's last and best one. */
function comparison(review: Review): HTMLElement[] {
  if (review.comparison.length === 0) return [];
  const runs = text('{count, plural, one {# earlier run} other {# earlier runs}} of this exercise.', {
    count: review.earlierRuns,
  });
  const row = (kind: 'th' | 'td', ...texts: string[]) => el('tr', {}, ...texts.map((t) => el(kind, {}, t)));
  const signs: Record<string, string> = { '1': ` ✓ ${text('better')}`, '-1': ` ✗ ${text('worse')}` };
  const lines = review.comparison.map((l) =>
    row('td', l.text + (signs[String(l.change)] ?? ''), l.now, l.last, l.best),
  );
  return [
    el('h2', {}, text('Beside your earlier runs')),
    el('p', {}, `${runs} ${text('The best one reached all goals with the fewest faults, soonest.')}`),
    el(
      'table',
      {},
      el('thead', {}, row('th', '', text('This run'), text('Last'), text('Best'))),
      el('tbody', {}, ...lines),
    ),
  ];
}

/** Takes the view to each key moment. */
export async function debrief(
  session: RecordedSession,
  view: SessionView,
  notes: readonly Note[],
): Promise<HTMLElement> {
  const { timeline, durationS } = session;
  const review = timeline.reviews.at(-1) ?? null;
  const strip: HTMLElement[] = [];
  for (const m of keyMoments(timeline, review, durationS)) {
    const picture = await pictureAt(view, m.timeS);
    const caption = el('figcaption', {}, `${m.bad ? '✗ ' : ''}${clockText(m.timeS)}  ${m.text}`);
    strip.push(el('figure', m.bad ? { 'data-bad': 'true' } : {}, picture, caption));
  }
  view.show(await view.find(durationS));
  const state = view.reading.state;
  const print = el('button', {}, text('Print'));
  print.onclick = () => window.print();
  const close = el('button', { 'data-answer': 'close' }, text('Back to the recording'));
  const page = el(
    'article',
    { class: 'debrief' },
    el('nav', {}, print, close),
    el('h1', {}, session.title || session.name),
    el(
      'p',
      {},
      text('Recorded {time}. For training only. No measure of fitness to operate.', { time: beganText(session.began) }),
    ),
    el('section', { class: 'outcome' }, ...(state ? summaryOf({ ...state, recording: '', report: '' }, []) : [])),
    ...(review ? toWorkOn(review) : []),
    el('h2', {}, text('Key moments')),
    el('div', { class: 'strip' }, ...strip),
    el('h2', {}, text('Hands')),
    curves(text('Force on tissue'), 'N', timeline.hands.slice(0, 2), durationS),
    curves(text('Distance of the tips'), 'mm', timeline.hands.slice(2, 3), durationS, 1000),
    ...(review ? comparison(review) : []),
    ...(notes.length > 0
      ? [
          el('h2', {}, text('Notes')),
          el('ul', {}, ...notes.map((n) => el('li', {}, el('b', {}, clockText(n.timeS)), ` ${n.text}`))),
        ]
      : []),
    el('h2', {}, text('Metrics')),
    metricsList(timeline.metrics, durationS),
  );
  close.onclick = () => page.remove();
  return page;
}
