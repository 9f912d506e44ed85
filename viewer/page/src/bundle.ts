// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the scene bundle (docs/scene-bundle.md): scene.json and its binary files, sizes and indices checked.
import type * as types from './bundle_types';
import { parseContactSides } from './contact_sides';
import { parseInventory } from './inventory';
import { parseChannels, parseDrawables, parseMaterials } from './step_data/declarations';
import { said } from './languages/said';
import { text } from './languages/text';

// The parts of scene.json that the engine alone writes: a wrong one fails where its file is read.
// eslint-disable-next-line @typescript-eslint/no-explicit-any
type Json = Record<string, any>;

const list = (v: unknown): Json[] => (Array.isArray(v) ? (v as Json[]) : []);

/** Where the files of a bundle come from. */
export interface BundleSource {
  /** Under which the browser finds a file, for pictures. */
  address(name: string): Promise<string>;
  read(name: string): Promise<ArrayBuffer>;
}

/** Files of a folder on the server. */
export class BundleFolder implements BundleSource {
  constructor(private readonly base: string) {}

  address(name: string): Promise<string> {
    return Promise.resolve(this.base + name);
  }

  async read(name: string): Promise<ArrayBuffer> {
    return (await get(this.base + name)).arrayBuffer();
  }
}

/** Files of one bundle. */
class Files {
  constructor(private readonly source: BundleSource) {}

  address(name: string): Promise<string> {
    return this.source.address(checked(name));
  }

  async json(name: string): Promise<Json> {
    return JSON.parse(new TextDecoder().decode(await this.source.read(checked(name)))) as Json;
  }

  async floats(name: string, n: number): Promise<Float32Array> {
    return new Float32Array(await this.bytes(name, n));
  }

  /** Every number is checked to be below `below`. */
  async uints(name: string, n: number, below: number): Promise<Uint32Array> {
    const a = new Uint32Array(await this.bytes(name, n));
    for (const i of a) if (i >= below) throw new Error(`${name}: index ${i} is not below ${below}`);
    return a;
  }

  async mesh(m: { vertices: number; triangles: number; positions: string; indices: string }): Promise<types.MeshData> {
    const [positions, indices] = await Promise.all([
      this.floats(m.positions, m.vertices * 3),
      this.uints(m.indices, m.triangles * 3, m.vertices),
    ]);
    return { positions, indices };
  }

  private async bytes(name: string, count: number): Promise<ArrayBuffer> {
    const data = await this.source.read(checked(name));
    if (data.byteLength !== count * 4) throw new Error(`${name}: ${data.byteLength} bytes, expected ${count * 4}`);
    return data;
  }
}

function checked(name: string): string {
  if (!/^[\w.-]+$/.test(name)) throw new Error(`odd file name in scene.json: ${name}`);
  return name;
}

export async function loadBundle(source: BundleSource, session: string): Promise<types.Bundle> {
  const files = new Files(source);
  const json = await files.json('scene.json');
  if (json.version !== 2 && json.version !== 3)
    throw new Error(
      text('scene bundle version {version} is not known to this page', { version: String(json.version) }),
    );
  const tools = await Promise.all(list(json.tools).map((t) => toolOf(files, t)));
  return {
    session,
    title: said(json.title ?? ''),
    description: said(json.description ?? ''),
    view: { eye: json.view.eye, target: json.view.target, up: json.view.up, fovDeg: json.view.fov_deg },
    bodies: await Promise.all(list(json.bodies).map((b) => bodyOf(files, b))),
    tools,
    hands: handsOf(json, tools),
    contactSides: parseContactSides(json.contact_sides),
    commands: commandsOf(json),
    channels: parseChannels(json.channels),
    drawables: await drawablesOf(files, json),
    materials: parseMaterials(json.materials),
    static: await Promise.all(list(json.static).map((s) => surfaceOf(files, s))),
    exercise: json.exercise ? exerciseOf(json.exercise) : null,
    inventory: json.inventory ? parseInventory(await files.json(json.inventory)) : null,
  };
}

function exerciseOf(e: Json): types.ExerciseData {
  return {
    id: e.id ?? '',
    title: said(e.title ?? ''),
    text: said(e.text ?? ''),
    goals: list(e.goals).map((g) => ({ id: g.id, text: said(g.text ?? '') })),
    faults: list(e.faults).map((f) => ({ id: f.id, text: said(f.text ?? '') })),
    motions: Array.isArray(e.motions) ? e.motions.map(String) : [],
    guide: list(e.guide).map((g) => ({
      hand: g.hand === 'left' ? 'left' : 'right',
      tool: g.tool ?? '',
      command: g.command ?? '',
      argument: g.argument ?? '',
      nearM: Number(g.near_m) || 0.003,
      nearRad: Number(g.near_rad) || 0.26,
      timeS: Number(g.time_s) || 0,
      p: g.p_m,
      q: g.q,
      button1: g.button1 === true,
      button2: g.button2 === true,
    })),
  };
}

async function surfaceOf(files: Files, s: Json): Promise<types.SurfaceData> {
  return { id: s.id ?? s.name ?? '', material: s.material ?? '', ...(await files.mesh(s as never)) };
}

async function bodyOf(files: Files, b: Json): Promise<types.BodyData> {
  const surfaces = list(b.surfaces).map(async (s): Promise<types.SkinnedSurface> => ({
    ...(await surfaceOf(files, s)),
    skinNodes: await files.uints(s.skin_nodes, s.vertices * 4, b.nodes),
    skinWeights: await files.floats(s.skin_weights, s.vertices * 4),
    regions: s.regions ?? [],
    vertexRegion:
      s.regions?.length && s.vertex_region ? await files.uints(s.vertex_region, s.vertices, s.regions.length) : null,
  }));
  return {
    index: b.index,
    id: b.id,
    nodes: b.nodes,
    rest: await files.floats(b.rest, b.nodes * 3),
    surfaces: await Promise.all(surfaces),
    channelOfRegion: b.region_value?.channel_of_region ?? {},
    pressureOfRegion: b.region_value?.pressure_of_region ?? {},
    regionThicknessM: b.region_thickness_m ?? {},
    ends: list(b.ends).map((e) => ({ centreM: e.centre_m, outward: e.outward, radiusM: e.radius_m })),
    pulseChannel: b.pulse_channel ?? '',
  };
}

async function toolOf(files: Files, t: Json): Promise<types.ToolData> {
  const hinges = list(t.hinges).map((h): types.HingeData => ({
    origin: h.origin,
    axis: h.axis,
    multiplier: h.multiplier ?? 1,
  }));
  const parts = list(t.parts).map(async (p): Promise<types.ToolPart> => {
    const link = p.link ?? 0;
    if (link < 0 || link > hinges.length)
      throw new Error(`${t.id}: a part hangs on link ${link}, which the tool has not`);
    const { name = '', rgba = [0.8, 0.8, 0.8, 1], material = 'steel' } = p;
    return { name, link, rgba, material, ...(await files.mesh(p as never)) };
  });
  return {
    index: t.index,
    id: t.id,
    hand: t.hand,
    kind: t.kind,
    title: t.title || t.id.replace(/_/g, ' '),
    hinges,
    picture: t.picture ? await files.address(t.picture) : null,
    properties: list(t.properties).map((p) => ({
      name: String(p.name ?? ''),
      text: propertyText(p),
      value: typeof p.value === 'number' && Number.isFinite(p.value) ? p.value : null,
    })),
    cuts: t.cuts === true,
    tags: Array.isArray(t.tags) ? t.tags.map(String) : [],
    parts: await Promise.all(parts),
  };
}

const propertyText = (p: Json): string => String(p.text ?? `${p.value ?? ''} ${p.unit ?? ''}`).trim();

function drawablesOf(files: Files, json: Json): Promise<types.LoadedDrawable[]> {
  return Promise.all(
    parseDrawables(json.drawables).map(async (declared) => ({
      declared,
      meshes: await Promise.all(declared.meshes.map(async (m) => ({ ...(await files.mesh(m)), rgba: m.rgba }))),
    })),
  );
}

function handsOf(json: Json, tools: types.ToolData[]): types.HandData[] {
  return list(json.hands)
    .filter((h) => h.hand === 'left' || h.hand === 'right')
    .map((h): types.HandData => ({
      hand: h.hand,
      tools: (Array.isArray(h.tools) ? (h.tools as number[]) : [])
        .map((n) => tools.find((t) => t.index === n))
        .filter((t) => t !== undefined),
    }));
}

function commandsOf(json: Json): types.CommandGroup[] {
  return list(json.commands).map((g) => ({
    id: String(g.id),
    element: String(g.element ?? ''),
    commands: list(g.commands).map((c) => ({
      name: String(c.name),
      doc: String(c.doc ?? ''),
      argument: String(c.argument ?? ''),
      min: Number(c.min ?? 0),
      max: Number(c.max ?? 0),
      start: typeof c.start === 'number' ? c.start : null,
      usual: typeof c.usual === 'number' ? c.usual : null,
    })),
  }));
}

/** "left_suction" -> "left suction", in the reader's language. */
export const spoken = (id: string): string => said(id.replace(/_/g, ' '));
/** With a capital letter at its beginning. */
export const sentence = (text: string): string => text.slice(0, 1).toUpperCase() + text.slice(1);

async function get(url: string): Promise<Response> {
  const r = await fetch(url, { cache: 'no-store' });
  if (!r.ok) throw new Error(`${url}: ${r.status} ${r.statusText}`);
  return r;
}
