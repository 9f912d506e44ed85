// SPDX-License-Identifier: GPL-3.0-or-later
// Shows strokes and the pointer over the picture. Both are drawn apart from it, so that they need not wait for the next
// one.
import * as THREE from 'three';
import { el } from '../hud/dom';
import type { Point } from './messages';
import { opacity, type Strokes } from './strokes';

const lineWidthPx = 4;

/** Null: it is not in the picture. */
type Place = [number, number] | null;

export class Overlay {
  readonly canvas = el('canvas', { class: 'strokes', 'aria-hidden': 'true' });
  /** The pointer; the second is for the other half of a picture side by side. */
  readonly rings = [0, 1].map(() => el('i', { class: 'pointed', 'aria-hidden': 'true', hidden: '' }));
  private readonly at = new THREE.Vector3();
  private empty = true;

  /** sideBySide: each half is a whole picture. */
  draw(strokes: Strokes, camera: THREE.Camera, sideBySide: boolean, nowMs: number): void {
    const shown = strokes.age(nowMs);
    if (!shown && this.empty) return;
    this.empty = !shown;
    const { clientWidth, clientHeight } = this.canvas;
    const width = sideBySide ? clientWidth / 2 : clientWidth;
    /** In pixels of the page. */
    const place = (p: Point): Place => {
      const v = this.at.set(...p).project(camera);
      return Math.abs(v.z) <= 1 ? [((v.x + 1) / 2) * width, ((1 - v.y) / 2) * clientHeight] : null;
    };
    const at = strokes.point && place(strokes.point);
    this.rings.forEach((ring, half) => {
      ring.hidden = !at || (half > 0 && !sideBySide);
      if (at) ring.style.translate = `${half * width + at[0]}px ${at[1]}px`;
    });
    this.drawLines(strokes, place, sideBySide ? [0, width] : [0], nowMs);
  }

  private drawLines(strokes: Strokes, place: (p: Point) => Place, lefts: number[], nowMs: number): void {
    const { canvas } = this;
    const scale = window.devicePixelRatio;
    const wide = Math.round(canvas.clientWidth * scale);
    const high = Math.round(canvas.clientHeight * scale);
    if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
    const context = canvas.getContext('2d')!;
    context.clearRect(0, 0, wide, high);
    context.lineCap = context.lineJoin = 'round';
    for (const left of lefts) {
      context.setTransform(scale, 0, 0, scale, left * scale, 0);
      for (const s of strokes.list) drawLine(context, s.points.map(place), opacity(s, nowMs));
    }
    context.resetTransform();
  }
}

/** Light on dark, so that it is seen on blood and on bone. */
function drawLine(context: CanvasRenderingContext2D, points: Place[], alpha: number): void {
  const seen = points.filter((p) => p !== null);
  if (seen.length === 0) return;
  context.globalAlpha = alpha;
  context.beginPath();
  context.moveTo(...seen[0]!);
  // A dot is a line of no length.
  for (const p of seen.length > 1 ? seen.slice(1) : seen) context.lineTo(...p);
  for (const [colour, more] of [
    ['rgba(0, 0, 0, 0.65)', 3],
    ['#5ff0ff', 0],
  ] as const) {
    context.strokeStyle = colour;
    context.lineWidth = lineWidthPx + more;
    context.stroke();
  }
  context.globalAlpha = 1;
}
