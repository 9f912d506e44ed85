// SPDX-License-Identifier: GPL-3.0-or-later
// The condition of a gate, as training/progress/curriculum_json.h writes it, checked and in the reader's words.
import { listed } from '../languages/lists';
import { quantity, significant } from '../languages/numbers';
import { said } from '../languages/said';
import { text } from '../languages/text';
import { number, numberOrNull, object, text as words } from './api';

export interface Condition {
  /** 'goals', 'faults' or 'metric'. */
  kind: string;
  mostFaults: number;
  /** Those that count; none: all. */
  faults: string[];
  metric: string;
  hand: string;
  atLeast: number | null;
  atMost: number | null;
  unit: string;
  /** Whose figures the limits are; '': the author's. */
  group: string;
  inARow: number;
  withinDays: number;
}

const dayMs = 86_400_000;

export function conditionOf(json: unknown): Condition {
  const c = object(json);
  return {
    kind: words(c.kind),
    mostFaults: number(c.most_faults),
    faults: Array.isArray(c.fault_texts) ? c.fault_texts.map(words) : [],
    metric: words(c.metric_text),
    hand: words(c.hand),
    atLeast: numberOrNull(c.at_least),
    atMost: numberOrNull(c.at_most),
    unit: words(c.unit),
    group: words(c.group),
    inARow: Math.max(1, number(c.in_a_row)),
    withinDays: number(c.within_ms) / dayMs,
  };
}

const shown = (value: number, unit: string): string => quantity(significant(value, 6), unit);

export function limitsText({ atLeast, atMost, unit }: Pick<Condition, 'atLeast' | 'atMost' | 'unit'>): string {
  const least = atLeast === null ? '' : shown(atLeast, unit);
  const most = atMost === null ? '' : shown(atMost, unit);
  if (atLeast === null) return text('at most {most}', { most });
  return atMost === null ? text('at least {least}', { least }) : text('{least} to {most}', { least, most });
}

function faultsText(c: Condition): string {
  const faults = listed(c.faults.map(said));
  if (c.mostFaults > 0)
    return c.faults.length > 0
      ? text('At most {count} of these faults: {faults}', { count: c.mostFaults, faults })
      : text('{count, plural, one {At most # fault} other {At most # faults}}', { count: c.mostFaults });
  return c.faults.length > 0 ? text('None of these faults: {faults}', { faults }) : text('No faults');
}

/** A metric with its hand, unless it is of both. */
export function metricName(metric: string, hand: string): string {
  if (hand === 'left') return text('{metric}, left hand', { metric });
  return hand === 'right' ? text('{metric}, right hand', { metric }) : metric;
}

function metricText(c: Condition): string {
  const name = metricName(said(c.metric), c.hand);
  const limits = limitsText(c);
  return c.group === ''
    ? text('{name}: {limits}', { name, limits })
    : text('{name}: {limits}, as the group “{group}”', { name, limits, group: c.group });
}

/** What one attempt must show. */
export function conditionText(c: Condition): string {
  if (c.kind === 'faults') return faultsText(c);
  return c.kind === 'metric' ? metricText(c) : text('All goals are reached');
}

/** How often in a row, and within which time; '': once. */
export function rowText({ inARow, withinDays }: Condition): string {
  if (inARow === 1) return '';
  return withinDays > 0
    ? text('{times} times in a row, within {days, plural, one {# day} other {# days}}', {
        times: inARow,
        days: Math.round(withinDays * 10) / 10,
      })
    : text('{times} times in a row', { times: inARow });
}

/** All that a gate asks for. */
export const gateText = (c: Condition): string => listed([conditionText(c), rowText(c)].filter((w) => w !== ''));
