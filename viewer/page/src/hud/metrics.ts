// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine measures of the hands (metrics_t), read with care: it is text from outside.
import { finite, type Json } from '../json_values';
import { list, text } from './state';
import { said } from '../languages/said';

export interface MetricView {
  id: string;
  text: string;
  hand: 'left' | 'right' | 'both';
  /** NaN: not known. */
  value: number;
  unit: string;
  digits: number;
  better: string;
}

export interface Metrics {
  values: MetricView[];
  /** The exercise has ended: they stand still. */
  atEnd: boolean;
}

const sides = ['left', 'right', 'both'] as const;

function metric(m: Json): MetricView {
  return {
    id: text(m.id),
    text: said(text(m.text ?? m.id)),
    hand: sides.find((s) => s === m.hand) ?? 'both',
    value: finite(m.value) ?? NaN,
    unit: text(m.unit),
    digits: Math.min(6, Math.max(0, Math.round(finite(m.digits) ?? 2))),
    better: text(m.better),
  };
}

/** Null: it is no list. */
export function parseMetrics(json: string): MetricView[] | null {
  try {
    const all: unknown = JSON.parse(json);
    return Array.isArray(all) ? list(all).map(metric) : null;
  } catch {
    return null;
  }
}
