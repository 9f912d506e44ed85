// SPDX-License-Identifier: GPL-3.0-or-later
// Channels, drawables and materials of the made-up session, and their numbers at a time. The suture stands for a plugin
// that the page has never heard of; `samples` show one of each kind.
import { bleb, sac } from './artery.mjs';
import { branches } from './theatre.mjs';
import { add, scale, unit, sub } from './vec.mjs';

const mmHg = { unit: 'mmHg', scale: 1 / 133.322, digits: 0 };
const mLMin = { unit: 'mL/min', scale: 6e7, digits: 0 };
const percent = { unit: '%', scale: 100, digits: 0 };
const bands = { good: [0.8, null], high: [0.5, null] };

export const materials = {
  cortex: { style: 'tissue', rgba: [0.75, 0.49, 0.43, 1] },
  insula: { style: 'tissue', rgba: [0.71, 0.45, 0.38, 1] },
  vessel: { style: 'wall', rgba: [0.6, 0.2, 0.17, 1] },
  bone: { style: 'solid', rgba: [0.73, 0.65, 0.52, 1] },
  arachnoid: { style: 'fibre', rgba: [0.91, 0.88, 0.85, 0.78], roughness: 0.35 },
  film: { style: 'sheet', rgba: [0.91, 0.88, 0.85, 0.78], roughness: 0.35 },
  blood: { style: 'fluid', rgba: [0.4, 0.02, 0.02, 1] },
  nylon: { style: 'hologram', rgba: [0.1, 0.9, 0.2, 1], roughness: 0.4 },
  pane: { style: 'glass', rgba: [0.6, 0.8, 1, 1], roughness: 0.05 },
};

const channel = (component, name, unit, doc, more = {}) => ({
  id: `${component}.${name}`,
  component,
  name,
  unit,
  doc,
  ...more,
});

function declared() {
  const branch = (id) => [
    channel('flow', `${id}.pressure`, 'Pa', 'of this moment', { group: id, shown: 'vital', display: mmHg }),
    channel('flow', `${id}.flow`, 'm3/s', 'mean of the last beat', { group: id, shown: 'vital', display: mLMin }),
    channel('flow', `${id}.share`, '1', 'of the flow at rest', {
      ...{ group: id, shown: 'vital', display: percent, min: 0, max: 1 },
      ...(id === 'sac' ? {} : { bands }),
    }),
    channel('flow', `${id}.dye`, '1', 'concentration', { group: id, shown: 'none', min: 0, max: 1 }),
  ];
  return [
    channel('arachnoid', 'left', '1', 'fibres that are whole', { shown: 'vital', display: { digits: 0 } }),
    channel('pressure', 'heart_phase', '1', 'phase of the heartbeat', { min: 0, max: 1 }),
    ...branches.flatMap(branch),
    channel('bleeding', 'rate', 'm3/s', 'of blood out of the tear', { shown: 'vital', display: mLMin }),
    channel('bleeding', 'lost', 'm3', 'since the tear', {
      shown: 'vital',
      display: { unit: 'mL', scale: 1e6, digits: 1 },
    }),
    channel('suture', 'tension', 'N', 'largest along the thread', {
      shown: 'curve',
      display: { unit: 'mN', scale: 1000 },
    }),
    channel('suture', 'pull', 'N', 'on the needle', { shown: 'none', size: 3 }),
  ];
}

/** As scene.json has them: sizes and offsets filled in. */
export function makeChannels(fibres) {
  let offset = 0;
  return declared().map((c) => {
    const size = c.size ?? 1;
    offset += size;
    return {
      min: null,
      max: c.name === 'left' ? fibres : null,
      group: '',
      shown: 'none',
      ...c,
      size,
      offset: offset - size,
    };
  });
}

const drawable = (component, name, kind, material, more = {}) => ({
  ...{ id: `${component}.${name}`, component, name, kind, material, doc: '' },
  ...more,
});

const threadPoints = 24;

/** put: writes an array into a file of the bundle. */
export function makeDrawables(fibres, pieces, put, samples) {
  const square = Float32Array.from([0, 0, 0, 0.004, 0, 0, 0.004, 0.004, 0, 0, 0.004, 0]);
  const mesh = (name) => ({
    ...{ vertices: 4, triangles: 2 },
    positions: put(`${name}_p.bin`, square),
    indices: put(`${name}_i.bin`, Uint32Array.from([0, 1, 2, 0, 2, 3])),
  });
  const all = [
    drawable('arachnoid', 'fibres', 'polylines', 'arachnoid', { points_per_line: 2, count: fibres, radius_m: 0.00015 }),
    drawable('bleeding', 'pool', 'plane', 'blood', { rate_channel: 'bleeding.rate' }),
    drawable('bleeding', 'jet', 'polylines', 'blood', { points_per_line: 2, count: 1 }),
    drawable('suture', 'thread', 'polylines', 'nylon', { points_per_line: threadPoints, count: 1, radius_m: 0.0004 }),
    drawable('arachnoid', 'film', 'polylines', 'film', { points_per_line: 5, count: pieces, radius_m: 0.00005 }),
  ];
  const one = [
    drawable('sample', 'knots', 'points', 'nylon', {
      radius_m: 0.0008,
      value: { doc: 'load', unit: '', min: 0, max: 1 },
    }),
    drawable('sample', 'patch', 'patch', 'vessel', mesh('patch')),
    drawable('sample', 'pane', 'plane', 'pane'),
    drawable('sample', 'tag', 'label', 'nylon', { text: 'knot {}', value: { doc: 'tension', unit: 'mN' } }),
    drawable('sample', 'needle', 'links', 'nylon', { parts: [mesh('needle')] }),
  ];
  return (samples ? [...all, ...one] : all).map((d, index) => ({ index, ...d }));
}

const tensionAt = (time) => 0.02 + 0.015 * Math.sin(2 * time);

export function channelNumbers(scene, theatre, { time, fibres }) {
  const flow = branches.flatMap((id) => {
    const b = theatre.branch(id);
    return [b.pressure, b.flow, b.share, b.dye];
  });
  const left = fibres.filter((s) => s.whole >= 0).length;
  const rate = (theatre.bleed * 1e-6) / 60;
  return [left, theatre.phase, ...flow, rate, theatre.lost * 1e-6, tensionAt(time), tensionAt(time), 0, 0];
}

/** A thread in an arc over the field. */
function thread(scene, time) {
  const out = [];
  for (let k = 0; k < threadPoints; k++) {
    const s = k / (threadPoints - 1) - 0.5;
    const at = add(add(scale(sac), scene.out, 0.012 - 0.02 * s * s + 0.0005 * Math.sin(time)), scene.along, 0.024 * s);
    out.push(...add(at, scene.open, 0.004 * Math.sin(9 * s)), tensionAt(time));
  }
  return out;
}

/** A piece of film: the tip of its tent, both ends of a fibre, both of its neighbour. Every seventh tents. */
function piece(scene, fibres, [i, j], k, time) {
  const [a, b] = [fibres[i], fibres[j]];
  const whole = a.whole < 0 && b.whole < 0 ? -1 : 1;
  const middle = scale(add(add(a.p, a.q), add(b.p, b.q)), 0.25);
  const tip = add(middle, scene.along, k % 7 === 0 ? 0.0008 * (1 + Math.sin(time)) : 0);
  return [...tip, whole, ...a.p, a.whole, ...a.q, a.whole, ...b.p, b.whole, ...b.q, b.whole];
}

export function drawableNumbers(scene, theatre, { time, fibres }) {
  const bottom = add(scale(sac), scene.out, -0.004);
  const radius = theatre.height > 1e-5 ? 0.016 : 0;
  const outward = unit(sub(bleb, sac));
  const tear = add(scale(bleb), outward, 0.0012);
  const strength = theatre.tornAt === null ? 0 : Math.min(1, theatre.bleed / 60);
  const out = [
    fibres.flatMap(({ p, q, whole }) => [...p, whole, ...q, whole]),
    [...add(bottom, scene.out, theatre.height), ...scene.out, radius, strength],
    [...tear, strength, ...add(tear, outward, 0.001), strength],
    thread(scene, time),
    scene.pieces.flatMap((pair, k) => piece(scene, fibres, pair, k, time)),
  ];
  if (!scene.samples) return out;
  const top = add(scale(sac), scene.out, 0.011);
  const square = [0, 1, 1, 0].flatMap((x, k) => [
    ...add(add(top, scene.along, 0.006 * x), scene.open, k < 2 ? -0.006 : -0.002),
    1,
  ]);
  return [
    ...out,
    [0, 1, 2].flatMap((k) => [...add(top, scene.along, 0.004 * k - 0.01), k / 2]),
    square,
    [...add(top, scene.open, 0.006), ...scene.out, 0.003, 0],
    [...add(top, scene.open, 0.01), 1000 * tensionAt(time)],
    [...add(top, scene.along, -0.012), 1, 0, 0, 0, 0],
  ];
}
