// SPDX-License-Identifier: GPL-3.0-or-later
// A synthetic session: the project's lobes and instruments, lobes moved apart by a made-up law (no physics), fibres
// between them that tighten and part in turn. It lets the page be worked on and tested without the engine.
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { makeArtery, regions, sac } from './artery.mjs';
import { makeClips } from './clips.mjs';
import { embed, readMsh, readObj, readPly } from './meshes.mjs';
import { makeChannels, makeDrawables, materials } from './step_data.mjs';
import { branches, commands, handTools } from './theatre.mjs';
import { add, cross, scale, sub, unit } from './vec.mjs';

const goals = [
  { id: 'superficial', text: 'Open the superficial arachnoid' },
  { id: 'deep', text: 'Reach the insula' },
  { id: 'all', text: 'Cut nine strands in ten' },
];
const faults = [
  { id: 'frontal_force', text: 'Frontal lobe pressed too hard' },
  { id: 'temporal_force', text: 'Temporal lobe pressed too hard' },
];
/** What the mock's engine says is in no catalogue. */
export const exercise = {
  id: 'sylvian_fissure',
  title: 'Sylvian fissure',
  text: 'Retract with the suction in the left hand; cut the strands from the surface to the depth with the right.',
  goals,
  faults,
  motions: ['steady'],
  guide: [
    { hand: 'right', tool: 'right_dissector', p_m: [0.02, 0.01, 0.02], q: [1, 0, 0, 0], button1: false },
    { hand: 'right', tool: 'right_dissector', p_m: [0.02, 0.01, 0], q: [1, 0, 0, 0], button1: true },
  ],
};

/** Files of the bundle by name. */
class Store {
  files = new Map();

  put(name, array) {
    this.files.set(name, Buffer.from(array.buffer, array.byteOffset, array.byteLength));
    return name;
  }

  mesh(name, positions, indices) {
    return {
      vertices: positions.length / 3,
      triangles: indices.length / 3,
      positions: this.put(`${name}_positions.bin`, positions),
      indices: this.put(`${name}_indices.bin`, indices),
    };
  }

  skin(name, nodes, weights) {
    return { skin_nodes: this.put(`${name}_nodes.bin`, nodes), skin_weights: this.put(`${name}_weights.bin`, weights) };
  }
}

const metres = (a) => a.map((x) => x / 1000);

function makeLobe(store, meshes, id, index) {
  const { positions, tets } = readMsh(join(meshes, `lobes/${id}.msh`));
  const rest = metres(positions);
  const surface = readPly(join(meshes, `lobes/${id}_surface.ply`));
  const fine = metres(surface.positions);
  const skin = embed(fine, rest, tets);
  const json = {
    ...{ index, id, nodes: rest.length / 3, rest: store.put(`body${index}_rest.bin`, rest) },
    surfaces: [
      {
        ...{ id: `${id}_surface`, material: 'cortex' },
        ...store.mesh(`s${index}`, fine, surface.indices),
        ...store.skin(`s${index}`, skin.nodes, skin.weights),
      },
    ],
  };
  return { id, index, rest, tets, fine, skin, json };
}

function makeStatic(store, meshes) {
  const one = (id, mesh) => ({ id, material: id, ...store.mesh(`static_${id}`, metres(mesh.positions), mesh.indices) });
  const window = ['bone', 'dura', 'skin', 'drape'].map((id) => [id, join(meshes, `window/${id}.obj`)]);
  return [
    one('insula', readPly(join(meshes, 'lobes/insula_surface.ply'))),
    ...window.filter(([, file]) => existsSync(file)).map(([id, file]) => one(id, readObj(file))),
  ];
}

function makeVessel(store, index) {
  const vessel = makeArtery();
  const name = 'artery_picture';
  const surface = {
    ...{ id: name, material: 'vessel', regions },
    ...store.mesh(name, vessel.picture, vessel.picture_indices),
    ...store.skin(name, vessel.nodes, vessel.weights),
    vertex_region: store.put(`${name}_regions.bin`, vessel.picture_region),
  };
  const json = {
    ...{ index, id: 'artery', nodes: vessel.rest.length / 3, rest: store.put('artery_rest.bin', vessel.rest) },
    ...{ regions, surfaces: [surface], pulse_channel: 'pressure.heart_phase' },
    region_value: { channel_of_region: Object.fromEntries(branches.map((b) => [b, `flow.${b}.dye`])) },
    region_thickness_m: { parent: 0.0003, neck: 0.00025, sac: 0.0002, bleb: 0.0001 },
  };
  return { ...vessel, index, json };
}

function partJson(store, name, p) {
  const { link = 0, rgba = [0.8, 0.8, 0.82, 1], material = 'titanium' } = p;
  return { name: p.name, link, rgba, material, ...store.mesh(name, metres(p.mesh.positions), p.mesh.indices) };
}

function makeInstrument(store, meshes, id, index) {
  const kind = id.slice(id.indexOf('_') + 1);
  const hand = id.slice(0, id.indexOf('_'));
  const dir = join(meshes, 'instruments', kind);
  const named = /_(steel_dark|steel|gold|polymer)\.obj$/;
  const files = existsSync(dir) ? readdirSync(dir).filter((f) => named.test(f)) : [];
  const parts = files.sort().map((f, k) => {
    const part = { name: f.replace('.obj', ''), material: named.exec(f)[1], mesh: readObj(join(dir, f)) };
    return partJson(store, `tool${index}_${k}`, part);
  });
  return { index, id, hand, kind, title: id.replace(/_/g, ' '), hinges: [], parts };
}

function makeClip(store, c, index) {
  const picture = `t${index}_picture.svg`;
  store.files.set(picture, Buffer.from(c.picture));
  const parts = c.parts.map((p, k) => partJson(store, `t${index}_${k}`, p));
  const { id, title, properties, tags, hinges } = c;
  return { index, id, hand: 'none', kind: 'clip', title, picture, properties, tags, hinges, parts };
}

/** Stations along the fissure and the directions of the field. */
function makeFrameOf(meshes) {
  const fissure = JSON.parse(readFileSync(join(meshes, 'lobes/fissure.json'), 'utf8'));
  const stations = fissure.stations.map((s) => ({ superficial: scale(s.superficial), deep: scale(s.deep) }));
  const out = unit(fissure.outward_normal);
  const along = unit(sub(stations[stations.length - 1].superficial, stations[0].superficial));
  const up = unit(cross(along, out));
  // Towards the frontal lobe (superior).
  return { stations, centre: scale(fissure.centre), out, along, open: up[2] > 0 ? up : up.map((x) => -x) };
}

/** samples: one drawable of each kind beside the usual ones. */
export function makeScene(meshes, samples = false) {
  const field = makeFrameOf(meshes);
  const { centre, out, open } = field;
  const store = new Store();
  const bodies = ['frontal', 'temporal'].map((id, index) => makeLobe(store, meshes, id, index));
  const artery = makeVessel(store, bodies.length);
  const fixed = makeStatic(store, meshes);
  const tools = [...handTools.left, ...handTools.right].map((id, index) => makeInstrument(store, meshes, id, index));
  const clips = makeClips(meshes);
  for (const c of clips) tools.push(makeClip(store, c, tools.length));
  const fibres = makeFibres(bodies, field.stations);
  const pieces = neighbours(bodies, fibres);
  const eye = add(add(scale(sac), out, 0.13), open, -0.015);
  const hands = Object.entries(handTools).map(([hand, ids]) => {
    const of = ids.map((id) => tools.findIndex((t) => t.id === id));
    return { hand, tool: of[0], tools: of, home_p_m: add(centre, out, 0.02), home_q: [1, 0, 0, 0] };
  });
  const json = {
    ...{ version: 2, session: 0, title: 'Mock session', description: 'Made-up motion, no physics.' },
    view: { eye, target: add(scale(sac), out, -0.002), up: open, fov_deg: 17 },
    ...{ bodies: [...bodies.map((b) => b.json), artery.json], static: fixed, tools, hands, commands, exercise },
    channels: makeChannels(fibres.length),
    drawables: makeDrawables(fibres.length, pieces.length, (name, array) => store.put(name, array), samples),
    materials,
  };
  return { json, files: store.files, bodies, artery, tools, clips, fibres, pieces, samples, goals, faults, ...field };
}

/** Pairs of facing surface points across the fissure, from its surface to its depth. */
function makeFibres(bodies, stations) {
  const [a, b] = bodies;
  const fibres = [];
  let seed = 5;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (const s of stations.slice(3, 13)) {
    const inward = unit(sub(s.deep, s.superficial));
    for (let k = 0; k < 9; k++) {
      const depth = (0.02 + 0.5 * random()) * Math.hypot(...sub(s.deep, s.superficial));
      const jitter = [0, 0, 0].map(() => (random() - 0.5) * 0.009);
      const at = add(add(s.superficial, inward, depth), jitter);
      const va = nearest(a.fine, at);
      const vb = nearest(
        b.fine,
        [0, 1, 2].map((j) => a.fine[va * 3 + j]),
      );
      const length = Math.hypot(...[0, 1, 2].map((j) => a.fine[va * 3 + j] - b.fine[vb * 3 + j]));
      if (length > 0.0045) continue;
      fibres.push({ va, vb, depth, length, cutAt: 6 + depth * 1000 * 0.9 + random() * 4 });
    }
  }
  return fibres.sort((x, y) => x.depth - y.depth);
}

/** Each fibre and the two that begin nearest to it, once. */
function neighbours([a], fibres) {
  const start = ({ va }) => a.fine.subarray(3 * va, 3 * va + 3);
  const distance = (f, g) => Math.hypot(...sub([...start(f)], [...start(g)]));
  return fibres.flatMap((f, i) =>
    fibres
      .map((g, j) => ({ j, d: distance(f, g) }))
      .filter(({ j, d }) => j > i && d < 0.004)
      .sort((x, y) => x.d - y.d)
      .slice(0, 2)
      .map(({ j }) => [i, j]),
  );
}

function nearest(points, q) {
  let best = 0;
  let d2 = Infinity;
  for (let v = 0; v < points.length / 3; v++) {
    const d = (points[v * 3] - q[0]) ** 2 + (points[v * 3 + 1] - q[1]) ** 2 + (points[v * 3 + 2] - q[2]) ** 2;
    if (d < d2) {
      d2 = d;
      best = v;
    }
  }
  return best;
}
