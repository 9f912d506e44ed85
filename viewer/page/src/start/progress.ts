// SPDX-License-Identifier: GPL-3.0-or-later
// How somebody gets on in one exercise: a learning curve for each metric, those that changed most first.
import { el } from '../hud/dom';
import type { Api, Curve, Exercise } from './api';
import { curvePicture } from './curve';
import { fixed, quantity } from '../languages/numbers';
import { text } from '../languages/text';
import { metricName } from './gate_words';
import { learningBox } from './learning';

/** Curves worth a look: known direction, and values that differ. Largest change between first and last third first. */
export function ranked(curves: readonly Curve[]): Curve[] {
  const change = (c: Curve): number => {
    const values = c.points.map((p) => p.value);
    const part = Math.max(1, Math.floor(values.length / 3));
    const mean = (v: number[]) => v.reduce((a, b) => a + b, 0) / v.length;
    const range = Math.max(...values) - Math.min(...values);
    return range > 0 ? Math.abs(mean(values.slice(-part)) - mean(values.slice(0, part))) / range : -1;
  };
  return curves
    .filter((c) => c.better !== 'none' && c.points.length > 0)
    .map((c) => ({ c, by: change(c) }))
    .sort((a, b) => b.by - a.by)
    .map((r) => r.c);
}

const number = (c: Curve, value: number): string => quantity(fixed(value, c.digits), c.unit);

function curveBox(c: Curve): HTMLElement {
  const values = c.points.map((p) => p.value);
  const best = c.better === 'high' ? Math.max(...values) : Math.min(...values);
  const last = values[values.length - 1]!;
  const name = metricName(c.text, c.hand);
  const numbers = { last: number(c, last), best: number(c, best) };
  return el(
    'li',
    { class: 'curve' },
    el('h3', {}, name),
    curvePicture(
      c,
      text('{name}: {count, plural, one {# attempt} other {# attempts}}, last {last}, best {best}', {
        name,
        count: values.length,
        ...numbers,
      }),
    ),
    el(
      'p',
      {},
      c.better === 'high'
        ? text('last {last}, best {best}, more is better', numbers)
        : text('last {last}, best {best}, less is better', numbers),
    ),
    ...learningBox(c, name),
  );
}

export class Progress {
  readonly root = el('dialog', { class: 'progress', 'aria-labelledby': 'progress-title' });

  constructor(private readonly api: Api) {}

  async open(exercise: Exercise, person: string): Promise<void> {
    const curves = ranked(await this.api.curves(person, exercise.scene));
    const close = el('button', { type: 'button' }, text('Close'));
    close.onclick = () => this.root.close();
    const attempts = curves[0]?.points.length ?? 0;
    this.root.replaceChildren(
      el('h2', { id: 'progress-title' }, `${exercise.title}: ${person === '' ? text('guests') : person}`),
      el(
        'p',
        { class: 'hint' },
        text('{count, plural, one {# attempt} other {# attempts}}, from left to right.', { count: attempts }),
        ' ',
        text('A line shows the median of the last five. Full dots are tests, rings are practice.'),
      ),
      el('ul', { class: 'curves' }, ...curves.map(curveBox)),
      close,
    );
    this.root.showModal();
  }
}
