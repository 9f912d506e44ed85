// SPDX-License-Identifier: GPL-3.0-or-later
// The number of a command: its steps, its unit, its text.
import type { CommandData } from '../bundle_types';
import { fixed, quantity } from '../languages/numbers';

/** About a hundred stops, a round one. */
export function stepOf(c: Pick<CommandData, 'min' | 'max'>): number {
  return 10 ** Math.floor(Math.log10((c.max - c.min) / 60));
}

/** "pressure_mmHg" says its unit after the last underscore. */
export function unitOf(c: Pick<CommandData, 'argument'>): string {
  return c.argument.replace(/_per_([a-z]+)$/, '_/$1').match(/_(\/?[A-Za-z]+)$/)?.[1] ?? '';
}

export function label(value: number, c: Pick<CommandData, 'argument' | 'min' | 'max'>): string {
  const digits = Math.max(0, -Math.floor(Math.log10(stepOf(c))));
  return quantity(fixed(value, digits), unitOf(c));
}
