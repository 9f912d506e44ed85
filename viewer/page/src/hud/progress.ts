// SPDX-License-Identifier: GPL-3.0-or-later
// Timers that count down, and what is measured of the result.
import { el, setText } from './dom';
import type { MeasureView, TimerView } from './state';
import { timeLeftText, urgency, usedShare } from './timers';
import { fixed, quantity } from '../languages/numbers';
import { text } from '../languages/text';

/** A few digits, no noise: 3.2, 12, 0.05. */
export function valueText(value: number, unit: string): string {
  if (!Number.isFinite(value)) return '–';
  const a = Math.abs(value);
  const digits = unit === '' && Number.isInteger(value) ? 0 : a >= 10 ? 0 : a >= 1 ? 1 : 2;
  return quantity(fixed(value, digits), unit);
}

export class Progress {
  readonly root = el('div', { class: 'progress' });
  readonly clocks = el('div', { class: 'clocks' });
  private readonly timers = new Map<string, { row: HTMLElement; time: HTMLElement; bar: HTMLElement }>();
  private readonly measures = new Map<string, { row: HTMLElement; value: HTMLElement }>();

  clear(): void {
    this.timers.clear();
    this.measures.clear();
    this.root.replaceChildren();
    this.clocks.replaceChildren();
  }

  show(timers: readonly TimerView[], measures: readonly MeasureView[]): void {
    for (const t of timers) {
      let w = this.timers.get(t.id);
      if (!w) {
        const time = el('span', { class: 'time' });
        const bar = el('i');
        w = {
          time,
          bar,
          row: el(
            'div',
            { class: 'timer', 'data-timer': t.id },
            el('span', {}, t.text),
            time,
            el('span', { class: 'line' }, bar),
          ),
        };
        this.timers.set(t.id, w);
        this.clocks.append(w.row);
      }
      setText(w.time, timeLeftText(t));
      w.bar.style.width = `${usedShare(t) * 100}%`;
      w.row.dataset.urgency = urgency(t);
      w.row.classList.toggle('idle', !t.running);
      // A timer that never ran says nothing yet.
      w.row.hidden = !t.running && t.elapsedS === 0;
    }
    for (const m of measures) {
      let w = this.measures.get(m.id);
      if (!w) {
        const value = el('span', { class: 'value' });
        w = { value, row: el('div', { class: 'measure', 'data-measure': m.id }, el('span', {}, m.text), value) };
        this.measures.set(m.id, w);
        this.root.append(w.row);
      }
      setText(w.value, `${m.good > 0 ? '✓ ' : m.good < 0 ? '✗ ' : ''}${valueText(m.value, m.unit)}`);
      w.row.title = m.limit ? text('good is {limit}', { limit: m.limit }) : '';
      w.row.dataset.good = String(m.good);
      w.row.hidden = !Number.isFinite(m.value);
    }
  }
}
