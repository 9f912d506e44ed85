// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the scene bundle (docs/scene-bundle.md): scene.json and its binary files, sizes and indices checked.

import { parse_inventory, type InventoryItem } from './inventory';

export interface SurfaceData {
  id: string;
  material: string;
  positions: Float32Array;
  indices: Uint32Array;
}

export interface SkinnedSurface extends SurfaceData {
  skin_nodes: Uint32Array;
  skin_weights: Float32Array;
  /** Named stretches of a vessel wall, and each vertex's; null on tissue. */
  regions: string[];
  vertex_region: Uint32Array | null;
}

export interface BodyData {
  index: number;
  id: string;
  nodes: number;
  rest: Float32Array;
  surfaces: SkinnedSurface[];
}

export interface ToolPart {
  name: string;
  /** 0: the root; k: turned about hinges[k - 1]. */
  link: number;
  rgba: [number, number, number, number];
  material: string;
  positions: Float32Array;
  indices: Uint32Array;
}

/** Turns its link by multiplier times the tool's opening, in the tool's frame. */
export interface HingeData {
  origin: [number, number, number];
  axis: [number, number, number];
  multiplier: number;
}

/** What the drop-down tells of a clip. */
export interface ClipData {
  kind: string;
  blade_length_m: number | null;
  closing_force_N: number | null;
}

export interface ToolData {
  index: number;
  id: string;
  hand: string;
  kind: string;
  title: string;
  hinges: HingeData[];
  parts: ToolPart[];
  /** Address of its picture, or null. */
  picture: string | null;
  clip: ClipData | null;
}

/** A hand and the tools that lie ready for it, in order. */
export interface HandData {
  hand: 'left' | 'right';
  tools: ToolData[];
}

/** A command that a component obeys; min = max = 0: its argument, if any, is text. */
export interface CommandData {
  name: string;
  doc: string;
  argument: string;
  min: number;
  max: number;
}

export interface CommandGroup {
  id: string;
  element: string;
  commands: CommandData[];
}

export interface ExerciseData {
  id: string;
  title: string;
  text: string;
  goals: { id: string; text: string }[];
  faults: { id: string; text: string }[];
}

export interface ViewData {
  eye: [number, number, number];
  target: [number, number, number];
  up: [number, number, number];
  fov_deg: number;
}

export interface Bundle {
  session: string;
  title: string;
  description: string;
  view: ViewData;
  bodies: BodyData[];
  static: SurfaceData[];
  tools: ToolData[];
  hands: HandData[];
  commands: CommandGroup[];
  strands: { count: number; radius_m: number };
  exercise: ExerciseData | null;
  /** What is in it by name, of a scene that is looked at; null of one that is played. */
  inventory: InventoryItem[] | null;
}

type Json = Record<string, any>;

export async function load_bundle(base: string, session: string): Promise<Bundle> {
  const json = (await (await get(`${base}scene.json`)).json()) as Json;
  if (json.version !== 1 && json.version !== 2) throw new Error(`scene bundle version ${json.version} is not known to this page`);
  const plain = (name: string): string => {
    if (!/^[\w.-]+$/.test(name)) throw new Error(`odd file name in scene.json: ${name}`);
    return name;
  };
  const bytes = async (name: string, count: number): Promise<ArrayBuffer> => {
    const data = await (await get(base + plain(name))).arrayBuffer();
    if (data.byteLength !== count * 4) throw new Error(`${name}: ${data.byteLength} bytes, expected ${count * 4}`);
    return data;
  };
  const floats = async (name: string, n: number) => new Float32Array(await bytes(name, n));
  const uints = async (name: string, n: number, below: number) => {
    const a = new Uint32Array(await bytes(name, n));
    for (const i of a) if (i >= below) throw new Error(`${name}: index ${i} is not below ${below}`);
    return a;
  };
  const surface = async (s: Json): Promise<SurfaceData> => {
    const [positions, indices] = await Promise.all([floats(s.positions, s.vertices * 3), uints(s.indices, s.triangles * 3, s.vertices)]);
    return { id: s.id ?? s.name ?? '', material: s.material ?? 'steel', positions, indices };
  };
  const bodies = await Promise.all(((json.bodies ?? []) as Json[]).map(async (b): Promise<BodyData> => ({
    index: b.index, id: b.id, nodes: b.nodes,
    rest: await floats(b.rest, b.nodes * 3),
    surfaces: await Promise.all(((b.surfaces ?? []) as Json[]).map(async (s): Promise<SkinnedSurface> => ({
      ...(await surface(s)),
      skin_nodes: await uints(s.skin_nodes, s.vertices * 4, b.nodes),
      skin_weights: await floats(s.skin_weights, s.vertices * 4),
      regions: s.regions ?? [],
      vertex_region: s.regions?.length && s.vertex_region ? await uints(s.vertex_region, s.vertices, s.regions.length) : null,
    }))),
  })));
  const tools = await Promise.all(((json.tools ?? []) as Json[]).map(async (t): Promise<ToolData> => ({
    index: t.index, id: t.id, hand: t.hand, kind: t.kind, title: t.title || spoken(t.id),
    hinges: ((t.hinges ?? []) as Json[]).map((h): HingeData => ({ origin: h.origin, axis: h.axis, multiplier: h.multiplier ?? 1 })),
    picture: t.picture ? base + plain(t.picture) : null,
    clip: t.clip ? { kind: t.clip.kind ?? '', blade_length_m: t.clip.blade_length_m ?? null, closing_force_N: t.clip.closing_force_N ?? null } : null,
    parts: await Promise.all(((t.parts ?? []) as Json[]).map(async (p): Promise<ToolPart> => {
      // Sizes of tool parts may be left out of scene.json; then the files say them.
      const positions = p.vertices ? await floats(p.positions, p.vertices * 3) : new Float32Array(await (await get(base + p.positions)).arrayBuffer());
      const indices = p.triangles ? await uints(p.indices, p.triangles * 3, positions.length / 3) : new Uint32Array(await (await get(base + p.indices)).arrayBuffer());
      const link = p.link ?? 0;
      if (link < 0 || link > (t.hinges ?? []).length) throw new Error(`${t.id}: a part hangs on link ${link}, which the tool has not`);
      return { name: p.name ?? '', link, rgba: p.rgba ?? [0.8, 0.8, 0.8, 1], material: p.material ?? 'steel', positions, indices };
    })),
  })));
  return {
    session, title: json.title ?? '', description: json.description ?? '',
    view: json.view, bodies, tools, hands: hands_of(json, tools), commands: commands_of(json),
    static: await Promise.all(((json.static ?? []) as Json[]).map(surface)),
    strands: { count: json.strands?.count ?? 0, radius_m: json.strands?.radius_m ?? 0.00015 },
    exercise: json.exercise ?? null,
    inventory: json.inventory ? parse_inventory(await (await get(base + plain(json.inventory))).json()) : null,
  };
}

/** Version 2 lists the tools of a hand; version 1 named one. */
function hands_of(json: Json, tools: ToolData[]): HandData[] {
  return ((json.hands ?? []) as Json[]).filter((h) => h.hand === 'left' || h.hand === 'right').map((h): HandData => {
    const named: unknown[] = Array.isArray(h.tools) ? h.tools : [h.tool];
    const wanted = named.map((n) => (typeof n === 'object' && n !== null ? (n as Json).index ?? (n as Json).id : n));
    return { hand: h.hand, tools: wanted.map((n) => tools.find((t) => t.index === n || t.id === n)).filter((t) => t !== undefined) };
  });
}

function commands_of(json: Json): CommandGroup[] {
  return ((json.commands ?? []) as Json[]).map((g) => ({
    id: String(g.id), element: String(g.element ?? ''),
    commands: ((g.commands ?? []) as Json[]).map((c) => ({ name: String(c.name), doc: String(c.doc ?? ''), argument: String(c.argument ?? ''), min: Number(c.min ?? 0), max: Number(c.max ?? 0) })),
  }));
}

/** "right_clip_applier" -> "right clip applier". */
export const spoken = (id: string): string => id.replace(/_/g, ' ');

async function get(url: string): Promise<Response> {
  const r = await fetch(url, { cache: 'no-store' });
  if (!r.ok) throw new Error(`${url}: ${r.status} ${r.statusText}`);
  return r;
}
