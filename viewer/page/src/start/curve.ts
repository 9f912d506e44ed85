// SPDX-License-Identifier: GPL-3.0-or-later
// A learning curve as a picture: a metric over the attempts, with its median of the last five.
import type { Curve } from './api';
import { fixed, momentText, quantity } from '../languages/numbers';

const svg = 'http://www.w3.org/2000/svg';
const width = 300;
const height = 90;
const margin = 6;

/** Median of the last `most` values up to each place. */
export function movingMedian(values: readonly number[], most: number): number[] {
  return values.map((_, i) => {
    const sorted = values.slice(Math.max(0, i - most + 1), i + 1).sort((a, b) => a - b);
    const middle = Math.floor(sorted.length / 2);
    return sorted.length % 2 === 1 ? sorted[middle]! : (sorted[middle - 1]! + sorted[middle]!) / 2;
  });
}

/** Places of the values in the picture: in order of the attempts, larger ones higher. */
export function places(values: readonly number[]): { x: number; y: number }[] {
  const least = Math.min(...values);
  const range = Math.max(...values) - least;
  return values.map((v, i) => ({
    x: margin + (values.length === 1 ? 0.5 : i / (values.length - 1)) * (width - 2 * margin),
    y: height - margin - (range > 0 ? (v - least) / range : 0.5) * (height - 2 * margin),
  }));
}

export function addSvg(root: SVGElement, tag: string, attributes: Record<string, string>): SVGElement {
  const e = document.createElementNS(svg, tag);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
  root.append(e);
  return e;
}

/** An empty picture. */
export function picture(label: string, kind: string): SVGSVGElement {
  const root = document.createElementNS(svg, 'svg');
  root.setAttribute('viewBox', `0 0 ${width} ${height}`);
  root.setAttribute('role', 'img');
  root.setAttribute('aria-label', label);
  root.setAttribute('class', kind);
  return root;
}

export function curvePicture(curve: Curve, label: string): SVGSVGElement {
  const root = picture(label, 'learning');
  const values = curve.points.map((p) => p.value);
  const medians = movingMedian(values, 5);
  const levels = [curve.learning?.atLeast, curve.learning?.atMost].filter((l) => typeof l === 'number');
  // One scale for all: the height of a value does not depend on how many there are.
  const y = places([...values, ...medians, ...levels]).map((p) => p.y);
  const at = places(values).map(({ x }, i) => ({ x, y: y[i]! }));
  for (const line of y.slice(2 * values.length))
    addSvg(root, 'line', { class: 'level', x1: '0', x2: String(width), y1: line.toFixed(1), y2: line.toFixed(1) });
  if (at.length > 2) {
    const scale = y.slice(values.length, 2 * values.length);
    const d = scale.map((h, i) => `${i === 0 ? 'M' : 'L'}${at[i]!.x.toFixed(1)} ${h.toFixed(1)}`).join('');
    addSvg(root, 'path', { class: 'median', d });
  }
  at.forEach((p, i) => {
    const point = curve.points[i]!;
    const dot = addSvg(root, 'circle', {
      cx: p.x.toFixed(1),
      cy: p.y.toFixed(1),
      r: '3',
      class: point.mode === 'test' ? 'test' : 'practice',
    });
    const title = addSvg(dot, 'title', {});
    const when = momentText(new Date(point.beganMs));
    title.textContent = `${when}: ${quantity(fixed(point.value, curve.digits), curve.unit)}`;
  });
  return root;
}
