// SPDX-License-Identifier: GPL-3.0-or-later
// The next pose of the example for each hand, and how far the tool is from it: where to move, and how to turn the
// wrist. Nothing here knows an exercise; the poses come with the scene (docs/scene-bundle.md).
import * as THREE from 'three';
import type { Bundle, GuidePose } from './bundle_types';

/** The other hand comes first when its target is earlier in the example by more than this. */
const aheadS = 0.5;
/** A place where something is still to be done belongs to the nearest target of both hands within this, m. */
const placeM = 0.0035;
/** Such a target is to be reached within this, m. */
const undoneNearM = 0.001;

interface Target {
  tool: string;
  /** What the example has asked of that tool, "load", and with which argument; '': nothing. */
  command: string;
  argument: string;
  /** It counts as reached within these. */
  nearM: number;
  nearRad: number;
  timeS: number;
  p: THREE.Vector3;
  q: THREE.Quaternion;
  button1: boolean;
  button2: boolean;
}

export interface Axes {
  x: THREE.Vector3;
  y: THREE.Vector3;
  z: THREE.Vector3;
}

export interface Offset {
  distanceM: number;
  /** In the picture: to the right, up, to the viewer; metres. */
  right: number;
  up: number;
  out: number;
  /** Turns still to be made, radians: about the shaft, about the picture's upright axis, about its level axis. */
  roll: number;
  turn: number;
  tilt: number;
  angleRad: number;
}

/** What is between a tool's pose and its target. */
export function offsetOf(p: THREE.Vector3, q: THREE.Quaternion, target: Pick<Target, 'p' | 'q'>, axes: Axes): Offset {
  const d = target.p.clone().sub(p);
  const turn = target.q.clone().multiply(q.clone().invert());
  if (turn.w < 0) turn.set(-turn.x, -turn.y, -turn.z, -turn.w);
  const sine = Math.hypot(turn.x, turn.y, turn.z);
  const angleRad = 2 * Math.atan2(sine, turn.w);
  const vector = new THREE.Vector3(turn.x, turn.y, turn.z).multiplyScalar(sine > 1e-9 ? angleRad / sine : 2);
  const shaft = new THREE.Vector3(0, 0, 1).applyQuaternion(q);
  const roll = vector.dot(shaft);
  const rest = vector.clone().addScaledVector(shaft, -roll);
  return {
    distanceM: d.length(),
    right: d.dot(axes.x),
    up: d.dot(axes.y),
    out: d.dot(axes.z),
    roll,
    turn: rest.dot(axes.y),
    tilt: rest.dot(axes.x),
    angleRad,
  };
}

const reached = (p: THREE.Vector3, q: THREE.Quaternion, t: Target): boolean =>
  p.distanceTo(t.p) < t.nearM && 2 * Math.acos(Math.min(1, Math.abs(q.dot(t.q)))) < t.nearRad;

/** A hand that stays where it is for the next button need not be as exact again. */
const stillFactor = 2;

const targetOf = (g: GuidePose): Target => ({
  tool: g.tool,
  command: g.command,
  argument: g.argument,
  nearM: g.nearM,
  nearRad: g.nearRad,
  timeS: g.timeS,
  p: new THREE.Vector3(...g.p),
  q: new THREE.Quaternion(g.q[1], g.q[2], g.q[3], g.q[0]),
  button1: g.button1,
  button2: g.button2,
});

/** Targets of one hand in the order of the example. */
function targetsOf(poses: GuidePose[]): Target[] {
  const targets = poses.map(targetOf);
  for (const [k, t] of targets.entries()) {
    const before = targets[k - 1];
    if (!before || !reached(before.p, before.q, { ...t, nearM: 0.5 * t.nearM, nearRad: 0.5 * t.nearRad })) continue;
    t.nearM *= stillFactor;
    t.nearRad *= stillFactor;
  }
  return targets;
}

export class Guide {
  private targets: Target[][] = [[], []];
  private at = [0, 0];
  /** Whether the last target of a hand has been reached. */
  private done = [false, false];
  /** Targets at which something is still to be done. */
  private readonly undone = new Set<Target>();

  begin(bundle: Bundle): void {
    const poses = bundle.exercise?.guide ?? [];
    this.targets = [
      targetsOf(poses.filter((g) => g.hand === 'left')),
      targetsOf(poses.filter((g) => g.hand === 'right')),
    ];
    this.restart();
  }

  restart(): void {
    this.at = [0, 0];
    this.done = [false, false];
    this.undone.clear();
  }

  /** Tells at which places something is still to be done. */
  see(places: readonly THREE.Vector3[]): void {
    this.undone.clear();
    const all = this.targets.flat();
    for (const place of places) {
      const nearest = all.reduce<Target | null>(
        (a, b) => (a && a.p.distanceTo(place) <= b.p.distanceTo(place) ? a : b),
        null,
      );
      if (nearest && nearest.p.distanceTo(place) < placeM) this.undone.add(nearest);
    }
  }

  /** Whether a hand is to stay at its target until something is done there. */
  stays(hand: number): boolean {
    const next = this.target(hand);
    return next !== null && this.undone.has(next.target);
  }

  /** How near a hand is to come to its target, m. */
  nearM(hand: number): number {
    const near = this.target(hand)?.target.nearM ?? 0;
    return this.stays(hand) ? Math.min(near, undoneNearM) : near;
  }

  /** Whether a hand has followed the example to its end. */
  ended(hand: number): boolean {
    return this.done[hand]!;
  }

  /** What the hand is to reach next, and which of how many; null: nothing. */
  target(hand: number): { target: Target; at: number; of: number } | null {
    const list = this.targets[hand] ?? [];
    const at = this.at[hand] ?? 0;
    return list[at] ? { target: list[at], at, of: list.length } : null;
  }

  /** Whether the example moves the other hand before this one reaches its target. */
  waits(hand: number): boolean {
    const mine = this.target(hand);
    const other = this.target(1 - hand);
    if (!other || this.ended(1 - hand)) return false;
    return !mine || other.target.timeS < mine.target.timeS - aheadS;
  }

  /** To another target, by hand. */
  step(hand: number, by: 1 | -1): void {
    const last = (this.targets[hand]?.length ?? 1) - 1;
    this.at[hand] = Math.max(0, Math.min(last, (this.at[hand] ?? 0) + by));
    this.done[hand] = false;
  }

  /**
   * Goes on when the tool is where it should be with its buttons as they should be. No pose is passed over: sweeps come
   * near much later poses on their way. No target is left while something is still to be done there.
   */
  follow(hand: number, p: THREE.Vector3, q: THREE.Quaternion, buttons: { button1: boolean; button2: boolean }): void {
    const at = this.at[hand] ?? 0;
    const t = this.targets[hand]?.[at];
    if (!t || this.undone.has(t)) return;
    if (t.button1 !== buttons.button1 || t.button2 !== buttons.button2 || !reached(p, q, t)) return;
    if (at + 1 < this.targets[hand]!.length) this.at[hand] = at + 1;
    else this.done[hand] = true;
  }
}
