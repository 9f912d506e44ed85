// SPDX-License-Identifier: GPL-3.0-or-later
// What an empty instrument can take back: the place is learnt while it holds the thing, and the distance and the turn
// are those of geometry.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import type { Bundle, ToolData } from '../src/bundle_types';
import type { RenderFrame } from '../src/lcm';
import { TakeBack, takeBackText } from '../src/take_back';

type FrameTool = RenderFrame['tool'][number];

const reach = [
  { name: 'reach', text: '4 mm', value: 0.004 },
  { name: 'alignment', text: '40 deg', value: (40 * Math.PI) / 180 },
];
const tool = (index: number, id: string, hand: string, kind: string, properties = reach): ToolData =>
  ({ index, id, hand, kind, title: `The ${id}`, properties, hinges: [], parts: [], picture: null, tags: [] }) as never;

const bundle = (properties = reach): Bundle =>
  ({
    tools: [
      tool(0, 'applier', 'right', 'applier', properties),
      tool(1, 'long', 'none', 'clip'),
      tool(2, 'short', 'none', 'clip'),
    ],
    commands: [
      {
        id: 'applier',
        element: 'applier',
        commands: [{ name: 'load', doc: '', argument: 'clip id', min: 0, max: 0, start: null, usual: null }],
      },
    ],
  }) as never;

const at = (index: number, state: number, hand: number, p: THREE.Vector3, q = new THREE.Quaternion()): FrameTool =>
  ({ index, state, hand, p_m: Float64Array.from(p.toArray()), q: Float64Array.from([q.w, q.x, q.y, q.z]) }) as never;

const v = (x: number, y: number, z: number) => new THREE.Vector3(x, y, z);
const about = (axis: THREE.Vector3, angle: number) => new THREE.Quaternion().setFromAxisAngle(axis, angle);

describe('taking back', () => {
  const z = v(0, 0, 1);
  /** The applier held the long clip, with the clip 12 mm before its tip. */
  const taught = (b = bundle()) => {
    const t = new TakeBack();
    t.begin(b);
    const held = t.nearest({
      tool: [at(0, 1, 1, v(0.1, 0, 0)), at(1, 1, 1, v(0.1, 0, -0.012)), at(2, 0, -1, v(0, 0, 0))],
    });
    expect(held).toBeNull();
    return t;
  };

  it('knows how far the clip is and how it is turned', () => {
    const t = taught();
    // The clip lies at (0, 0, 0), turned a quarter about x: it would be held 12 mm from it along -y.
    const turned = about(v(1, 0, 0), Math.PI / 2);
    const grip = v(0, 0, 0.012).applyQuaternion(turned);
    const applier = at(0, 1, 1, grip.clone().add(v(0.003, 0, 0)), turned.clone().multiply(about(z, 0.2)));
    const near = t.nearest({ tool: [applier, at(1, 2, -1, v(0, 0, 0), turned)] })!;
    expect(near.distanceM).toBeCloseTo(0.003, 9);
    expect(near.angleRad).toBeCloseTo(0.2, 6);
    expect(near.place.distanceTo(grip)).toBeLessThan(1e-9);
    expect([near.hand, near.taken, near.tool.id]).toEqual([1, true, 'long']);
    expect(takeBackText(near)).toBe('The long: 3.0 mm away, turned by 11°; button 2 (B) takes it back');
  });

  it('counts the other side of the clip, and says what is out of reach', () => {
    const t = taught();
    const clip = at(1, 2, -1, v(0, 0, -0.012));
    const other = t.nearest({ tool: [at(0, 1, 1, v(0, 0, 0), about(z, Math.PI - 0.1)), clip] })!;
    expect([other.angleRad, other.taken]).toEqual([expect.closeTo(0.1, 6), true]);
    expect(t.nearest({ tool: [at(0, 1, 1, v(0.0041, 0, 0)), clip] })!.taken).toBe(false);
    const askew = t.nearest({ tool: [at(0, 1, 1, v(0, 0, 0), about(v(1, 0, 0), 0.8)), clip] })!;
    expect([askew.taken, takeBackText(askew)]).toEqual([false, 'The long: 0.0 mm away, turned by 46°; out of reach']);
  });

  it('says nothing of what it never held, of a loaded instrument, and of one on the tray', () => {
    const t = taught();
    const clip = at(1, 2, -1, v(0, 0, -0.012));
    expect(t.nearest({ tool: [at(0, 1, 1, v(0, 0, 0)), at(2, 2, -1, v(0, 0, 0))] })).toBeNull();
    expect(t.nearest({ tool: [at(0, 0, 1, v(0, 0, 0)), clip] })).toBeNull();
    expect(t.nearest({ tool: [at(0, 1, 1, v(0, 0, 0)), clip, at(2, 1, 1, v(0, 0, 0))] })).toBeNull();
  });

  it('gives no verdict for an instrument that does not tell its reach', () => {
    const near = taught(bundle([])).nearest({ tool: [at(0, 1, 1, v(0, 0, 0)), at(1, 2, -1, v(0, 0, -0.012))] })!;
    expect([near.taken, takeBackText(near)]).toEqual([null, 'The long: 0.0 mm away, turned by 0°']);
  });
});
