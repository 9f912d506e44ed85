// SPDX-License-Identifier: GPL-3.0-or-later
// Shows strokes and the pointer over the picture.
import * as THREE from 'three';
import { el } from '../hud/dom';
import type { Point } from './messages';
import { opacity, type Strokes } from './strokes';

const lineWidthPx = 4;
const ringPx = 16;

export class Overlay {
  readonly canvas = el('canvas', { class: 'strokes', 'aria-hidden': 'true' });
  private readonly at = new THREE.Vector3();
  private empty = true;

  /** sideBySide: each half is a whole picture. */
  draw(strokes: Strokes, camera: THREE.Camera, sideBySide: boolean, nowMs: number): void {
    const shown = strokes.age(nowMs);
    if (!shown && this.empty) return;
    this.empty = !shown;
    const { canvas } = this;
    const scale = window.devicePixelRatio;
    const wide = Math.round(canvas.clientWidth * scale);
    const high = Math.round(canvas.clientHeight * scale);
    if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
    const context = canvas.getContext('2d')!;
    context.clearRect(0, 0, wide, high);
    context.lineCap = context.lineJoin = 'round';
    for (const half of sideBySide ? [0, 1] : [0]) {
      const width = sideBySide ? wide / 2 : wide;
      const place = (p: Point): [number, number] | null => {
        const v = this.at.set(...p).project(camera);
        return Math.abs(v.z) <= 1 ? [half * width + ((v.x + 1) / 2) * width, ((1 - v.y) / 2) * high] : null;
      };
      for (const s of strokes.list) drawLine(context, s.points.map(place), opacity(s, nowMs), scale);
      const at = strokes.point && place(strokes.point);
      if (at) drawRing(context, at, scale);
    }
  }
}

/** Light on dark, so that it is seen on blood and on bone. */
function drawLine(
  context: CanvasRenderingContext2D,
  points: ([number, number] | null)[],
  alpha: number,
  scale: number,
): void {
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
    context.lineWidth = (lineWidthPx + more) * scale;
    context.stroke();
  }
  context.globalAlpha = 1;
}

function drawRing(context: CanvasRenderingContext2D, [x, y]: [number, number], scale: number): void {
  for (const [colour, width] of [
    ['rgba(0, 0, 0, 0.65)', 6],
    ['#5ff0ff', 3],
  ] as const) {
    context.beginPath();
    context.arc(x, y, ringPx * scale, 0, 2 * Math.PI);
    context.strokeStyle = colour;
    context.lineWidth = width * scale;
    context.stroke();
  }
}
