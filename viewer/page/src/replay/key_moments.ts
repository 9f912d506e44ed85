// SPDX-License-Identifier: GPL-3.0-or-later
// The moments of a recording that are worth a picture: what happened for the first time, the strongest force of each
// hand, where the things to work on were worst, and the end.
import type { Review, Series, Timeline } from './timeline';
import { fixed } from '../languages/numbers';
import { said } from '../languages/said';
import { text } from '../languages/text';

export interface KeyMoment {
  timeS: number;
  text: string;
  bad: boolean;
}

/** What is asked for, said or chosen, and not seen in the field. */
const unseen = new Set([
  'command',
  'refused',
  'mode',
  'message',
  'read',
  'reset',
  'complication',
  'goal_lost',
  'soft_guide',
]);
const mostEvents = 7;

function largest(series: Series): { timeS: number; value: number } | null {
  let best: { timeS: number; value: number } | null = null;
  series.values.forEach((v, k) => {
    if (Number.isFinite(v) && v > (best?.value ?? 0)) best = { timeS: series.timesS[k]!, value: v };
  });
  return best;
}

/** In order of time. */
export function keyMoments(timeline: Timeline, review: Review | null, durationS: number): KeyMoment[] {
  const out: KeyMoment[] = [];
  const seen = new Set<string>();
  for (const e of timeline.events) {
    const key = `${e.kind} ${e.id}`;
    if (unseen.has(e.kind) || seen.has(key) || out.length >= mostEvents) continue;
    seen.add(key);
    out.push({ timeS: e.timeS, text: e.text || said(e.kind.replace(/_/g, ' ')), bad: e.kind === 'fault' });
  }
  timeline.hands.slice(0, 2).forEach((hand, k) => {
    const peak = largest(hand);
    if (!peak) return;
    const force = `${fixed(peak.value, 2)} N`;
    const words =
      k === 0
        ? text('Largest force, left hand: {force}', { force })
        : text('Largest force, right hand: {force}', { force });
    out.push({ timeS: peak.timeS, text: words, bad: false });
  });
  for (const thing of review?.toWorkOn ?? [])
    if (thing.worstS !== null)
      out.push({ timeS: thing.worstS, text: text('To work on: {what}', { what: thing.text }), bad: false });
  out.push({ timeS: durationS, text: text('The end'), bad: false });
  return out.sort((a, b) => a.timeS - b.timeS);
}
