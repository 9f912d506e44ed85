// SPDX-License-Identifier: GPL-3.0-or-later
// A synthetic session: the project's lobes and instruments, lobes moved apart by a made-up law (no physics), strands between
// them that tighten and part in turn. It lets the page be worked on and tested without the engine.
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { make_artery, move_artery, neck, regions, sac } from './artery.mjs';
import { make_clips } from './clips.mjs';
import { embed, read_msh, read_obj, read_ply } from './meshes.mjs';
import { commands, hand_tools } from './theatre.mjs';

const scale = (a) => a.map((x) => x / 1000);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };
const ramp = (t, a, b) => { const s = Math.max(0, Math.min(1, (t - a) / (b - a))); return s * s * (3 - 2 * s); };

export function make_scene(meshes) {
  const fissure = JSON.parse(readFileSync(join(meshes, 'lobes/fissure.json'), 'utf8'));
  const stations = fissure.stations.map((s) => ({ ...s, superficial: scale(s.superficial), deep: scale(s.deep) }));
  const centre = scale(fissure.centre);
  const out = unit(fissure.outward_normal);
  const along = unit(sub(stations[stations.length - 1].superficial, stations[0].superficial));
  const up = unit(cross(along, out)).map((x) => x);
  // Towards the frontal lobe (superior).
  const open = up[2] > 0 ? up : up.map((x) => -x);
  const files = new Map();
  const put = (name, array) => { files.set(name, Buffer.from(array.buffer, array.byteOffset, array.byteLength)); return name; };

  const bodies = ['frontal', 'temporal'].map((id, index) => {
    const { positions, tets } = read_msh(join(meshes, `lobes/${id}.msh`));
    const rest = positions.map((x) => x / 1000);
    const surface = read_ply(join(meshes, `lobes/${id}_surface.ply`));
    const fine = surface.positions.map((x) => x / 1000);
    const skin = embed(fine, rest, tets);
    return { id, index, rest, tets, fine, indices: surface.indices, skin, json: {
      index, id, nodes: rest.length / 3, rest: put(`body${index}_rest.bin`, rest),
      surfaces: [{ id: `${id}_surface`, material: 'cortex', vertices: fine.length / 3, triangles: surface.indices.length / 3,
        positions: put(`s${index}_positions.bin`, fine), indices: put(`s${index}_indices.bin`, surface.indices),
        skin_nodes: put(`s${index}_nodes.bin`, skin.nodes), skin_weights: put(`s${index}_weights.bin`, skin.weights) }] } };
  });

  const fixed = [];
  const add_static = (id, material, mesh) => {
    const p = mesh.positions.map((x) => x / 1000);
    fixed.push({ id, material, vertices: p.length / 3, triangles: mesh.indices.length / 3, positions: put(`static_${id}_p.bin`, p), indices: put(`static_${id}_i.bin`, mesh.indices) });
  };
  add_static('insula', 'insula', read_ply(join(meshes, 'lobes/insula_surface.ply')));
  for (const id of ['bone', 'dura', 'skin', 'drape']) if (existsSync(join(meshes, `window/${id}.obj`))) add_static(id, id, read_obj(join(meshes, `window/${id}.obj`)));

  const vessel = make_artery();
  const surface = (name, positions, indices, nodes, weights, region) => ({ id: name, material: 'vessel', vertices: positions.length / 3, triangles: indices.length / 3,
    positions: put(`${name}_positions.bin`, positions), indices: put(`${name}_indices.bin`, indices), skin_nodes: put(`${name}_nodes.bin`, nodes), skin_weights: put(`${name}_weights.bin`, weights),
    regions, vertex_region: put(`${name}_regions.bin`, region) });
  const artery = { ...vessel, index: bodies.length, json: { index: bodies.length, id: 'artery', nodes: vessel.rest.length / 3, rest: put('artery_rest.bin', vessel.rest), regions,
    surfaces: [surface('artery_picture', vessel.picture, vessel.picture_indices, vessel.nodes, vessel.weights, vessel.picture_region)] } };

  const part_json = (name, p) => ({ name: p.name, link: p.link ?? 0, rgba: p.rgba ?? [0.8, 0.8, 0.82, 1], material: p.material ?? 'titanium', vertices: p.mesh.positions.length / 3, triangles: p.mesh.indices.length / 3,
    positions: put(`${name}_p.bin`, p.mesh.positions.map((x) => x / 1000)), indices: put(`${name}_i.bin`, p.mesh.indices) });
  const tools = [...hand_tools.left, ...hand_tools.right].map((id, index) => {
    const kind = id.slice(id.indexOf('_') + 1), hand = id.slice(0, id.indexOf('_'));
    const dir = join(meshes, 'instruments', kind);
    const obj = existsSync(dir) ? readdirSync(dir).filter((f) => /_(steel|steel_dark|gold|polymer)\.obj$/.test(f)).sort() : [];
    const parts = obj.map((f, k) => part_json(`tool${index}_${k}`, { name: f.replace('.obj', ''), material: /_(steel_dark|steel|gold|polymer)\.obj$/.exec(f)[1], mesh: read_obj(join(dir, f)) }));
    return { index, id, hand, kind, title: id.replace(/_/g, ' '), hinges: [], parts };
  });
  const clips = make_clips(meshes);
  for (const c of clips) {
    const index = tools.length;
    files.set(`t${index}_picture.svg`, Buffer.from(c.picture));
    tools.push({ index, id: c.id, hand: 'none', kind: 'clip', title: c.title, picture: `t${index}_picture.svg`, clip: c.clip, hinges: c.hinges, parts: c.parts.map((p, k) => part_json(`t${index}_${k}`, p)) });
  }

  const strands = make_strands(bodies, stations, out);
  const eye = add(add(scale(sac), out, 0.13), open, -0.015);
  const goals = [{ id: 'superficial', text: 'Open the superficial arachnoid' }, { id: 'deep', text: 'Reach the insula' }, { id: 'all', text: 'Cut nine strands in ten' }];
  const faults = [{ id: 'frontal_force', text: 'Frontal lobe pressed too hard' }, { id: 'temporal_force', text: 'Temporal lobe pressed too hard' }];
  const json = {
    version: 2, session: 0, title: 'Mock session', description: 'Made-up motion, no physics.',
    view: { eye, target: add(scale(sac), out, -0.002), up: open, fov_deg: 17 },
    bodies: [...bodies.map((b) => b.json), artery.json], static: fixed, tools, strands: { count: strands.length, radius_m: 0.00015 },
    hands: Object.entries(hand_tools).map(([hand, ids]) => { const of = ids.map((id) => tools.findIndex((t) => t.id === id)); return { hand, tool: of[0], tools: of, home_p_m: add(centre, out, 0.02), home_q: [1, 0, 0, 0] }; }),
    commands,
    exercise: { id: 'sylvian_fissure', title: 'Sylvian fissure', text: 'Retract with the suction in the left hand; cut the strands from the surface to the depth with the right.', goals, faults },
  };
  return { json, files, bodies, artery, tools, clips, strands, centre, out, open, along, stations, goals, faults };
}

/** Pairs of facing surface points across the fissure, from its surface to its depth. */
function make_strands(bodies, stations, out) {
  const [a, b] = bodies;
  const strands = [];
  let seed = 5;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (const s of stations.slice(3, 13)) {
    const inward = unit(sub(s.deep, s.superficial));
    for (let k = 0; k < 9; k++) {
      const depth = (0.02 + 0.5 * random()) * Math.hypot(...sub(s.deep, s.superficial));
      const jitter = [0, 0, 0].map(() => (random() - 0.5) * 0.009);
      const at = add(add(s.superficial, inward, depth), jitter);
      const va = nearest(a.fine, at), vb = nearest(b.fine, [0, 1, 2].map((j) => a.fine[va * 3 + j]));
      const length = Math.hypot(...[0, 1, 2].map((j) => a.fine[va * 3 + j] - b.fine[vb * 3 + j]));
      if (length > 0.0045) continue;
      strands.push({ va, vb, depth, length, cut_at: 6 + depth * 1000 * 0.9 + random() * 4 });
    }
  }
  void out;
  return strands.sort((x, y) => x.depth - y.depth);
}

function nearest(points, q) {
  let best = 0, d2 = Infinity;
  for (let v = 0; v < points.length / 3; v++) {
    const d = (points[v * 3] - q[0]) ** 2 + (points[v * 3 + 1] - q[1]) ** 2 + (points[v * 3 + 2] - q[2]) ** 2;
    if (d < d2) { d2 = d; best = v; }
  }
  return best;
}

/** Node positions, strands and tools at a time; `held` are poses asked for by a page, `theatre` knows the rest. */
export function make_frame(scene, lcm, time, held, theatre) {
  const { centre, out, open, along, bodies, artery } = scene;
  const spread = 0.0085 * ramp(time, 1.5, 14) + 0.0004 * Math.sin(time * 6.3);
  const moved = bodies.map((b) => {
    const x = new Float32Array(b.rest.length);
    for (let i = 0; i < x.length; i += 3) {
      const p = [b.rest[i], b.rest[i + 1], b.rest[i + 2]];
      const d = sub(p, centre);
      const u = dot(d, along), w = dot(d, out), s = dot(d, open);
      const fall = Math.exp(-(u * u) / (2 * 0.012 ** 2)) * Math.exp(-(s * s) / (2 * 0.011 ** 2)) * ramp(w, -0.03, 0.004);
      const way = b.id === 'frontal' ? 1 : -0.75;
      for (let k = 0; k < 3; k++) x[i + k] = p[k] + open[k] * way * spread * fall - out[k] * 0.25 * spread * fall;
    }
    // The wound is drawn apart over the aneurysm too.
    const wide = 0.013 * ramp(time, 1.5, 14), over = scale(sac);
    for (let i = 0; i < x.length; i += 3) {
      const d = sub([b.rest[i], b.rest[i + 1], b.rest[i + 2]], over);
      const s = dot(d, open), u = dot(d, along), fall = Math.exp(-(u * u) / (2 * 0.011 ** 2)) * Math.exp(-(s * s) / (2 * 0.012 ** 2)) * ramp(dot(d, out), -0.016, -0.004);
      const way = b.id === 'frontal' ? 1 : -1;
      for (let k = 0; k < 3; k++) x[i + k] += open[k] * way * wide * fall;
    }
    return x;
  });
  const squeeze = theatre.placed_at === null ? 0 : ramp(time, theatre.placed_at - 0.3, theatre.placed_at + 0.1);
  const seat = clip_seat(scene, scale(neck));
  moved.push(move_artery(artery, theatre.pulse, theatre.tension, squeeze, seat.across));
  const at = (b, v) => [0, 1, 2].map((j) => [0, 1, 2, 3].reduce((sum, k) => sum + bodies[b].skin.weights[v * 4 + k] * moved[b][bodies[b].skin.nodes[v * 4 + k] * 3 + j], 0));
  const n = scene.strands.length;
  const strand_x_m = new Float32Array(n * 6), integrity = new Float32Array(n), tension = new Float32Array(n);
  let left = 0;
  scene.strands.forEach((s, i) => {
    const p = at(0, s.va), q = at(1, s.vb);
    strand_x_m.set([...p, ...q], i * 6);
    const damage = ramp(time, s.cut_at - 1.2, s.cut_at);
    integrity[i] = time >= s.cut_at ? -1 : 1 - damage;
    if (integrity[i] >= 0) left++;
    tension[i] = integrity[i] < 0 ? 0 : Math.max(0, Math.hypot(...sub(p, q)) - s.length * 1.6) * 12 * integrity[i];
  });
  const f = lcm.render_frame_t.make();
  f.sim_time_s = time;
  f.bodies = bodies.length + 1;
  f.body = [...bodies, artery].map((b, k) => ({ index: b.index, nodes: moved[k].length / 3, x_m: moved[k] }));
  f.strands = n;
  f.strand_points = 2 * n;
  f.strand_x_m = strand_x_m;
  f.strand_integrity = integrity;
  f.strand_tension_N = tension;
  f.tool = scene.tools.map((tool) => tool_frame(scene, lcm, tool, time, spread, held, left, theatre, seat));
  f.tools = f.tool.length;
  f.step_ms = 4.2 + Math.sin(time);
  f.step_period_ms = 1000 / 60;
  f.rows = 120;
  f.sweeps = 12;
  f.body_force_N = Float64Array.from([0.1, 0.08, 0]);
  f.hud_json = JSON.stringify({
    goals: scene.goals.map((g, k) => ({ ...g, done: [left < n * 0.7, left < n * 0.3, left < n * 0.1][k] })),
    faults: scene.faults.map((x, k) => ({ ...x, count: k === 0 && time > 10 ? 1 : 0 })),
    strands_left: left, strands_total: n, message: '', state: left < n * 0.1 && theatre.placed_at !== null ? 'done' : 'running', elapsed_s: time,
    ...theatre.hud(add(scale(sac), out, -0.004), out),
  });
  return f;
}

/** A clip across the neck: blades along the neck plane, opening across. */
function clip_seat(scene, at) {
  const axis = unit(sub(scale(sac), at));
  // The shaft comes out of the wound.
  const z = unit(add(scene.out, axis, -dot(scene.out, axis) * 0.85));
  const x = unit(add(axis, z, -dot(axis, z)));
  return { across: x, p: add(at, z, -0.0042), q: frame_quaternion(z, x) };
}

function tool_frame(scene, lcm, tool, time, spread, held, left, theatre, seat) {
  if (tool.kind !== 'clip') {
    const hand = tool.hand === 'left' ? 0 : 1;
    const t = tool_pose(scene, lcm, hand, time, spread, held?.[hand], left);
    t.index = tool.index;
    t.state = theatre.in_hand[tool.hand] === tool.id ? 1 : 0;
    return t;
  }
  const t = lcm.render_tool_t.make();
  Object.assign(t, { index: tool.index, hand: -1, state: 0 });
  t.q = Float64Array.from([1, 0, 0, 0]);
  if (theatre.free.includes(tool.id)) {
    t.state = 2;
    const parent = tool.id.includes('temporary');
    t.p_m = Float64Array.from(parent ? add(scale([43.4, 14.6, -14.4]), scene.out, -0.003) : seat.p);
    t.q = Float64Array.from(parent ? frame_quaternion(scene.out, scene.along) : seat.q);
    t.opening_rad = 0.06;
  } else if (theatre.loaded === tool.id && theatre.in_hand.right === 'right_clip_applier') {
    const holder = tool_pose(scene, lcm, 1, time, spread, held?.[1], left);
    Object.assign(t, { state: 1, hand: 1 });
    const z = rotate([...holder.q], [0, 0, 1]);
    t.p_m = Float64Array.from(add([...holder.p_m], z, -(tool.hinges[0].origin[2] + 0.002)));
    t.q = holder.q;
    t.opening_rad = holder.button1 ? 0.24 : 0.1 + 0.1 * Math.sin(time);
  }
  t.device_p_m = t.p_m;
  return t;
}

function rotate([w, x, y, z], v) {
  const u = [x, y, z], c = cross(u, v).map((a, k) => a + w * v[k]), d = cross(u, c);
  return v.map((a, k) => a + 2 * d[k]);
}

function tool_pose(scene, lcm, hand, time, spread, held, left) {
  const { centre, out, open, along } = scene;
  const t = lcm.render_tool_t.make();
  t.index = hand;
  t.hand = hand;
  let p, q;
  if (held) { p = [...held.p_m]; q = [...held.q]; } else {
    const side = hand === 0 ? -1 : 1;
    const deep = hand === 0 ? -0.004 : -0.002 - 0.010 * ramp(time, 5, 22);
    p = add(add(add(scale(sac), out, deep + 0.008), along, side * 0.009 + (hand ? 0.006 * Math.sin(time * 0.9) : -0.002)), open, hand === 0 ? spread * 0.8 - 0.001 : 0.0006 * Math.sin(time * 7));
    // Shaft: out of the wound, leaning to its own side and towards the surgeon.
    const z = unit(add(add(out.map((x) => x * 0.9), along, -along[0] * 0 + side * -0.42 * Math.sign(dot(along, [0, 1, 0])) * (hand === 0 ? 1 : 1)), open, -0.35));
    q = frame_quaternion(z, open);
  }
  t.p_m = Float64Array.from(p);
  t.q = Float64Array.from(q);
  t.device_p_m = Float64Array.from(p);
  t.force_N = Float64Array.from([0.05 + 0.04 * Math.sin(time * 2), hand === 0 ? 8 * spread : 0.05 * Math.abs(Math.sin(time * 5)), 0]);
  t.button1 = held?.button1 ? 1 : 0;
  t.activity = left > 0 ? 1 : 0;
  return t;
}

/** w x y z of the rotation whose z axis is z and whose x axis is nearest to x. */
function frame_quaternion(z, x) {
  const xx = unit(add(x, z, -dot(x, z)));
  const y = cross(z, xx);
  const m = [xx, y, z]; // columns
  const [m00, m11, m22] = [xx[0], y[1], z[2]];
  const w = Math.sqrt(Math.max(0, 1 + m00 + m11 + m22)) / 2;
  if (w > 1e-3) return [w, (y[2] - z[1]) / (4 * w), (z[0] - xx[2]) / (4 * w), (xx[1] - y[0]) / (4 * w)];
  const i = m00 > m11 && m00 > m22 ? 0 : m11 > m22 ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
  const r = Math.sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
  const q = [0, 0, 0, 0];
  q[1 + i] = r / 2;
  q[0] = (m[j][k] - m[k][j]) / (2 * r);
  q[1 + j] = (m[i][j] + m[j][i]) / (2 * r);
  q[1 + k] = (m[i][k] + m[k][i]) / (2 * r);
  return q;
}
