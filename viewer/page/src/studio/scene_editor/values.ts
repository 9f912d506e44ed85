// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters as an author writes them: numbers and at most one unit at the end, "54 4 -2 mm". What is wrong
// with one is told while it is typed; `insula check` has the last word.
import { text } from '../../languages/text';
import type { Parameter, Unit } from './declarations';

const number = /^[+-]?(\d+(\.\d*)?|\.\d+)(e[+-]?\d+)?$/i;
const whole = /^[+-]?\d+$/;
const digits = 12;

export interface Parts {
  numbers: string;
  unit: string;
}

/** Its numbers and what follows them; null: a variable stands in it. */
export function partsOf(value: string): Parts | null {
  if (value.includes('$')) return null;
  const words = value.trim().split(/\s+/).filter(Boolean);
  const end = words.findIndex((w) => !number.test(w));
  const at = end < 0 ? words.length : end;
  return { numbers: words.slice(0, at).join(' '), unit: words.slice(at).join(' ') };
}

export const joined = ({ numbers, unit }: Parts): string => [numbers.trim(), unit].filter(Boolean).join(' ');

const unitOf = (p: Parameter, symbol: string): Unit | undefined =>
  p.units.find((u) => u.symbol.replaceAll(' ', '') === symbol.replaceAll(' ', ''));

function inSi(p: Parameter, value: string): number[] | null {
  const parts = partsOf(value);
  if (!parts) return null;
  const factor = p.units.length === 0 ? 1 : unitOf(p, parts.unit)?.toSi;
  return factor === undefined ? null : parts.numbers.split(' ').map((n) => Number(n) * factor);
}

/** Whether it is a point that can be placed with the mouse. */
export const isPoint = (p: Parameter): boolean => p.numbers === 3 && unitOf(p, 'mm') !== undefined;

/** Metres; null: the value does not tell them, as a variable or a wrong text. */
export function pointOf(p: Parameter, value: string): number[] | null {
  const at = faultOf(p, value) === '' ? inSi(p, value) : null;
  return at?.length === 3 ? at : null;
}

/** A point in the unit of the value before, to a hundredth of a millimetre. */
export function pointText(p: Parameter, at: readonly number[], before: string): string {
  const unit = unitOf(p, partsOf(before)?.unit ?? '') ?? unitOf(p, 'mm')!;
  const fine = at.map((x) => Number((Number((1e5 * x).toFixed(0)) / 1e5 / unit.toSi).toPrecision(digits)));
  return joined({ numbers: fine.join(' '), unit: unit.symbol });
}

/** The same values in another unit. */
export function converted(p: Parameter, value: string, symbol: string): string {
  const parts = partsOf(value);
  const [from, to] = [parts && unitOf(p, parts.unit), unitOf(p, symbol)];
  if (!parts || !to) return value;
  if (!from || parts.numbers === '') return joined({ numbers: parts.numbers, unit: symbol });
  const changed = parts.numbers
    .split(' ')
    .map((n) => String(Number(((Number(n) * from.toSi) / to.toSi).toPrecision(digits))));
  return joined({ numbers: changed.join(' '), unit: symbol });
}

export function rangeText({ min, max }: Parameter): string {
  if (min !== '' && max !== '') return text('{min} to {max}', { min, max });
  if (min !== '') return text('at least {min}', { min });
  return max === '' ? '' : text('at most {max}', { max });
}

function numberFault(p: Parameter, { numbers, unit }: Parts): string {
  const words = numbers === '' ? [] : numbers.split(' ');
  const unread = unit.split(' ')[0] ?? '';
  if (/^[+-]?\d+,\d/.test(unread)) return text('The decimal sign is a point, not a comma.');
  if (words.length === 0) return text('A number is needed.');
  if (p.numbers !== null && p.numbers > 0 && words.length !== p.numbers)
    return text('{count, plural, one {# number is needed.} other {# numbers are needed.}}', { count: p.numbers });
  if (p.whole && !words.every((w) => whole.test(w))) return text('A whole number is needed.');
  if (p.units.length === 0) return unit === '' ? '' : text('No unit may stand here.');
  const units = p.units.map((u) => u.symbol).join(', ');
  if (unit === '') return text('A unit is needed: {units}', { units });
  return unitOf(p, unit) ? '' : text('“{unit}” is no unit of it: {units}', { unit, units });
}

/** What is wrong with a value; '': nothing, as far as the declaration tells. */
export function faultOf(p: Parameter, value: string): string {
  if (value.includes('$')) return '';
  if (p.choices.length > 0)
    return p.choices.includes(value) ? '' : text('It must be one of: {choices}', { choices: p.choices.join(', ') });
  if (p.numbers === null) return p.required && value.trim() === '' ? text('A value is needed.') : '';
  const fault = numberFault(p, partsOf(value)!);
  if (fault !== '') return fault;
  const [values, min, max] = [inSi(p, value)!, inSi(p, p.min), inSi(p, p.max)];
  const tolerance = 1 + 1e-12;
  const low = p.min !== '' && min && values.some((v) => v < min[0]! - Math.abs(min[0]!) * (tolerance - 1));
  const high = p.max !== '' && max && values.some((v) => v > max[0]! + Math.abs(max[0]!) * (tolerance - 1));
  return low || high ? text('Outside the allowed range: {range}', { range: rangeText(p) }) : '';
}
