// SPDX-License-Identifier: GPL-3.0-or-later
// What elements there are in scenes, with their parameters and children, as the engine declares them
// (engine/authoring/declarations_json.h).
import { list, number, text } from '../../start/api';

export interface Unit {
  symbol: string;
  toSi: number;
}

export interface Parameter {
  name: string;
  /** In words: "three numbers (length)". */
  type: string;
  doc: string;
  required: boolean;
  /** As written in a scene; '': none. */
  fallback: string;
  min: string;
  max: string;
  choices: string[];
  units: Unit[];
  /** How many numbers a value has; 0: as many as one likes; null: it is no number. */
  numbers: number | null;
  whole: boolean;
  /** Kind of component that it names; '': none. */
  reference: string;
}

export interface ElementKind {
  name: string;
  kind: string;
  doc: string;
  children: string[];
  parameters: Parameter[];
}

export type Declarations = ReadonlyMap<string, ElementKind>;

const texts = (value: unknown): string[] => (Array.isArray(value) ? value.map(text) : []);

function parameterOf(p: Record<string, unknown>): Parameter {
  return {
    name: text(p.name),
    type: text(p.type),
    doc: text(p.doc),
    required: p.required === true,
    fallback: text(p.default),
    min: text(p.min),
    max: text(p.max),
    choices: texts(p.choices),
    units: list(p.units).map((u) => ({ symbol: text(u.symbol), toSi: number(u.to_si) })),
    numbers: typeof p.numbers === 'number' ? p.numbers : null,
    whole: p.whole === true,
    reference: text(p.reference),
  };
}

export function declarationsOf(elements: unknown): Declarations {
  const all = list(elements).map((e) => ({
    name: text(e.name),
    kind: text(e.kind),
    doc: text(e.doc),
    children: texts(e.children),
    parameters: list(e.parameters).map(parameterOf),
  }));
  return new Map(all.filter((e) => e.name !== '').map((e) => [e.name, e]));
}
