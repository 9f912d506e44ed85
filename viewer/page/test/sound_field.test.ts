// SPDX-License-Identifier: GPL-3.0-or-later
// What the sounds take from the field: hits of instruments, and what a suction tube draws.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import type { Bundle, ToolData } from '../src/bundle_types';
import { parseContactSides } from '../src/contact_sides';
import type { RenderFrame } from '../src/lcm';
import { Impacts, strengthOf } from '../src/sound/impacts';
import { below, Surroundings } from '../src/sound/surroundings';
import { hitOf } from '../src/sound/table';
import { parseDrawables, parseMaterials } from '../src/step_data/declarations';

const tool = (index: number, kind = 'probe') => ({ index, id: `t${index}`, kind }) as unknown as ToolData;

const sides = ['steel', 'steel', 'titanium', 'bone', 'cortex', 'practice_part'].map((material, number) => ({
  ...{ number, owner: number < 3 ? `t${number}` : `still${number}`, material },
  ...{ kind: 'x', role: number < 3 ? 'instrument' : 'fixed' },
}));
const [bone, cortex, plastic] = [3, 4, 5];
const materials = parseMaterials({ blood: { style: 'fluid' }, cortex: { style: 'tissue' } });
const scene = { tools: [tool(0), tool(1), tool(2)], contactSides: parseContactSides(sides), materials };

const place = (index: number, x: number, z: number, more = {}) => ({
  ...{ index, hand: index, state: 1, q: Float64Array.from([1, 0, 0, 0]), activity: 0 },
  p_m: Float64Array.from([x, 0, z]),
  ...more,
});

interface Touch {
  at: number[];
  between: [number, number];
  force?: number;
}

const frame = (k: number, tools: ReturnType<typeof place>[], touches: Touch[] = []) => ({
  sim_time_s: k / 60,
  tool: tools,
  contact_N: Float32Array.from(touches.map((t) => t.force ?? 0.05)),
  contact_x_m: Float32Array.from(touches.flatMap((t) => t.at)),
  contact_side: Int16Array.from(touches.flatMap((t) => t.between)),
});

/** Comes down on the face at z = 1 mm with 60 mm/s, and rests there. */
function comeDown(impacts: Impacts, on: number, { from = 0, force = 0.05, hand = 0 } = {}) {
  const found = [];
  for (let k = 0; k < 12; k++) {
    const z = Math.max(0.001, 0.006 - 0.001 * k);
    const touch: Touch = { at: [0, 0, 0.001], between: k % 2 ? [0, on] : [on, 0], force };
    found.push(...impacts.read(frame(from + k, [place(0, 0, z, { hand })], z <= 0.001 ? [touch] : [])));
  }
  return found;
}

/** Two tools meet at 60 mm/s. */
function meet(impacts: Impacts, more: (k: number) => object = () => ({})) {
  const found = [];
  for (let k = 0; k < 8; k++) {
    const x = Math.min(-0.004, -0.009 + 0.001 * k);
    const touches: Touch[] = x >= -0.0041 ? [{ at: [-0.002, 0, 0.02], between: [1, 0] }] : [];
    found.push(...impacts.read(frame(k, [place(0, x, 0), place(1, 0, 0, more(k))], touches)));
  }
  return found;
}

describe('hits of instruments', () => {
  it('are heard once when bone is touched, and say how fast', () => {
    const found = comeDown(new Impacts(scene), bone);
    expect(found.length).toBe(1);
    expect(found[0]!.what).toBe('bone');
    expect(found[0]!.speed).toBeCloseTo(0.06, 3);
    expect(found[0]!.strength).toBeCloseTo(strengthOf(0.06), 3);
  });

  it('sound by the materials of both sides', () => {
    const on = (side: number) => comeDown(new Impacts(scene), side).map((f) => f.what);
    expect([on(bone), on(cortex), on(plastic), on(2)]).toEqual([['bone'], ['soft'], ['polymer'], ['metal']]);
    expect(hitOf('bone', 'cortex', materials)).toBe('soft');
    expect(hitOf('cortex', 'skin', materials)).toBeNull();
    // A tool on a cotton patty touches the cortex below it, since the patty carries no load.
    expect(hitOf('steel', 'cotton', materials)).toBe(hitOf('steel', 'cortex', materials));
    expect(hitOf('constructor', 'steel', materials)).toBe('polymer');
  });

  it('are not heard without force, of a side that the scene has not, or of what no hand holds', () => {
    expect(comeDown(new Impacts(scene), bone, { force: 0.001 })).toEqual([]);
    expect(comeDown(new Impacts(scene), -1)).toEqual([]);
    expect(comeDown(new Impacts(scene), 99)).toEqual([]);
    expect(comeDown(new Impacts(scene), bone, { hand: -1 })).toEqual([]);
  });

  it('are heard again after the tool was taken away, and not while contacts flicker', () => {
    const impacts = new Impacts(scene);
    comeDown(impacts, bone);
    const flicker = [12, 13, 14, 15].flatMap((k) =>
      impacts.read(frame(k, [place(0, 0, 0.001)], k % 2 ? [{ at: [0, 0, 0.001], between: [0, bone] }] : [])),
    );
    expect(flicker).toEqual([]);
    expect(comeDown(impacts, bone, { from: 40 }).length).toBe(1);
  });

  it('of two instruments are heard once', () => {
    const found = meet(new Impacts(scene));
    expect(found.map((f) => f.what)).toEqual(['metal']);
    expect(found[0]!.speed).toBeCloseTo(0.06, 3);
  });

  it('of a tool on what it holds are not heard, nor just after it was let go', () => {
    expect(meet(new Impacts(scene), (k) => (k < 7 ? { hand: 0 } : { hand: -1, state: 2 }))).toEqual([]);
  });

  it('say nothing about speed over a gap in time', () => {
    const impacts = new Impacts(scene);
    impacts.read(frame(0, [place(0, 0, 0.03)]));
    const touch: Touch = { at: [0, 0, 0.001], between: [0, bone] };
    expect(impacts.read(frame(60, [place(0, 0, 0.001)], [touch]))).toEqual([]);
  });

  it('begin anew after a reset', () => {
    const impacts = new Impacts(scene);
    comeDown(impacts, bone, { from: 100 });
    expect(comeDown(impacts, bone).length).toBe(1);
  });
});

describe('the sides of contacts', () => {
  it('are in the order of their numbers, or the scene is refused', () => {
    expect(parseContactSides(undefined)).toEqual([]);
    expect(() => parseContactSides({})).toThrow(/no list/);
    expect(() => parseContactSides([{ number: 1, owner: 'a' }])).toThrow(/contact side 0/);
    expect(() => parseContactSides([{ number: 0, owner: 'a' }, null])).toThrow(/contact side 1/);
  });
});

describe('what a suction tube draws', () => {
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
