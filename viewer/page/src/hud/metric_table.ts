// SPDX-License-Identifier: GPL-3.0-or-later
// How the hands work, in numbers: a row for each metric, a column for each hand. It opens and closes as a whole.
import { el, setText } from './dom';
import type { MetricView } from './metrics';
import { fixed, quantity, withoutSign } from '../languages/numbers';
import { text } from '../languages/text';

/** A row: what it is, and its values. */
export interface MetricRow {
  id: string;
  text: string;
  /** "less", "more" or '': which is better, in the reader's language. */
  better: string;
  /** Of the left and the right hand, or one of both together. */
  values: string[];
}

export function metricText(m: Pick<MetricView, 'value' | 'digits' | 'unit'>): string {
  if (!Number.isFinite(m.value)) return '–';
  return quantity(withoutSign(fixed(m.value, m.digits)), m.unit);
}

/** Rows in the order of the metrics. What nobody did, and what is not known, has none. */
export function metricRows(metrics: readonly MetricView[]): MetricRow[] {
  const rows = new Map<string, MetricRow>();
  const says = new Set<string>();
  for (const m of metrics) {
    const row = rows.get(m.id) ?? {
      id: m.id,
      text: m.text,
      better: m.better === 'low' ? text('less') : m.better === 'high' ? text('more') : '',
      values: m.hand === 'both' ? [''] : ['–', '–'],
    };
    row.values[m.hand === 'right' ? 1 : 0] = metricText(m);
    if (Number.isFinite(m.value) && m.value !== 0) says.add(m.id);
    rows.set(m.id, row);
  }
  return [...rows.values()].filter((r) => says.has(r.id));
}

export class MetricTable {
  private readonly body = el('tbody');
  readonly root: HTMLDetailsElement;
  private readonly rows = new Map<string, { row: HTMLElement; cells: HTMLElement[] }>();

  constructor(title: string) {
    const head = el(
      'tr',
      {},
      ...['', text('Left'), text('Right'), text('Better')].map((t) => el('th', { scope: 'col' }, t)),
    );
    this.root = el(
      'details',
      { class: 'metrics' },
      el('summary', {}, title),
      el('table', {}, el('thead', {}, head), this.body),
    );
  }

  /** Another scene has other metrics. */
  clear(): void {
    this.rows.clear();
    this.body.replaceChildren();
    this.show([]);
  }

  /** Costs nothing while it is closed. */
  show(metrics: readonly MetricView[]): void {
    this.root.hidden = metrics.length === 0;
    if (this.root.open) this.fill(metrics);
    else this.root.ontoggle = () => this.fill(metrics);
  }

  private fill(metrics: readonly MetricView[]): void {
    for (const { id, text: name, better, values } of metricRows(metrics)) {
      let shown = this.rows.get(id);
      if (!shown) {
        const cells = values.map(() => el('td', values.length === 1 ? { colspan: '2' } : {}));
        const row = el('tr', { 'data-metric': id }, el('th', { scope: 'row' }, name), ...cells, el('td', {}, better));
        shown = { row, cells };
        this.rows.set(id, shown);
        this.body.append(row);
      }
      shown.cells.forEach((cell, k) => setText(cell, values[k] ?? ''));
    }
  }
}
