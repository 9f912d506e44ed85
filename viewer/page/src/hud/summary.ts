// SPDX-License-Identifier: GPL-3.0-or-later
// What a trainee reads at the end: goals reached, each fault with its times and what to do, measures beside their
// limits, clocks, and where the report is. Good and bad have a sign and a word beside their colour.
import { el } from './dom';
import { hintList } from './hint_list';
import { MetricTable } from './metric_table';
import type { MetricView } from './metrics';
import { valueText } from './progress';
import type { FaultView, HudState, MeasureView, TimerView } from './state';
import { clockText } from './state';
import { listed } from '../languages/lists';
import { text } from '../languages/text';

const yes = '✓';
const no = '✗';

/** "0:12.3, 0:40.1 and 3 more". */
export function timesText(fault: Pick<FaultView, 'count' | 'timesS'>): string {
  const times = fault.timesS.map(clockText);
  const more = fault.count - times.length;
  return more > 0 && times.length > 0 ? listed([...times, text('{more} more', { more })]) : listed(times);
}

export function verdict(m: Pick<MeasureView, 'good'>): string {
  return m.good > 0 ? `${yes} ${text('good')}` : m.good < 0 ? `${no} ${text('not good')}` : '';
}

const part = (title: string, rows: HTMLElement[]): HTMLElement[] =>
  rows.length > 0 ? [el('h3', {}, title), el('ul', { class: 'summary-list' }, ...rows)] : [];

function whose(mode: string): HTMLElement[] {
  const texts: Record<string, string> = {
    demonstration: text('This was a demonstration. Its result is not yours.'),
    practice: text('This was practice, with targets.'),
    test: text('This was a test, without help.'),
  };
  return texts[mode] ? [el('p', { class: 'whose', 'data-mode': mode }, texts[mode])] : [];
}

const ofLimit = (t: Pick<TimerView, 'elapsedS' | 'limitS'>): string =>
  text('{time} of {limit}', { time: clockText(t.elapsedS), limit: clockText(t.limitS) });

function timesMade(count: number, times: string): string {
  if (times === '') return text('{count, plural, one {# time} other {# times}}', { count });
  return text('{count, plural, one {# time} other {# times}}, at {times}', { count, times });
}

function faultRow(f: FaultView): HTMLElement {
  const times = timesText(f);
  return el(
    'li',
    { 'data-good': '-1' },
    el('b', {}, `${no} ${f.text}`),
    el('span', {}, ` ${timesMade(f.count, times)}`),
    ...(f.advice ? [el('p', { class: 'advice' }, f.advice)] : []),
  );
}

function measureRow(m: MeasureView): HTMLElement {
  const limit = m.limit ? `; ${text('good is {limit}', { limit: m.limit })}` : '';
  return el(
    'li',
    { 'data-good': String(m.good) },
    el('b', {}, m.text),
    el('span', {}, ` ${valueText(m.value, m.unit)}${limit} `),
    el('em', {}, verdict(m)),
  );
}

function hands(metrics: readonly MetricView[]): HTMLElement {
  const table = new MetricTable(text('How your hands worked'));
  table.show(metrics);
  return table.root;
}

/** Links to the page of recorded sessions, which opens beside this one. */
function again(recording: string): HTMLElement[] {
  const name = recording.replace(/^.*[\\/]/, '').replace(/\.insula$/, '');
  const session = `replay.html?session=${encodeURIComponent(name)}`;
  const link = (href: string, words: string) => el('a', { href, target: '_blank', rel: 'noopener' }, words);
  return [
    link(`${session}&debrief`, text('Debrief to read and print')),
    link(session, text('Watch this session again')),
  ];
}

export function summaryOf(s: HudState, metrics: readonly MetricView[]): HTMLElement[] {
  const made = s.faults.filter((f) => f.count > 0);
  const clocks = s.timers.filter((t) => t.elapsedS > 0 && t.limitS > 0);
  return [
    ...whose(s.mode),
    ...(s.message && s.state === 'failed' ? [el('p', { class: 'bad' }, s.message)] : []),
    el('p', {}, s.elapsedS === null ? '' : text('Time: {time}', { time: clockText(s.elapsedS) })),
    ...part(
      text('Goals'),
      s.goals.map((g) =>
        el(
          'li',
          { 'data-good': g.done ? '1' : '-1' },
          `${g.done ? `${yes} ${text('reached')}` : `${no} ${text('not reached')}`}: ${g.text}`,
        ),
      ),
    ),
    ...part(
      text('Faults'),
      made.length > 0 ? made.map(faultRow) : [el('li', { 'data-good': '1' }, `${yes} ${text('none')}`)],
    ),
    ...hintList(s.tutor.cues, s.mode !== 'test'),
    ...part(text('Measures'), s.measures.filter((m) => Number.isFinite(m.value)).map(measureRow)),
    ...part(
      text('Clocks'),
      clocks.map((t) =>
        el(
          'li',
          { 'data-good': t.elapsedS <= t.limitS ? '1' : '-1' },
          `${t.elapsedS <= t.limitS ? yes : no} ${t.text}: ${ofLimit(t)}`,
        ),
      ),
    ),
    ...(metrics.length > 0 ? [hands(metrics)] : []),
    ...(s.recording ? again(s.recording).map((link) => el('p', {}, link)) : []),
    ...(s.report ? [el('p', { class: 'where' }, text('Report:'), ' ', el('code', {}, s.report))] : []),
  ];
}
