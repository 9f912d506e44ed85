// SPDX-License-Identifier: GPL-3.0-or-later
// What a learning curve says against a level: when it was reached, and the cumulative sum of failures (CUSUM).
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Curve, Learning } from './api';
import { addSvg, picture, places } from './curve';
import { limitsText } from './gate_words';

export function levelText(c: Curve, { atLeast, atMost, source }: Learning): string {
  const values = limitsText({ atLeast, atMost, unit: c.unit });
  return source === 'curriculum'
    ? text('Level of the curriculum: {values}', { values })
    : text('Level of the specialists on this machine: {values}', { values });
}

export function reachedText({ inARow, attemptsToLevel }: Learning): string {
  if (attemptsToLevel === null)
    return inARow > 1
      ? text('Not reached yet: it takes {inARow} attempts in a row.', { inARow })
      : text('Not reached yet.');
  return inARow > 1
    ? text('Reached {inARow} times in a row after {attempts} attempts.', { inARow, attempts: attemptsToLevel })
    : text('Reached after {attempts, plural, one {# attempt} other {# attempts}}.', { attempts: attemptsToLevel });
}

/** What the sum says now. A later crossing counts more than an earlier one of the other line. */
export function cusumText({ cusum }: Learning): string {
  const { sum, accepted, alarmed, h0, h1 } = cusum;
  const now = sum[sum.length - 1] ?? 0;
  if (accepted !== null && now <= -h0) return text('Failures are now as rare as they should be.');
  if (alarmed !== null && now >= h1) return text('Failures are still too frequent. Practise this, or ask for help.');
  return text('Too few attempts to tell yet.');
}

/** The sum from its beginning at zero, with the two lines that decide. */
export function cusumPicture({ cusum }: Learning, label: string): SVGSVGElement {
  const root = picture(label, 'cusum');
  root.setAttribute('preserveAspectRatio', 'none');
  const values = [0, ...cusum.sum];
  const at = places(values);
  const y = places([...values, -cusum.h0, cusum.h1]).map((p) => p.y);
  const line = (name: string, height: number) =>
    addSvg(root, 'line', { class: name, x1: '0', x2: '300', y1: height.toFixed(1), y2: height.toFixed(1) });
  line('accept', y[values.length]!);
  line('alarm', y[values.length + 1]!);
  const d = values.map((_, i) => `${i === 0 ? 'M' : 'L'}${at[i]!.x.toFixed(1)} ${y[i]!.toFixed(1)}`).join('');
  addSvg(root, 'path', { class: 'sum', d });
  return root;
}

/** Nothing if no level is known. */
export function learningBox(c: Curve, name: string): Element[] {
  const learning = c.learning;
  if (!learning) return [];
  return [
    el('p', { class: 'level' }, `${levelText(c, learning)}. ${reachedText(learning)}`),
    cusumPicture(learning, text('Failures of {name}, as a cumulative sum', { name })),
    el(
      'p',
      {},
      `${text('The sum falls with each success and rises with each failure.')} `,
      `${text('Below the dashed line it is good, above the solid one it is not.')} `,
      el('strong', {}, cusumText(learning)),
    ),
  ];
}
