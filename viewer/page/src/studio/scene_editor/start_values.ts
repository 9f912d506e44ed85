// SPDX-License-Identifier: GPL-3.0-or-later
// What a new element begins with: an id if others may name it, and the parameters that it must have, with values that
// their declarations allow.
import type { Declarations, ElementKind, Parameter } from './declarations';
import { attribute, type OutlineElement, withDescendants } from './outline';
import { joined, partsOf } from './values';

/** Whether a parameter that names components of `reference` may name this one. */
const fits = (kind: ElementKind, reference: string): boolean =>
  reference !== '' && (kind.kind === reference || kind.name === reference);

/** Whether other elements may name one of this kind. */
const isNamed = (all: Declarations, kind: ElementKind): boolean =>
  [...all.values()].some((other) => other.parameters.some((p) => fits(kind, p.reference)));

function freshId(kind: ElementKind, taken: ReadonlySet<string>): string {
  let id = kind.name;
  for (let k = 2; taken.has(id); k++) id = `${kind.name}_${k}`;
  return id;
}

/** As many equal numbers as it has, in the first of its units: the least that it allows, else 1, or 0 of several. */
function numbersOf(p: Parameter): string {
  const count = Math.max(1, p.numbers ?? 1);
  const least = partsOf(p.min);
  if (count === 1 && least && Number(least.numbers) > 0) return p.min;
  const numbers = Array.from({ length: count }, () => (count > 1 ? '0' : '1')).join(' ');
  const unit = p.units.find((u) => u.symbol === 'mm') ?? p.units[0];
  return joined({ numbers, unit: unit?.symbol ?? '' });
}

/** The first component of the scene that a parameter may name; '': there is none. */
function namedBy(all: Declarations, p: Parameter, scene: OutlineElement): string {
  for (const e of withDescendants(scene)) {
    const kind = all.get(e.name);
    const id = attribute(e, 'id')?.value;
    if (kind && id && fits(kind, p.reference)) return id;
  }
  return '';
}

/** Meshes of anatomy mostly are in mm. */
export function startValue(all: Declarations, p: Parameter, scene: OutlineElement): string {
  if (p.fallback !== '') return p.fallback;
  if (p.choices.length > 0) return p.choices.includes('mm') ? 'mm' : p.choices[0]!;
  if (p.reference !== '') return namedBy(all, p, scene);
  return p.numbers === null ? '' : numbersOf(p);
}

/** Name and value of each attribute. */
export function startAttributes(all: Declarations, kind: ElementKind, scene: OutlineElement): [string, string][] {
  const ids = withDescendants(scene).map((e) => attribute(e, 'id')?.value ?? '');
  const id: [string, string][] = isNamed(all, kind) ? [['id', freshId(kind, new Set(ids))]] : [];
  const needs = kind.parameters.filter((p) => p.required && p.name !== 'id');
  return [...id, ...needs.map((p): [string, string] => [p.name, startValue(all, p, scene)])];
}
