// SPDX-License-Identifier: GPL-3.0-or-later
// What the sounds take from the field: hits of instruments on bone and on each other, and what a suction tube draws.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import type { Bundle, MeshData, ToolData } from '../src/bundle_types';
import type { RenderFrame } from '../src/lcm';
import { Impacts, strengthOf } from '../src/sound/impacts';
import { Solid } from '../src/sound/solids';
import { below, Surroundings } from '../src/sound/surroundings';
import { parseDrawables, parseMaterials } from '../src/step_data/declarations';

function block(x: number, y: number, z: number): MeshData {
  const g = new THREE.BoxGeometry(x, y, z);
  const positions = g.getAttribute('position').array as Float32Array;
  return { positions, indices: Uint32Array.from(g.getIndex()!.array) };
}

/** A shaft of 4 x 4 x 60 mm whose tip is its origin. */
function tool(index: number, kind = 'probe'): ToolData {
  const mesh = block(0.004, 0.004, 0.06);
  for (let i = 2; i < mesh.positions.length; i += 3) mesh.positions[i]! += 0.03;
  const part = {
    ...mesh,
    name: 'shaft',
    link: 0,
    rgba: [1, 1, 1, 1] as [number, number, number, number],
    material: '',
  };
  return { index, id: `t${index}`, kind, hand: 'left', hinges: [], parts: [part] } as unknown as ToolData;
}

const bone = { id: 'rim', material: 'bone', ...block(0.02, 0.02, 0.002) };
const scene = (material = 'bone') => ({ tools: [tool(0), tool(1), tool(2)], static: [{ ...bone, material }] });

const place = (index: number, x: number, z: number, more = {}) => ({
  ...{ index, hand: index, state: 1, q: Float64Array.from([1, 0, 0, 0]), opening_rad: 0, activity: 0 },
  p_m: Float64Array.from([x, 0, z]),
  ...more,
});

const frame = (k: number, tools: ReturnType<typeof place>[], contacts: number[][] = [], force = 0.05) => ({
  sim_time_s: k / 60,
  tool: tools,
  contact_N: Float32Array.from(contacts.map(() => force)),
  contact_x_m: Float32Array.from(contacts.flat()),
});

/** Comes down on the bone's face at z = 1 mm with 60 mm/s, and rests there. */
function comeDown(impacts: Impacts, from = 0, contact = [0, 0, 0.001], force = 0.05) {
  const found = [];
  for (let k = 0; k < 12; k++) {
    const z = Math.max(0.001, 0.006 - 0.001 * k);
    found.push(...impacts.read(frame(from + k, [place(0, 0, z)], z <= 0.001 ? [contact] : [], force)));
  }
  return found;
}

describe('hits of instruments', () => {
  it('are heard once when bone is touched, and say how fast', () => {
    const found = comeDown(new Impacts(scene()));
    expect(found.length).toBe(1);
    expect(found[0]!.partner).toBe('bone');
    expect(found[0]!.speed).toBeCloseTo(0.06, 3);
    expect(found[0]!.strength).toBeCloseTo(strengthOf(0.06), 3);
  });

  it('are not heard on soft material, beside the bone, or without force', () => {
    expect(comeDown(new Impacts(scene('skin')))).toEqual([]);
    expect(comeDown(new Impacts(scene()), 0, [0, 0, 0.02])).toEqual([]);
    expect(comeDown(new Impacts(scene()), 0, [0, 0, 0.001], 0.001)).toEqual([]);
  });

  it('are heard again after the tool was taken away, and not while contacts flicker', () => {
    const impacts = new Impacts(scene());
    comeDown(impacts);
    const flicker = [12, 13, 14, 15].flatMap((k) =>
      impacts.read(frame(k, [place(0, 0, 0.001)], k % 2 ? [[0, 0, 0.001]] : [])),
    );
    expect(flicker).toEqual([]);
    expect(comeDown(impacts, 40).length).toBe(1);
  });

  it('of two instruments are heard where both surfaces are', () => {
    const impacts = new Impacts(scene('skin'));
    const found = [];
    for (let k = 0; k < 8; k++) {
      const x = Math.min(-0.004, -0.009 + 0.001 * k);
      const meet = x >= -0.0041 ? [[-0.002, 0, 0.02]] : [];
      found.push(...impacts.read(frame(k, [place(0, x, 0), place(1, 0, 0)], meet)));
    }
    expect(found.map((f) => f.partner)).toEqual(['instrument']);
    expect(found[0]!.speed).toBeCloseTo(0.06, 3);
  });

  it('of a tool on what it holds are not heard, nor just after it was let go', () => {
    const impacts = new Impacts(scene('skin'));
    const meet = [[-0.002, 0, 0.02]];
    const held = { hand: 0 };
    const free = { hand: -1, state: 2 };
    const found = [0, 1, 2, 3].flatMap((k) =>
      impacts.read(frame(k, [place(0, -0.004 - 0.001 * (3 - k), 0), place(1, 0, 0, k < 3 ? held : free)], meet)),
    );
    expect(found).toEqual([]);
  });

  it('say nothing about speed over a gap in time', () => {
    const impacts = new Impacts(scene());
    impacts.read(frame(0, [place(0, 0, 0.03)]));
    expect(impacts.read(frame(60, [place(0, 0, 0.001)], [[0, 0, 0.001]]))).toEqual([]);
  });

  it('begin anew after a reset', () => {
    const impacts = new Impacts(scene());
    comeDown(impacts, 100);
    expect(comeDown(impacts, 0).length).toBe(1);
  });
});

describe('a solid', () => {
  it('is touched at its surface', () => {
    const s = new Solid(block(0.02, 0.02, 0.002));
    expect(s.touches(new THREE.Vector3(0.003, 0.004, 0.0014), 0.0005)).toBe(true);
    expect(s.touches(new THREE.Vector3(0.003, 0.004, 0.0016), 0.0005)).toBe(false);
    expect(s.touches(new THREE.Vector3(0.0105, 0, 0), 0.0006)).toBe(true);
  });
});

describe('what a suction tube draws', () => {
  const materials = parseMaterials({ blood: { style: 'fluid' } });
  const [declared] = parseDrawables([{ id: 'a.pool', kind: 'plane', material: 'blood' }]);
  const bundle = {
    tools: [tool(0, 'suction'), tool(1)],
    drawables: [{ declared: declared!, meshes: [] }],
    materials,
  } as unknown as Bundle;
  const pool = (height: number, radius = 0.02) => ({
    index: 0,
    data: Float32Array.from([0, 0, height, 0, 0, 1, radius, height]),
  });
  let now = 0;
  /** near: of a contact from the tip, m. */
  const at = (
    activity: number,
    height: number,
    { radius = 0.02, near = 1, surroundings = new Surroundings(bundle) } = {},
  ) =>
    surroundings.drawn({
      sim_time_s: (now += 0.1),
      tool: [place(0, 0, 0, { activity }), place(1, 0, 0, { activity: 1 })],
      drawable: [pool(height, radius)],
      contact_N: Float32Array.from([0.02]),
      contact_x_m: Float32Array.from([near, 0, 0]),
    } as unknown as RenderFrame);

  it('is nothing while it does not suck', () => {
    expect(at(0, 0.01)).toBeNull();
  });

  it('is fluid below a pool, air above it, and tissue where a contact lies on its rim', () => {
    expect(at(1, 0.005)).toBe('fluid');
    expect(at(1, -0.005)).toBe('air');
    expect(at(1, 0.005, { radius: 0 })).toBe('air');
    expect(at(1, -0.005, { near: 0.001 })).toBe('tissue');
    expect(at(1, -0.005, { near: 0.003 })).toBe('air');
  });

  it('is tissue for a moment after a contact, since contacts flicker', () => {
    const surroundings = new Surroundings(bundle);
    const heard = [0.001, 1, 1].map((near) => at(1, -0.005, { near, surroundings }));
    expect(heard).toEqual(['tissue', 'tissue', 'air']);
  });

  it('a place beside the pool is not in it', () => {
    expect(below(pool(0.01).data, new THREE.Vector3(0.01, 0, 0))).toBe(true);
    expect(below(pool(0.01).data, new THREE.Vector3(0.03, 0, 0))).toBe(false);
  });
});
