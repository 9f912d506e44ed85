// SPDX-License-Identifier: GPL-3.0-or-later
// The first-use tour: each step ends only when it was done, and the tour goes on where it was left.
import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import type { Bundle } from '../src/bundle_types';
import { type Seen, steps } from '../src/tutorial/steps';
import { Tour } from '../src/tutorial/tour';

const still = (): Seen => ({
  distanceM: 0.2,
  sight: new THREE.Vector3(0, 0, 1),
  hands: [
    { tool: 'suction', p: new THREE.Vector3(), button: false },
    { tool: 'applier', p: new THREE.Vector3(), button: false },
  ],
  loads: 2,
});

const does: Record<string, (s: Seen) => void> = {
  zoom: (s) => (s.distanceM = 0.15),
  turn: (s) => s.sight.set(0.2, 0, 1).normalize(),
  right_hand: (s) => s.hands[1]!.p!.set(0.01, 0, 0),
  left_hand: (s) => s.hands[0]!.p!.set(0, 0.01, 0),
  button: (s) => (s.hands[1]!.button = true),
  exchange: (s) => (s.hands[0]!.tool = 'dissector'),
  choose: (s) => (s.loads = 3),
};

const tool = { id: 'a' };
const bundle = {
  hands: [
    { hand: 'left', tools: [tool, tool] },
    { hand: 'right', tools: [tool] },
  ],
  tools: [
    { id: 'applier', kind: 'clip_applier', hand: 'right' },
    { id: 'clip', kind: 'clip', hand: '' },
    { id: 'other_clip', kind: 'clip', hand: '' },
  ],
  commands: [{ id: 'applier', commands: [{ name: 'load', argument: 'clip id' }] }],
} as unknown as Bundle;

function memory() {
  let kept: string | null = null;
  return { getItem: () => kept, setItem: (_: string, v: string) => void (kept = v) };
}

describe('the tour', () => {
  it('ends each step by its own deed alone', () => {
    for (const step of steps)
      for (const [deed, act] of Object.entries(does)) {
        const now = still();
        act(now);
        expect(step.done(still(), now), `${step.id} by ${deed}`).toBe(step.id === deed);
      }
  });

  it('goes through all steps and is then over', () => {
    const tour = new Tour(memory());
    tour.begin(bundle);
    expect([tour.of, tour.fresh]).toEqual([7, true]);
    tour.enter();
    for (const { id } of steps) {
      expect(tour.step!.id).toBe(id);
      for (let k = 0; k < 5; k++) expect(tour.see(still()), 'nothing is done').toBe(false);
      const now = still();
      does[id]!(now);
      expect(tour.see(now)).toBe(true);
    }
    expect(tour.step).toBeNull();
  });

  it('can be left and goes on where it was, also in another visit', () => {
    const store = memory();
    const tour = new Tour(store);
    tour.begin(bundle);
    tour.enter();
    tour.see(still());
    const now = still();
    does.zoom!(now);
    tour.see(now);
    tour.leave();
    expect(tour.see(still())).toBe(false);
    const later = new Tour(store);
    later.begin(bundle);
    expect([later.fresh, later.begun, later.running]).toEqual([false, true, false]);
    later.enter();
    expect([later.step!.id, later.at]).toEqual(['turn', 1]);
  });

  it('wants a button that was held to be let go first', () => {
    const tour = new Tour({
      getItem: () => '{"offered":true,"done":["zoom","turn","right_hand","left_hand"]}',
      setItem: () => undefined,
    });
    tour.begin(bundle);
    tour.enter();
    const held = still();
    held.hands[0]!.button = true;
    expect(tour.see(held)).toBe(false);
    expect(tour.see(structuredCloneOf(held))).toBe(false);
    expect(tour.see(still())).toBe(false);
    const again = still();
    again.hands[0]!.button = true;
    expect(tour.see(again)).toBe(true);
  });

  it('goes on from the new tool when a tool was exchanged before its hand was moved', () => {
    const tour = new Tour({ getItem: () => '{"offered":true,"done":["zoom","turn"]}', setItem: () => undefined });
    tour.begin(bundle);
    tour.enter();
    tour.see(still());
    const exchanged = still();
    Object.assign(exchanged.hands[1]!, { tool: 'scissors', p: new THREE.Vector3(0.02, 0, 0) });
    expect(tour.see(exchanged), 'the new tool is elsewhere').toBe(false);
    const moved = structuredCloneOf(exchanged);
    moved.hands[1]!.p = new THREE.Vector3(0.03, 0, 0);
    expect(tour.see(moved)).toBe(true);
  });

  it('leaves out what a scene does not have, and survives what a browser may keep', () => {
    const bare = new Tour({ getItem: () => '{"done":[3,"nothing"],"offered":"x"}', setItem: () => undefined });
    bare.begin({ ...bundle, tools: [], commands: [], hands: [] });
    expect([bare.of, bare.fresh, bare.begun]).toEqual([2, true, false]);
    expect(new Tour({ getItem: () => '{', setItem: () => undefined }).fresh).toBe(true);
    expect(new Tour(null).fresh).toBe(true);
  });
});

const structuredCloneOf = (s: Seen): Seen => ({ ...s, hands: s.hands.map((h) => ({ ...h })) });
