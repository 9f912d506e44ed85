// SPDX-License-Identifier: GPL-3.0-or-later
// The instructor's pencil and pointer: what is sent, when, and at which depth.
import * as THREE from 'three';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Drawing } from '../src/room/messages';
import { depthWaitMs, Pencil, sendEveryMs } from '../src/room/pencil';

/** A picture of 200 by 100 pixels, 1 m in front of a camera that looks along -z, and a graphics card that waits. */
function desk() {
  const surface = Object.assign(new EventTarget(), {
    ...{ clientWidth: 200, clientHeight: 100, onpointerrawupdate: null },
    ...{ setPointerCapture: () => undefined, classList: { toggle: () => undefined } },
  });
  const camera = new THREE.PerspectiveCamera(90, 2, 0.01, 10);
  camera.updateMatrixWorld();
  const asked: ((at: THREE.Vector3 | null) => void)[] = [];
  const sent: Drawing[] = [];
  const sight = {
    camera,
    focus: () => new THREE.Vector3(0, 0, -1),
    pick: () => new Promise<THREE.Vector3 | null>((tell) => asked.push(tell)),
  };
  const pencil = new Pencil(surface as unknown as HTMLElement, sight, (m) => sent.push(m));
  const pen = (kind: string, offsetX: number, offsetY: number) =>
    surface.dispatchEvent(Object.assign(new Event(kind), { offsetX, offsetY, button: 0, pointerId: 1 }));
  const answer = async (z: number) => {
    asked.shift()!(new THREE.Vector3(0, 0, z));
    await vi.advanceTimersByTimeAsync(0);
  };
  return { pencil, pen, asked, sent, answer };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());
const pass = (ms: number) => vi.advanceTimersByTimeAsync(ms);

describe('the pointer', () => {
  it('is sent at once, and again at its own depth', async () => {
    const { pencil, pen, asked, sent, answer } = desk();
    pen('pointerrawupdate', 50, 50);
    expect(sent).toEqual([]);
    pencil.set('point');
    pen('pointerrawupdate', 50, 50);
    expect(sent).toEqual([{ kind: 'point', at: [-1, 0, -1] }]);
    await answer(-1); // of the middle, which is asked for at first
    await answer(-2);
    await pass(sendEveryMs);
    expect(sent.slice(1)).toEqual([{ kind: 'point', at: [-2, 0, -2] }]);
    expect(asked).toHaveLength(0);
  });

  it('is sent thirty times a second, with the place where it stopped', async () => {
    const { pencil, pen, asked, sent } = desk();
    pencil.set('point');
    for (let k = 0; k < 100; k++) {
      pen('pointerrawupdate', 100 + k, 50);
      await pass(1);
    }
    await pass(sendEveryMs);
    expect(sent.length).toBeGreaterThanOrEqual(3);
    expect(sent.length).toBeLessThanOrEqual(5);
    expect(sent.at(-1)).toEqual({ kind: 'point', at: [1.98, 0, -1] });
    expect(asked, 'one question at a time').toHaveLength(1);
    pencil.set('off');
    await pass(1000);
    expect(sent.length).toBeLessThanOrEqual(5);
  });
});

describe('a stroke', () => {
  async function drawing() {
    const all = desk();
    all.pencil.set('draw');
    await all.answer(-1); // of the middle, which is asked for at first
    return all;
  }

  it('lies at the depth under its beginning', async () => {
    const { pen, sent, answer } = await drawing();
    pen('pointerdown', 50, 50);
    pen('pointerrawupdate', 150, 50);
    pen('pointerup', 150, 50);
    expect(sent).toEqual([]);
    await answer(-3);
    expect(sent).toMatchObject([
      {
        kind: 'stroke',
        points: [
          [-3, 0, -3],
          [3, 0, -3],
        ],
      },
    ]);
  });

  it('does not wait long for its depth', async () => {
    const { pen, sent, answer } = await drawing();
    pen('pointerdown', 50, 50);
    await pass(depthWaitMs);
    expect(sent).toMatchObject([{ kind: 'stroke', points: [[-1, 0, -1]] }]);
    await answer(-3);
    pen('pointerrawupdate', 150, 50);
    await pass(sendEveryMs);
    expect(sent[1]).toMatchObject({ kind: 'stroke', points: [[1, 0, -1]] });
    expect(sent).toHaveLength(2);
  });

  it('is sent as it is drawn when the pen came over the picture, and asks for nothing', async () => {
    const { pen, asked, sent, answer } = await drawing();
    pen('pointerrawupdate', 50, 50);
    expect(sent, 'a pen in the air draws nothing').toEqual([]);
    await answer(-3);
    pen('pointerdown', 52, 50);
    expect(sent).toMatchObject([{ kind: 'stroke', points: [[-2.88, 0, -3]] }]);
    await pass(sendEveryMs);
    pen('pointerrawupdate', 150, 50);
    expect(sent[1]).toMatchObject({ kind: 'stroke', points: [[3, 0, -3]] });
    expect(asked).toHaveLength(0);
  });

  it('keeps its own depth when the next one begins early', async () => {
    const { pen, sent, answer } = await drawing();
    pen('pointerdown', 50, 50);
    pen('pointerup', 50, 50);
    pen('pointerdown', 150, 50);
    await answer(-2);
    await answer(-3);
    const strokes = sent.filter((m) => m.kind === 'stroke');
    expect(strokes.map((s) => s.points)).toEqual([[[-1, 0, -1]], [[3, 0, -3]]]);
    expect(new Set(strokes.map((s) => s.id)).size).toBe(2);
  });
});
