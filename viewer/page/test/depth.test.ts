// SPDX-License-Identifier: GPL-3.0-or-later
// Depth on a flat screen, on shapes whose answer is known: the way to the tissue, the scale's strokes, the gauge
// between two tips, and which contacts are marked.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { contactsOfTools, leastN, markCount, markRadius } from '../src/contact_marks';
import { nearestPair, rulerPlace, rulerStrokes, rulerWay } from '../src/depth_ruler';
import { depthText } from '../src/hud/hand_panel';
import { levels } from '../src/quality';
import { TissueProbe } from '../src/tissue_probe';

const v = (x: number, y: number, z: number) => new THREE.Vector3(x, y, z);
const axes = { x: v(1, 0, 0), y: v(0, 1, 0), z: v(0, 0, 1) };

describe('the way to the tissue', () => {
  const n = 41;
  const places = Array.from({ length: n * n }, (_, i) => [0.001 * ((i % n) - 20), 0.001 * (Math.floor(i / n) - 20), 0]);
  const plane = new TissueProbe(
    Float32Array.from(places.flat()),
    Float32Array.from(places.flatMap(() => [0, 0, 1])),
    null,
  );

  it('of a slanting tool is its height over the cosine', () => {
    const slant = v(Math.sin(0.6), 0, -Math.cos(0.6));
    const along = plane.along(v(-0.005, 0.0013, 0.009), slant, 0.03)!;
    expect(Math.abs(along - 0.009 / Math.cos(0.6))).toBeLessThan(0.0001);
    expect(plane.along(v(0, 0, 0.009), v(0, 0, -1), 0.008)).toBeNull();
    expect(plane.along(v(0, 0, 0.004), v(1, 0, 0), 0.03)).toBeNull();
    expect(plane.along(v(0, 0, -0.001), v(0, 0, -1), 0.03)).toBe(0);
  });

  it('to a ball is that of geometry', () => {
    const r = 0.006;
    const points: number[] = [];
    const normals: number[] = [];
    for (let k = 0; k < 3000; k++) {
      // A spiral spreads points evenly over a ball.
      const z = 1 - (2 * k + 1) / 3000;
      const a = k * Math.PI * (3 - Math.sqrt(5));
      const d = v(Math.sqrt(1 - z * z) * Math.cos(a), Math.sqrt(1 - z * z) * Math.sin(a), z);
      normals.push(...d.toArray());
      points.push(...d.multiplyScalar(r).toArray());
    }
    const ball = new TissueProbe(Float32Array.from(points), Float32Array.from(normals), null);
    for (const beside of [0, 0.003]) {
      const along = ball.along(v(beside, 0, 0.02), v(0, 0, -1), 0.03)!;
      expect(Math.abs(along - (0.02 - Math.sqrt(r * r - beside * beside)))).toBeLessThan(0.0002);
    }
    expect(ball.along(v(0.0065, 0, 0.02), v(0, 0, -1), 0.03)).toBeNull();
  });
});

describe('the ruler', () => {
  const place = { origin: v(0, 0, 0.01), along: v(0, 0, -1), side: v(1, 0, 0), scale: 1 };

  it('has a tick each millimetre, a long one at five, and ends at the tissue', () => {
    const points = rulerStrokes(place, 0.0063);
    const strokes = Array.from({ length: points.length / 6 }, (_, k) => points.slice(6 * k, 6 * k + 6));
    expect(strokes).toHaveLength(1 + 6 + 1);
    expect(strokes[0]![5]).toBeCloseTo(0.01 - 0.0063, 12);
    const ticks = strokes.slice(1, 7);
    ticks.forEach((t, k) => expect(t[2]).toBeCloseTo(0.01 - 0.001 * (k + 1), 12));
    const widths = ticks.map((t) => t[3]! - t[0]!);
    expect(widths[4]).toBeGreaterThan(2 * widths[3]!);
    expect(new Set([0, 1, 2, 3, 5].map((k) => widths[k])).size).toBe(1);
    // No tick lies below the tissue, and none on the stroke at the end.
    expect(rulerStrokes(place, 0.005)).toHaveLength(6 * (1 + 4 + 1));
  });

  it('goes along the tool from its tip, or hangs in the picture beside it', () => {
    const shaft = v(0, 0.6, 0.8);
    const tool = rulerPlace('tool', v(0, 0, 0), shaft, axes, 0.001, 0.03);
    expect(tool.along.dot(shaft)).toBeCloseTo(-1, 12);
    expect(tool.side.dot(shaft)).toBeCloseTo(0, 12);
    expect(tool.side.dot(axes.z)).toBeCloseTo(0, 12);
    const sight = rulerPlace('sight', v(0, 0, 0), shaft, axes, 0.001, 0.03);
    expect(sight.along.dot(axes.z)).toBeCloseTo(0, 12);
    expect(sight.origin.toArray()).toEqual([0.006, 0, 0]);
    expect(rulerWay('tool', shaft, v(0, 0, -1)).dot(shaft)).toBeCloseTo(-1, 12);
    expect(rulerWay('sight', shaft, v(0, 0, -1)).toArray()).toEqual([0, 0, -1]);
    // In a picture of 20 mm it is drawn shorter, with all of its millimetres.
    const small = rulerPlace('sight', v(0, 0, 0), shaft, axes, 0.0002, 0.03);
    expect([sight.scale, small.scale]).toEqual([1, expect.closeTo(0.24, 9)]);
    const strokes = rulerStrokes(small, 0.03);
    expect(strokes[4]! - strokes[1]!).toBeCloseTo(-0.0072, 9);
    expect(strokes).toHaveLength(6 * (1 + 29 + 1));
    // A tool along the line of sight still has a side for its ticks.
    expect(rulerPlace('tool', v(0, 0, 0), axes.z, axes, 0.001, 0.03).side.length()).toBeCloseTo(1, 12);
  });

  it('gauges the nearest points of two tools', () => {
    const pair = nearestPair([v(0, 0, 0), v(0.002, 0, 0)], [v(0.007, 0, 0), v(0.01, 0, 0)])!;
    expect(pair[0].distanceTo(pair[1])).toBeCloseTo(0.005, 12);
    expect(nearestPair([v(0, 0, 0)], [])).toBeNull();
  });

  it('is told in words beside the hand', () => {
    const depth = { tip_mm: [2.3, 0.1], ruler_mm: 6.28, apart_mm: 5.04 };
    expect(depthText(depth, 1, 1)).toBe('tip contact · ruler 6.3 mm · tips 5.0 mm apart');
    expect(depthText(depth, 0, 1)).toBe('tip 2.5 mm');
    expect(depthText({ tip_mm: [], ruler_mm: null, apart_mm: null }, 0, 0)).toBe('');
  });
});

describe('marks of contact', () => {
  const frame = (contacts: [number, number, number, number][]) => ({
    contact_x_m: Float32Array.from(contacts.flatMap((c) => c.slice(0, 3))),
    contact_N: Float32Array.from(contacts.map((c) => c[3])),
  });
  const tool = [{ tip: v(0, 0, 0), shaft: v(0, 0, 1) }];

  it('lie where a tool presses, tip and shaft, the strongest first, and nowhere else', () => {
    const marks = contactsOfTools(
      frame([
        [0.001, 0, 0, 0.1],
        [0.02, 0, 0, 5],
        [0, 0.002, 0.03, 0.4],
        [0, 0, 0, leastN / 2],
      ]),
      tool,
    );
    expect(marks.map((m) => Number(m.forceN.toFixed(3)))).toEqual([0.4, 0.1]);
    expect(marks[0]!.place.z).toBeCloseTo(0.03, 6);
    expect(contactsOfTools(frame([[0, 0, 0, 1]]), [])).toEqual([]);
    const many = Array.from({ length: 20 }, (): [number, number, number, number] => [0, 0, 0, 1]);
    expect(contactsOfTools(frame(many), tool)).toHaveLength(markCount);
  });

  it('grow with the force', () => {
    expect(markRadius(0.2)).toBeGreaterThan(markRadius(0.05));
    expect(markRadius(3)).toBe(markRadius(1));
  });
});

describe('every quality level', () => {
  it('has the shadow of the tools', () => {
    for (const l of levels) expect(l.shadowSize).toBeGreaterThanOrEqual(512);
  });
});
