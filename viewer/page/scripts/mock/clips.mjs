// SPDX-License-Identifier: GPL-3.0-or-later
// Clips for the mock: the project's own where they are built, else two plates and a block.
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { readObj } from './meshes.mjs';

const wanted = [
  'straight',
  'curved',
  'angled',
  'bayonet',
  'fenestrated_3_5_stem_90',
  'mini',
  'temporary_straight',
  'temporary_curved',
];

export function makeClips(meshes) {
  const dir = join(meshes, 'clips');
  const found = wanted.filter((n) => existsSync(join(dir, n, `${n}.urdf`)));
  return found.length > 0
    ? found.map((n) => realClip(join(dir, n), n))
    : [plateClip('straight', 9), plateClip('mini', 5), plateClip('temporary_straight', 9)];
}

function realClip(dir, name) {
  const about = JSON.parse(readFileSync(join(dir, 'tool.json'), 'utf8'));
  const urdf = readFileSync(join(dir, `${name}.urdf`), 'utf8');
  const hingeZ = Number(/<joint name="opening"[\s\S]*?<origin xyz="\S+ \S+ (\S+)"/.exec(urdf)[1]);
  const rgba = (link) =>
    /rgba="([^"]+)"/
      .exec(urdf.slice(urdf.indexOf(`<link name="${link}"`)))?.[1]
      .split(' ')
      .map(Number) ?? [0.6, 0.6, 0.65, 1];
  const parts = ['body', 'jaw_left', 'jaw_right']
    .filter((p) => readdirSync(dir).includes(`${name}_${p}.obj`))
    .map((p) => ({
      name: p,
      link: ['body', 'jaw_left', 'jaw_right'].indexOf(p),
      rgba: rgba(p),
      mesh: readObj(join(dir, `${name}_${p}.obj`)),
    }));
  return make(
    name,
    about.title,
    about.clip.kind,
    about.clip.blade_length_mm,
    about.clip.closing_force_N,
    [0, 0, hingeZ],
    parts,
    existsSync(join(dir, 'picture.svg')) ? readFileSync(join(dir, 'picture.svg'), 'utf8') : drawing(name),
  );
}

function plateClip(name, blade) {
  const block = (x0, x1, z0, z1) => {
    const v = [];
    const f = [];
    for (const x of [x0, x1]) for (const y of [-0.6, 0.6]) for (const z of [z0, z1]) v.push(x, y, z);
    for (const q of [
      [0, 1, 3, 2],
      [4, 6, 7, 5],
      [0, 4, 5, 1],
      [2, 3, 7, 6],
      [0, 2, 6, 4],
      [1, 5, 7, 3],
    ])
      f.push(q[0], q[1], q[2], q[0], q[2], q[3]);
    return { positions: Float32Array.from(v), indices: Uint32Array.from(f) };
  };
  const rgba = name.startsWith('temporary') ? [0.85, 0.66, 0.25, 1] : [0.62, 0.64, 0.68, 1];
  const parts = [
    { name: 'coil', link: 0, rgba, mesh: block(-1.3, 1.3, blade + 4, blade + 7) },
    { name: 'jaw_a', link: 1, rgba, mesh: block(0, 0.7, 0, blade + 5) },
    { name: 'jaw_b', link: 2, rgba, mesh: block(-0.7, 0, 0, blade + 5) },
  ];
  return make(
    name,
    `${name.replace('_', ' ')}, blade ${blade} mm`,
    name.startsWith('temporary') ? 'temporary' : name === 'mini' ? 'mini' : 'permanent',
    blade,
    1.5,
    [0, 0, (blade + 4) / 1000],
    parts,
    drawing(name),
  );
}

function make(name, title, kind, bladeMm, force, hinge, parts, picture) {
  return {
    id: `clip_${name}`,
    title,
    parts,
    picture,
    hinges: [
      { origin: hinge, axis: [0, 1, 0], multiplier: 1 },
      { origin: hinge, axis: [0, 1, 0], multiplier: -1 },
    ],
    properties: [
      { name: 'blade_length', value: bladeMm / 1000, unit: 'm', text: `${bladeMm} mm` },
      { name: 'closing_force', value: force, unit: 'N', text: `${force.toFixed(1)} N` },
    ],
    tags: [kind],
  };
}

const drawing = (name) =>
  `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 160 96"><path d="M20 44h90M20 52h90" ` +
  `stroke="${name.startsWith('temporary') ? '#d8a83c' : '#9aa0a8'}" stroke-width="6"/>` +
  `<circle cx="122" cy="48" r="14" fill="none" stroke="#9aa0a8" stroke-width="6"/></svg>`;
