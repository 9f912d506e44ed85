// SPDX-License-Identifier: GPL-3.0-or-later
// Where a vessel lies in the fissure, and what the case builder tells of a place (tools/case_builder/pose_view.h).
import { Quaternion, Vector3 } from 'three';
import { number, object, text } from '../../start/api';
import type { Point } from '../api';
import { type RetractorFacts, retractorFactsOf } from '../retractors/retractors';

/** A shift in mm, then a rotation vector in degrees. */
export type Pose = number[];

export interface PoseFacts {
  /** Of the built case. */
  pose: Pose;
  surfaces: string[];
  /** In the vessel's frame. */
  neck: Point;
  toSurgeon: Point;
  retractors: RetractorFacts | null;
}

export interface PoseAnswer {
  pose: Pose;
  /** Whether the lobes were parted for it. */
  parted: boolean;
  overlapMm: [string, number][];
  seenPct: number;
  hiddenPct: [string, number][];
  /** Of parted lobes: false if one would be crushed. */
  sound: boolean;
  /** Those that there are with the lobes parted. */
  surfaces: string[];
}

export interface PoseState {
  state: string;
  error: string;
  busy: boolean;
  facts: PoseFacts | null;
  answer: PoseAnswer | null;
}

const numbers = (value: unknown): number[] => (Array.isArray(value) ? value.map(number) : []);

const pointOf = (value: unknown): Point => {
  const [x, y, z] = numbers(value);
  return [x ?? 0, y ?? 0, z ?? 0];
};

const named = (value: unknown): [string, number][] =>
  Object.entries(object(value)).map(([name, v]) => [name, number(v)]);

function factsOf(value: unknown): PoseFacts | null {
  const f = object(value);
  if (!Array.isArray(f.surfaces)) return null;
  return {
    pose: numbers(f.pose),
    surfaces: f.surfaces.map(text),
    neck: pointOf(f.neck),
    toSurgeon: pointOf(f.to_surgeon),
    retractors: retractorFactsOf(f.retractors),
  };
}

function answerOf(value: unknown): PoseAnswer | null {
  const a = object(value);
  if (!Array.isArray(a.pose)) return null;
  return {
    pose: numbers(a.pose),
    parted: a.parted === true,
    overlapMm: named(a.overlap_mm),
    seenPct: number(a.seen_pct),
    hiddenPct: named(a.hidden_pct),
    sound: a.sound !== false,
    surfaces: Array.isArray(a.surfaces) ? a.surfaces.map(text) : [],
  };
}

export function poseStateOf(json: unknown): PoseState {
  const s = object(json);
  return {
    state: text(s.state),
    error: text(s.error),
    busy: s.busy === true,
    facts: factsOf(s.facts),
    answer: answerOf(s.answer),
  };
}

const degree = Math.PI / 180;

export function rotationOf(pose: Pose): Quaternion {
  const turn = new Vector3(pose[3], pose[4], pose[5]).multiplyScalar(degree);
  const angle = turn.length();
  return angle > 0 ? new Quaternion().setFromAxisAngle(turn.divideScalar(angle), angle) : new Quaternion();
}

/** Where a point of the vessel lies. */
export const placedAt = (pose: Pose, p: Point): Vector3 =>
  new Vector3(...p).applyQuaternion(rotationOf(pose)).add(new Vector3(pose[0], pose[1], pose[2]));

const rounded = (x: number): number => Math.round(1000 * x) / 1000 + 0;

/** The pose that turns the vessel so, and puts a point of it there. To a thousandth of a millimetre and a degree. */
export function poseFrom(turned: Quaternion, p: Point, at: Vector3): Pose {
  const q = turned.clone().normalize();
  if (q.w < 0) q.set(-q.x, -q.y, -q.z, -q.w);
  const axis = new Vector3(q.x, q.y, q.z);
  const sine = axis.length();
  const angle = 2 * Math.atan2(sine, q.w);
  const turn = sine > 0 ? axis.multiplyScalar(angle / sine / degree) : axis;
  const exact: Pose = [0, 0, 0, turn.x, turn.y, turn.z].map(rounded);
  const shift = at.clone().sub(placedAt(exact, p));
  return [...[shift.x, shift.y, shift.z].map(rounded), ...exact.slice(3)];
}

/** Whether an answer is to that pose, as far as it was written. */
export const samePose = (a: Pose, b: Pose): boolean => a.every((x, k) => Math.abs(x - (b[k] ?? NaN)) < 2e-3);

export interface Question {
  pose: Pose;
  parted: boolean;
}

export type Ask = (question: Question | null) => Promise<PoseState>;

const pauseMs = 80;

/** Asks one thing at a time. What is wanted meanwhile gives way to what is wanted later. */
export class PoseAsker {
  private wanted: Question | null = null;
  private running = false;
  private ended = false;

  constructor(
    private readonly ask: Ask,
    private readonly told: (state: PoseState) => void,
    private readonly failed: (e: unknown) => void,
  ) {}

  want(question: Question | null): void {
    this.wanted = question ?? this.wanted;
    if (!this.running) void this.run();
  }

  end(): void {
    this.ended = true;
  }

  private async run(): Promise<void> {
    this.running = true;
    try {
      while (!this.ended) {
        const question = this.wanted;
        this.wanted = null;
        const state = await this.ask(question);
        if (this.ended) break;
        this.told(state);
        if (state.state === 'failed' || (!this.wanted && state.state === 'ready' && !state.busy)) break;
        await new Promise((r) => setTimeout(r, pauseMs));
      }
    } catch (e) {
      this.failed(e);
    }
    this.running = false;
  }
}
