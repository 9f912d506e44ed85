// SPDX-License-Identifier: GPL-3.0-or-later
// A scale in the field: from a tool's tip down to the tissue, along the tool or along the line of sight, with a tick
// each millimetre and a number each five. Between the tips of both hands it is a gauge: how far they are apart.
import * as THREE from 'three';
import type { Sight } from './camera';
import { TextSprite } from './text_sprite';
import type { TissueProbe } from './tissue_probe';
import { fixed } from './languages/numbers';
import { text } from './languages/text';

export type RulerMode = 'off' | 'tool' | 'sight';
export const rulerModes: readonly RulerMode[] = ['off', 'tool', 'sight'];

/** Longest scale, and farthest tips that are gauged, m. */
export const rulerReachM = 0.04;
/** Beside the tip it takes no more of the picture's height than this, in hundredths. */
const hangingPercent = 36;
const tickM = 0.001;
const numbered = 5;
/** The search along the way is dear. */
const everyS = 1 / 10;
const mostPoints = 2 * (Math.round(rulerReachM / tickM) + 5);
const numbers = Math.floor(Math.round(rulerReachM / tickM) / numbered);
const colour = 0xfff2a8;
const letters = [1, 0.95, 0.66] as const;

export const millimetres = (m: number): string => `${fixed(1000 * m, 1)} mm`;

/**
 * Where the scale lies: it begins at `origin` and goes along the unit `along`; ticks lie along the unit `side`. scale:
 * how long a metre is drawn, m.
 */
export interface RulerPlace {
  origin: THREE.Vector3;
  along: THREE.Vector3;
  side: THREE.Vector3;
  scale: number;
}

/** Ends of the scale's strokes, three numbers a point: the scale, its ticks, and a broad stroke where it ends. */
export function rulerStrokes({ origin, along, side, scale }: RulerPlace, lengthM: number): number[] {
  const out: number[] = [];
  const point = (t: number, s: number) => {
    const p = origin
      .clone()
      .addScaledVector(along, t * scale)
      .addScaledVector(side, s);
    out.push(p.x, p.y, p.z);
  };
  point(0, 0);
  point(lengthM, 0);
  for (let k = 1; k * tickM < lengthM - 1e-9; k++) {
    point(k * tickM, 0);
    point(k * tickM, k % numbered === 0 ? 0.0012 : 0.0005);
  }
  point(lengthM, -0.0012);
  point(lengthM, 0.0012);
  return out;
}

/**
 * Along the tool: its own axis away from the hand. Along the line of sight nothing of a scale would be seen, so it
 * hangs down in the picture beside the tip, as long as the way is, or shorter where the picture is too small for that.
 */
export function rulerPlace(
  mode: 'tool' | 'sight',
  tip: THREE.Vector3,
  shaft: THREE.Vector3,
  axes: Sight['axes'],
  percentM: number,
  lengthM: number,
): RulerPlace {
  if (mode === 'sight')
    return {
      origin: tip.clone().addScaledVector(axes.x, 6 * percentM),
      along: axes.y.clone().negate(),
      side: axes.x,
      scale: Math.min(1, (hangingPercent * percentM) / Math.max(tickM, lengthM)),
    };
  const along = shaft.clone().negate();
  const side = along.clone().cross(axes.z);
  return { origin: tip, along, side: side.lengthSq() > 1e-6 ? side.normalize() : axes.x, scale: 1 };
}

/** The way on which the tissue is sought. */
export const rulerWay = (mode: 'tool' | 'sight', shaft: THREE.Vector3, sight: THREE.Vector3): THREE.Vector3 =>
  mode === 'tool' ? shaft.clone().negate() : sight;

/** The nearest two points of two sets; null: a set is empty. */
export function nearestPair(
  a: readonly THREE.Vector3[],
  b: readonly THREE.Vector3[],
): [THREE.Vector3, THREE.Vector3] | null {
  let best: [THREE.Vector3, THREE.Vector3] | null = null;
  for (const p of a) for (const q of b) if (!best || p.distanceTo(q) < best[0].distanceTo(best[1])) best = [p, q];
  return best;
}

export interface RulerInput extends Sight {
  mode: RulerMode;
  /** Of each hand: points that may touch first, scene frame; none: the hand holds nothing. */
  tips: readonly (readonly THREE.Vector3[])[];
  hand: number;
  /** Of the hand's tool, from the tip. */
  shaft: THREE.Vector3 | null;
  probes: readonly TissueProbe[];
  seconds: number;
}

export class DepthRuler {
  readonly root = new THREE.Group();
  /** From the tip to the tissue, m; null: no scale is shown, or no tissue lies within its reach. */
  lengthM: number | null = null;
  /** Between the tips of both hands, m; null: they are farther apart than the scale is long, or a hand is empty. */
  apartM: number | null = null;
  private readonly line: THREE.LineSegments;
  private readonly gauge: THREE.LineSegments;
  private readonly thin = new THREE.LineBasicMaterial({
    ...{ transparent: true, opacity: 0.9, depthTest: false, depthWrite: false, toneMapped: false },
    color: colour,
  });
  private readonly numbers = Array.from({ length: numbers }, () => new TextSprite(0.001, letters));
  private readonly end = new TextSprite(0.001, letters);
  private readonly apart = new TextSprite(0.001, letters);
  private askedAt = -1;
  private askedFor = '';

  constructor() {
    this.line = this.makeLine(mostPoints);
    this.gauge = this.makeLine(2);
    this.root.add(this.line, this.gauge);
    for (const n of [...this.numbers, this.end, this.apart]) this.root.add(n.sprite);
    this.numbers.forEach((n, k) => n.write(String(numbered * (k + 1))));
    this.root.visible = false;
  }

  update(input: RulerInput): void {
    const { mode, tips, hand, shaft } = input;
    const tip = middleOf(tips[hand] ?? []);
    this.root.visible = mode !== 'off' && tip !== null && shaft !== null;
    if (mode === 'off' || !tip || !shaft) {
      this.lengthM = this.apartM = null;
      return;
    }
    const sight = tip.clone().sub(input.eye).normalize();
    this.seek(input, tip, rulerWay(mode, shaft, sight));
    const place = rulerPlace(mode, tip, shaft, input.axes, input.percentM, this.lengthM ?? rulerReachM);
    this.drawScale(place, input);
    this.drawGauge(nearestPair(tips[0] ?? [], tips[1] ?? []), input);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.line.geometry.dispose();
    this.gauge.geometry.dispose();
    this.thin.dispose();
    for (const n of [...this.numbers, this.end, this.apart]) n.dispose();
  }

  private seek({ mode, hand, probes, seconds }: RulerInput, tip: THREE.Vector3, way: THREE.Vector3): void {
    const asked = `${mode} ${hand}`;
    if (asked === this.askedFor && seconds - this.askedAt < everyS && seconds >= this.askedAt) return;
    this.askedFor = asked;
    this.askedAt = seconds;
    const found = probes.map((p) => p.along(tip, way, rulerReachM)).filter((t) => t !== null);
    this.lengthM = found.length > 0 ? Math.min(...found) : null;
  }

  private drawScale(place: RulerPlace, { percentM }: RulerInput): void {
    const length = this.lengthM ?? rulerReachM;
    write(this.line, rulerStrokes(place, length));
    const at = (t: number) =>
      place.origin
        .clone()
        .addScaledVector(place.along, t * place.scale)
        .addScaledVector(place.side, 0.0012 + 1.5 * percentM);
    this.numbers.forEach((n, k) => {
      const t = tickM * numbered * (k + 1);
      // Beside the end stands the length itself.
      n.sprite.visible = t < length - 0.0015;
      n.setHeight(2.6 * percentM);
      n.sprite.position.copy(at(t));
    });
    this.end.setHeight(3.2 * percentM);
    this.end.sprite.position.copy(at(length)).addScaledVector(place.side, 3 * percentM);
    this.end.write(
      this.lengthM === null ? text('over {distance}', { distance: millimetres(rulerReachM) }) : millimetres(length),
    );
  }

  private drawGauge(pair: [THREE.Vector3, THREE.Vector3] | null, { axes, percentM }: RulerInput): void {
    const apart = pair ? pair[0].distanceTo(pair[1]) : Infinity;
    const shown = pair !== null && apart <= rulerReachM;
    this.apartM = shown ? apart : null;
    this.gauge.visible = this.apart.sprite.visible = shown;
    if (!shown) return;
    write(this.gauge, [...pair[0].toArray(), ...pair[1].toArray()]);
    this.apart.setHeight(3.2 * percentM);
    this.apart.sprite.position
      .copy(pair[0])
      .lerp(pair[1], 0.5)
      .addScaledVector(axes.y, -6 * percentM);
    this.apart.write(text('{distance} apart', { distance: millimetres(apart) }));
  }

  private makeLine(points: number): THREE.LineSegments {
    const line = new THREE.LineSegments(new THREE.BufferGeometry(), this.thin);
    const p = new THREE.BufferAttribute(new Float32Array(3 * points), 3);
    line.geometry.setAttribute('position', p.setUsage(THREE.DynamicDrawUsage));
    line.frustumCulled = false;
    line.renderOrder = 891;
    return line;
  }
}

function write(line: THREE.LineSegments, numbers: number[]): void {
  const p = line.geometry.attributes.position as THREE.BufferAttribute;
  (p.array as Float32Array).set(numbers);
  line.geometry.setDrawRange(0, numbers.length / 3);
  p.needsUpdate = true;
}

function middleOf(points: readonly THREE.Vector3[]): THREE.Vector3 | null {
  if (points.length === 0) return null;
  const sum = new THREE.Vector3();
  for (const p of points) sum.add(p);
  return sum.divideScalar(points.length);
}
