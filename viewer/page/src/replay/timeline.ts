// SPDX-License-Identifier: GPL-3.0-or-later
// What a recording tells over time: events, forces of the hands, channels and metrics. Times are seconds since the
// recording began.
import { list, text } from '../hud/state';
import { finite, type Json } from '../json_values';
import { sim_event_t } from '../lcm';
import type { Container, TopicMessage } from './container';
import { said } from '../languages/said';
import { text as message } from '../languages/text';

export interface Happening {
  timeS: number;
  kind: string;
  id: string;
  text: string;
  /** Whose tool did it: 0 left, 1 right; -1: nobody's. */
  hand: number;
}

/** A curve: a value at each time, NaN where it is not known. */
export interface Series {
  id: string;
  text: string;
  unit: string;
  timesS: Float64Array;
  values: Float64Array;
}

/** What the engine found of a pass through the exercise, in words (engine/reports/review.h). */
export interface Review {
  /** Number of the pass, from 1. */
  pass: number;
  /** Of the bands; empty: there were none. */
  group: string;
  sessions: number;
  /** worstS: since the recording began; null: not known. */
  toWorkOn: { text: string; value: string; low: string; high: string; worstS: number | null }[];
  earlierRuns: number;
  /** change: since the last run, 1 better, -1 worse. */
  comparison: { text: string; now: string; last: string; best: string; change: number }[];
}

/** Collects the samples of some curves with common times. */
class Samples {
  private readonly timesS: number[] = [];
  private readonly values: number[][] = [];

  add(timeS: number, values: readonly unknown[], size: number): void {
    while (this.values.length < size) this.values.push(new Array<number>(this.timesS.length).fill(NaN));
    this.timesS.push(timeS);
    this.values.forEach((v, k) => v.push(finite(values[k]) ?? NaN));
  }
  series(k: number, about: Pick<Series, 'id' | 'text' | 'unit'>): Series {
    return { ...about, timesS: Float64Array.from(this.timesS), values: Float64Array.from(this.values[k] ?? []) };
  }
}

const handCurves = [
  { id: 'left_force', text: message('Left hand on tissue'), unit: 'N' },
  { id: 'right_force', text: message('Right hand on tissue'), unit: 'N' },
  { id: 'tip_separation', text: message('Distance of the tips'), unit: 'm' },
];

export class Timeline {
  readonly events: Happening[] = [];
  /** Forces of the left and the right hand, distance of the tips. */
  readonly hands: Series[];
  readonly channels: Series[];
  readonly metrics: Series[];
  /** When the exercise began: at the start and after each reset. */
  readonly passesS: number[] = [];
  /** Of passes that have ended, in order. */
  readonly reviews: Review[];

  static async read(container: Container): Promise<Timeline> {
    const topics = ['SIM_EVENT', 'HANDS', 'CHANNELS', 'METRICS', 'REVIEW'];
    const messages: TopicMessage[] = [];
    for await (const m of container.messages(topics)) messages.push(m);
    return new Timeline(container.metadata, messages);
  }

  private constructor(metadata: Container['metadata'], messages: readonly TopicMessage[]) {
    const hands = new Samples();
    const channels = new Samples();
    const metrics = new Map<string, { about: Pick<Series, 'id' | 'text' | 'unit'>; samples: Samples }>();
    const names = [...(metadata.get('channels') ?? new Map<string, string>()).values()];
    const called = metadata.get('metrics') ?? new Map<string, string>();
    const reviews: Json[] = [];
    let pass = 0;
    for (const m of messages) {
      if (m.topic === 'SIM_EVENT') {
        this.addEvent(m.timeS, m.data);
        continue;
      }
      const json = parsed(m.data);
      if (m.topic === 'HANDS' && Array.isArray(json)) hands.add(m.timeS, json.slice(1), handCurves.length);
      else if (m.topic === 'CHANNELS' && Array.isArray(json)) channels.add(m.timeS, json.slice(1), names.length);
      else if (m.topic === 'REVIEW' && json) reviews.push(json as Json);
      else if (m.topic === 'METRICS' && json) {
        const moment = json as Json;
        const number = finite(moment.pass) ?? 0;
        if (number > pass) this.passesS.push(Math.max(0, m.timeS - (finite(moment.time_s) ?? 0)));
        pass = Math.max(pass, number);
        for (const value of list(moment.metrics)) addMetric(metrics, m.timeS, value, called);
      }
    }
    this.hands = handCurves.map((about, k) => hands.series(k, about));
    this.channels = names.map((name, k) => {
      const [id = '', unit = ''] = name.split(' ');
      return channels.series(k, { id, text: id, unit });
    });
    this.metrics = [...metrics.values()].map(({ about, samples }) => samples.series(0, about));
    if (this.passesS.length === 0) this.passesS.push(0);
    this.reviews = reviews.map((r) => this.reviewOf(r));
  }

  private addEvent(timeS: number, data: Uint8Array): void {
    try {
      const e = sim_event_t.decode(data);
      this.events.push({ timeS, kind: e.kind, id: e.id, text: said(e.text), hand: e.hand });
    } catch {
      // A damaged one is left out.
    }
  }

  private reviewOf(message: Json): Review {
    const review = (message.review ?? {}) as Json;
    const pass = finite(message.pass) ?? 1;
    const beginS = this.passesS[pass - 1] ?? 0;
    return {
      pass,
      group: text(review.group),
      sessions: finite(review.sessions) ?? 0,
      toWorkOn: list(review.to_work_on).map((t) => {
        const worstS = finite(t.worst_s);
        const words = { text: said(text(t.text)), value: text(t.value), low: text(t.low), high: text(t.high) };
        return { ...words, worstS: worstS === null ? null : beginS + worstS };
      }),
      earlierRuns: finite(review.earlier_runs) ?? 0,
      comparison: list(review.comparison).map((l) => ({
        ...{ text: said(text(l.text)), now: text(l.now), last: text(l.last), best: text(l.best) },
        change: Math.sign(finite(l.change) ?? 0),
      })),
    };
  }

  /** The next moment after (or before) a time at which a fault was made; null: none. */
  fault(fromS: number, direction: 1 | -1): Happening | null {
    const faults = this.events.filter((e) => e.kind === 'fault');
    const margin = 0.05;
    return direction > 0
      ? (faults.find((e) => e.timeS > fromS + margin) ?? null)
      : (faults.findLast((e) => e.timeS < fromS - margin) ?? null);
  }
}

function withHand(metric: string, hand: string): string {
  if (hand === 'left') return message('{metric}, left hand', { metric });
  return hand === 'right' ? message('{metric}, right hand', { metric }) : metric;
}

function addMetric(
  to: Map<string, { about: Pick<Series, 'id' | 'text' | 'unit'>; samples: Samples }>,
  timeS: number,
  value: Json,
  called: ReadonlyMap<string, string>,
): void {
  const id = `${text(value.id)} ${text(value.hand)}`;
  let found = to.get(id);
  if (!found) {
    const hand = text(value.hand);
    const words = said(called.get(text(value.id)) ?? text(value.id).replace(/[_.]/g, ' '));
    const about = { id, text: withHand(words, hand), unit: text(value.unit) };
    to.set(id, (found = { about, samples: new Samples() }));
  }
  found.samples.add(timeS, [value.value], 1);
}

function parsed(data: Uint8Array): unknown {
  try {
    return JSON.parse(new TextDecoder().decode(data));
  } catch {
    return null;
  }
}

/** The value that a curve has at a time: that of the last sample; NaN before the first. */
export function valueAt(series: Series, timeS: number): number {
  let low = 0;
  let high = series.timesS.length;
  while (low < high) {
    const mid = (low + high) >> 1;
    if (series.timesS[mid]! <= timeS) low = mid + 1;
    else high = mid;
  }
  return low > 0 ? series.values[low - 1]! : NaN;
}
