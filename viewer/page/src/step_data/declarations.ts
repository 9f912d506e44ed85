// SPDX-License-Identifier: GPL-3.0-or-later
// What scene.json declares of each step's data: channels, drawables and materials (docs/scene-bundle.md). The text
// comes from outside, so every entry is checked here, and an error names the entry.
import { finite, isObject, type Json, word } from '../json_values';

export type Shown = 'vital' | 'curve' | 'none';

/** From, to; null: open on that side. SI. */
export type Range = [number | null, number | null];

export interface ChannelData {
  /** "component.name". */
  id: string;
  component: string;
  name: string;
  doc: string;
  /** SI unit of the numbers in frames; "" or "1": none. */
  unit: string;
  /** 1: a scalar; 3: a vector. */
  size: 1 | 3;
  /** Of its first number among a frame's. */
  offset: number;
  min: number | null;
  max: number | null;
  /** How it is written: number times scale, with so many digits, and this unit. */
  display: { unit: string; scale: number; digits: number };
  shown: Shown;
  /** Channels of one group belong to one thing, such as a branch; "": the component itself. */
  group: string;
  /** What is good (green) and what is high (amber); else red. Null: no colours. */
  bands: { good: Range; high: Range } | null;
}

export const drawableKinds = ['points', 'polylines', 'patch', 'plane', 'label', 'links'] as const;
export type DrawableKind = (typeof drawableKinds)[number];

/** A mesh file pair, as everywhere in the bundle. */
export interface MeshFiles {
  vertices: number;
  triangles: number;
  positions: string;
  indices: string;
  rgba: Rgba | null;
}

export interface DrawableData {
  index: number;
  /** "component.name". */
  id: string;
  component: string;
  name: string;
  doc: string;
  kind: DrawableKind;
  material: string;
  /** Polylines only. */
  pointsPerLine: number;
  /** Planes only: id of the channel with the rate at which fluid comes in; "": none. */
  rateChannel: string;
  /** Elements of the first frame; may change. */
  count: number;
  radiusM: number;
  value: { doc: string; unit: string; min: number | null; max: number | null };
  /** Labels only; "{}" stands for the value. */
  text: string;
  /** Patches only: vertices of the mesh. */
  vertices: number;
  /** Meshes of a patch (one) or of links (one each). */
  meshes: MeshFiles[];
}

export type Rgba = [number, number, number, number];

export interface MaterialData {
  /** A way of drawing; what the page does not know is drawn as "solid". */
  style: string;
  rgba: Rgba;
  roughness: number;
  metalness: number;
  translucency: number;
}

/** Malformed data of the engine: says which entry and why. */
export class DataError extends Error {}

/** Objects of a list; throws where the list or an entry is something else. */
function objects(v: unknown, what: string): Json[] {
  if (v === undefined || v === null) return [];
  if (!Array.isArray(v)) throw new DataError(`scene.json: ${what} is not a list`);
  return v.map((entry, i) => {
    if (!isObject(entry)) throw new DataError(`scene.json: ${what}[${i}] is not an object`);
    return entry;
  });
}

function required(v: unknown, where: string): string {
  if (typeof v !== 'string' || v === '') throw new DataError(`scene.json: ${where} is missing`);
  return v;
}

function count(v: unknown, least: number, where: string): number {
  const n = finite(v);
  if (n === null || !Number.isInteger(n) || n < least)
    throw new DataError(`scene.json: ${where} is ${JSON.stringify(v)}, expected a whole number of at least ${least}`);
  return n;
}

function colour(v: unknown): Rgba | null {
  const ok = Array.isArray(v) && (v.length === 3 || v.length === 4) && v.every((x) => finite(x) !== null);
  return ok ? [v[0], v[1], v[2], v[3] ?? 1] : null;
}

const range = (v: unknown): Range => (Array.isArray(v) ? [finite(v[0]), finite(v[1])] : [null, null]);

function display(v: unknown, unit: string): ChannelData['display'] {
  const d = isObject(v) ? v : {};
  const digits = finite(d.digits);
  return {
    unit: word(d.unit, unit === '1' ? '' : unit),
    scale: finite(d.scale) || 1,
    digits: digits === null ? 2 : Math.max(0, Math.min(9, Math.round(digits))),
  };
}

/** In their order; checks that their numbers follow one another without a gap. */
export function parseChannels(json: unknown): ChannelData[] {
  let next = 0;
  return objects(json, 'channels').map((c, i): ChannelData => {
    const id = required(c.id, `channels[${i}].id`);
    if (c.size !== 1 && c.size !== 3) throw new DataError(`scene.json: channel ${id} has size ${c.size}, not 1 or 3`);
    if (c.offset !== next) throw new DataError(`scene.json: channel ${id} has offset ${c.offset}, expected ${next}`);
    next += c.size;
    const dot = id.indexOf('.');
    const unit = word(c.unit);
    return {
      id,
      component: word(c.component, dot < 0 ? id : id.slice(0, dot)),
      name: word(c.name, id.slice(dot + 1)),
      doc: word(c.doc),
      unit,
      size: c.size,
      offset: c.offset,
      min: finite(c.min),
      max: finite(c.max),
      display: display(c.display, unit),
      shown: c.shown === 'vital' || c.shown === 'curve' ? c.shown : 'none',
      group: word(c.group),
      bands: isObject(c.bands) ? { good: range(c.bands.good), high: range(c.bands.high) } : null,
    };
  });
}

function mesh(m: Json, where: string): MeshFiles {
  return {
    vertices: count(m.vertices, 1, `${where}.vertices`),
    triangles: count(m.triangles, 1, `${where}.triangles`),
    positions: required(m.positions, `${where}.positions`),
    indices: required(m.indices, `${where}.indices`),
    rgba: colour(m.rgba),
  };
}

/** What of a drawable depends on its kind. */
function byKind(d: Json, kind: DrawableKind, where: string): { pointsPerLine: number; meshes: MeshFiles[] } {
  if (kind === 'polylines')
    return { pointsPerLine: count(d.points_per_line ?? 2, 2, `${where}.points_per_line`), meshes: [] };
  if (kind === 'patch') return { pointsPerLine: 1, meshes: [mesh(d, where)] };
  if (kind === 'links')
    return {
      pointsPerLine: 1,
      meshes: objects(d.parts, `${where}.parts`).map((p, k) => mesh(p, `${where}.parts[${k}]`)),
    };
  return { pointsPerLine: 1, meshes: [] };
}

export function parseDrawables(json: unknown): DrawableData[] {
  return objects(json, 'drawables').map((d, i): DrawableData => {
    const where = `drawables[${i}]`;
    const id = required(d.id, `${where}.id`);
    const kind = drawableKinds.find((k) => k === d.kind);
    if (!kind)
      throw new DataError(`scene.json: drawable ${id} has kind "${d.kind}", not one of ${drawableKinds.join(', ')}`);
    const value = isObject(d.value) ? d.value : {};
    const { pointsPerLine, meshes } = byKind(d, kind, where);
    const dot = id.indexOf('.');
    return {
      index: count(d.index ?? i, 0, `${where}.index`),
      id,
      component: word(d.component, dot < 0 ? id : id.slice(0, dot)),
      name: word(d.name, id.slice(dot + 1)),
      doc: word(d.doc),
      kind,
      material: word(d.material),
      pointsPerLine,
      meshes,
      rateChannel: word(d.rate_channel),
      count: Math.max(0, finite(d.count) ?? 0),
      radiusM: Math.max(0, finite(d.radius_m) ?? 0) || 0.0003,
      value: { doc: word(value.doc), unit: word(value.unit), min: finite(value.min), max: finite(value.max) },
      text: word(d.text, '{}'),
      vertices: kind === 'patch' ? meshes[0]!.vertices : 0,
    };
  });
}

const plain: MaterialData = {
  style: 'solid',
  rgba: [0.75, 0.75, 0.78, 1],
  roughness: 0.5,
  metalness: 0,
  translucency: 0,
};

const share = (v: unknown, otherwise: number): number => Math.max(0, Math.min(1, finite(v) ?? otherwise));

export function parseMaterials(json: unknown): Map<string, MaterialData> {
  const out = new Map<string, MaterialData>();
  if (json === undefined || json === null) return out;
  if (!isObject(json)) throw new DataError('scene.json: materials is not an object');
  for (const [name, m] of Object.entries(json)) {
    if (!isObject(m)) throw new DataError(`scene.json: material ${name} is not an object`);
    out.set(name, {
      style: word(m.style, plain.style),
      rgba: colour(m.rgba) ?? plain.rgba,
      roughness: share(m.roughness, plain.roughness),
      metalness: share(m.metalness, plain.metalness),
      translucency: share(m.translucency, plain.translucency),
    });
  }
  return out;
}

/** Of a name that the bundle does not list: a plain solid. */
export const materialOf = (materials: ReadonlyMap<string, MaterialData>, name: string): MaterialData =>
  materials.get(name) ?? plain;
