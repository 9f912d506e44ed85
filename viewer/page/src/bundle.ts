// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the scene bundle (docs/scene-bundle.md): scene.json and its binary files, sizes and indices checked.

export interface SurfaceData {
  id: string;
  material: string;
  positions: Float32Array;
  indices: Uint32Array;
}

export interface SkinnedSurface extends SurfaceData {
  skin_nodes: Uint32Array;
  skin_weights: Float32Array;
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
  rgba: [number, number, number, number];
  material: string;
  positions: Float32Array;
  indices: Uint32Array;
}

export interface ToolData {
  index: number;
  id: string;
  hand: string;
  kind: string;
  parts: ToolPart[];
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
  strands: { count: number; radius_m: number };
  exercise: ExerciseData | null;
}

type Json = Record<string, any>;

export async function load_bundle(base: string, session: string): Promise<Bundle> {
  const json = (await (await get(`${base}scene.json`)).json()) as Json;
  if (json.version !== 1) throw new Error(`scene bundle version ${json.version} is not known to this page`);
  const bytes = async (name: string, count: number): Promise<ArrayBuffer> => {
    if (!/^[\w.-]+$/.test(name)) throw new Error(`odd file name in scene.json: ${name}`);
    const data = await (await get(base + name)).arrayBuffer();
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
    }))),
  })));
  const tools = await Promise.all(((json.tools ?? []) as Json[]).map(async (t): Promise<ToolData> => ({
    index: t.index, id: t.id, hand: t.hand, kind: t.kind,
    parts: await Promise.all(((t.parts ?? []) as Json[]).map(async (p): Promise<ToolPart> => {
      // Sizes of tool parts may be left out of scene.json; then the files say them.
      const positions = p.vertices ? await floats(p.positions, p.vertices * 3) : new Float32Array(await (await get(base + p.positions)).arrayBuffer());
      const indices = p.triangles ? await uints(p.indices, p.triangles * 3, positions.length / 3) : new Uint32Array(await (await get(base + p.indices)).arrayBuffer());
      return { name: p.name ?? '', rgba: p.rgba ?? [0.8, 0.8, 0.8, 1], material: p.material ?? 'steel', positions, indices };
    })),
  })));
  return {
    session, title: json.title ?? '', description: json.description ?? '',
    view: json.view, bodies, tools,
    static: await Promise.all(((json.static ?? []) as Json[]).map(surface)),
    strands: { count: json.strands?.count ?? 0, radius_m: json.strands?.radius_m ?? 0.00015 },
    exercise: json.exercise ?? null,
  };
}

async function get(url: string): Promise<Response> {
  const r = await fetch(url, { cache: 'no-store' });
  if (!r.ok) throw new Error(`${url}: ${r.status} ${r.statusText}`);
  return r;
}
