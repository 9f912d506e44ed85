// SPDX-License-Identifier: GPL-3.0-or-later
// The recording along time: forces of both hands, one more curve, marks of what happened, the chosen stretch and the
// present moment. Pressing anywhere goes there; dragging scrubs.
import { el } from '../hud/dom';
import { niceRange } from '../hud/curves';
import { clockText } from '../hud/state';
import { palette } from '../palette';
import type { ReplayClock } from './clock';
import type { Series } from './timeline';
import { significant } from '../languages/numbers';
import { text } from '../languages/text';

const colours = ['#7cc4ff', '#f0b64a', '#c79bff'];
const markColours: Record<string, string> = { fault: palette.bad, goal: palette.good, note: '#e9edf0' };
const height = 96;
/** Marks have the top; below them are the curves. */
const marksPx = 16;
const textPx = 12;

export interface Mark {
  timeS: number;
  kind: string;
  text: string;
}

interface Lane {
  top: number;
  bottom: number;
}

/** Points of a curve for a picture `wide` pixels wide: the smallest and the largest value of each pixel. */
export function extremesByPixel(
  series: Pick<Series, 'timesS' | 'values'>,
  durationS: number,
  wide: number,
): { x: number; low: number; high: number }[] {
  const out: { x: number; low: number; high: number }[] = [];
  for (let k = 0; k < series.timesS.length; k++) {
    const v = series.values[k]!;
    if (!Number.isFinite(v)) continue;
    const x = Math.round((series.timesS[k]! / Math.max(1e-9, durationS)) * wide);
    const last = out[out.length - 1];
    if (last?.x === x) {
      last.low = Math.min(last.low, v);
      last.high = Math.max(last.high, v);
    } else out.push({ x, low: v, high: v });
  }
  return out;
}

export class TimelineChart {
  readonly root: HTMLElement;
  marks: readonly Mark[] = [];
  private readonly canvas: HTMLCanvasElement;
  private readonly cursor = el('i', { class: 'cursor' });
  private readonly hint = el('span', { class: 'hint' });
  private forces: readonly Series[] = [];
  private curve: Series | null = null;
  private drawn = '';

  constructor(
    private readonly clock: ReplayClock,
    private readonly moved: () => void,
  ) {
    this.canvas = el('canvas', {});
    this.root = el(
      'div',
      { class: 'timeline', role: 'slider', tabindex: '0', 'aria-label': text('time'), 'aria-valuemin': '0' },
      this.canvas,
      this.cursor,
      this.hint,
    );
    this.root.setAttribute('aria-valuemax', clock.durationS.toFixed(1));
    const go = (e: PointerEvent) => {
      clock.seek(this.timeAt(e.clientX));
      this.moved();
    };
    this.root.addEventListener('pointerdown', (e) => {
      this.root.setPointerCapture(e.pointerId);
      go(e);
    });
    this.root.addEventListener('pointermove', (e) => {
      if (this.root.hasPointerCapture(e.pointerId)) go(e);
      this.showHint(e.clientX);
    });
    this.root.addEventListener('pointerleave', () => (this.hint.hidden = true));
    this.hint.hidden = true;
  }

  show(forces: readonly Series[], curve: Series | null): void {
    this.forces = forces;
    this.curve = curve;
    this.drawn = '';
  }

  /** Once a picture. */
  draw(): void {
    const wide = this.root.clientWidth;
    const { timeS, durationS, stretch } = this.clock;
    const key = JSON.stringify([wide, stretch, this.marks, this.curve?.id]);
    if (key !== this.drawn) {
      this.drawn = key;
      this.drawCurves(wide);
    }
    this.cursor.style.left = `${(100 * timeS) / Math.max(1e-9, durationS)}%`;
    this.root.setAttribute('aria-valuenow', timeS.toFixed(1));
    this.root.setAttribute('aria-valuetext', clockText(timeS));
  }

  private timeAt(clientX: number): number {
    const box = this.root.getBoundingClientRect();
    return ((clientX - box.left) / Math.max(1, box.width)) * this.clock.durationS;
  }

  private showHint(clientX: number): void {
    const timeS = this.timeAt(clientX);
    const near = this.clock.durationS * (6 / Math.max(1, this.root.clientWidth));
    const mark = this.marks.find((m) => Math.abs(m.timeS - timeS) < near);
    this.hint.hidden = false;
    this.hint.textContent = mark ? `${clockText(mark.timeS)}  ${mark.text}` : clockText(timeS);
    const box = this.root.getBoundingClientRect();
    const share = (clientX - box.left) / Math.max(1, box.width);
    this.hint.style.left = share > 0.7 ? '' : `${100 * share}%`;
    this.hint.style.right = share > 0.7 ? `${100 * (1 - share)}%` : '';
  }

  private drawCurves(wide: number): void {
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.max(1, Math.round(wide * ratio));
    this.canvas.height = height * ratio;
    const c = this.canvas.getContext('2d');
    if (!c) return;
    c.scale(ratio, ratio);
    c.clearRect(0, 0, wide, height);
    const x = (t: number) => (t / Math.max(1e-9, this.clock.durationS)) * wide;
    const { stretch } = this.clock;
    if (stretch) {
      c.fillStyle = 'rgba(124,196,255,0.16)';
      c.fillRect(x(stretch.fromS), 0, x(stretch.toS) - x(stretch.fromS), height);
    }
    const middle = marksPx + (height - marksPx) * 0.56;
    drawLane(c, this.forces, { top: marksPx, bottom: middle - 3 }, this.clock.durationS, wide, 0);
    if (this.curve) drawLane(c, [this.curve], { top: middle + 3, bottom: height - 2 }, this.clock.durationS, wide, 2);
    for (const m of this.marks) drawMark(c, x(m.timeS), m.kind);
  }
}

function drawLane(
  c: CanvasRenderingContext2D,
  curves: readonly Series[],
  { top, bottom }: Lane,
  durationS: number,
  wide: number,
  firstColour: number,
): void {
  const known = curves.flatMap((s) => [...s.values].filter((v) => Number.isFinite(v)));
  const [low, high] = niceRange([known.reduce((a, b) => Math.min(a, b), 0), known.reduce((a, b) => Math.max(a, b), 0)]);
  const y = (v: number) => bottom - ((v - low) / (high - low)) * (bottom - top);
  curves.forEach((series, k) => {
    c.strokeStyle = colours[firstColour + k] ?? colours[0]!;
    c.lineWidth = 1.2;
    c.beginPath();
    extremesByPixel(series, durationS, wide).forEach((p, i) => {
      if (i === 0) c.moveTo(p.x, y(p.low));
      else c.lineTo(p.x, y(p.low));
      c.lineTo(p.x, y(p.high));
    });
    c.stroke();
  });
  c.font = `${textPx}px sans-serif`;
  c.fillStyle = '#9aa4ad';
  const scale = `${significant(high, 3)} ${curves[0]?.unit ?? ''}  `;
  c.fillText(scale, 2, top + textPx - 2);
  let x = 2 + c.measureText(scale).width;
  curves.forEach((series, k) => {
    c.fillStyle = colours[firstColour + k] ?? colours[0]!;
    c.fillText(series.text, x, top + textPx - 2);
    x += c.measureText(`${series.text}   `).width;
  });
}

/** A triangle points down for what was reached, and a cross stands for a fault, so that colour is not alone. */
function drawMark(c: CanvasRenderingContext2D, x: number, kind: string): void {
  c.fillStyle = c.strokeStyle = markColours[kind] ?? '#9aa4ad';
  c.lineWidth = kind === 'fault' ? 2 : 1;
  c.beginPath();
  if (kind === 'fault') {
    c.moveTo(x - 4, 3);
    c.lineTo(x + 4, 11);
    c.moveTo(x + 4, 3);
    c.lineTo(x - 4, 11);
    c.stroke();
  } else if (kind === 'goal' || kind === 'note') {
    c.moveTo(x - 4, 3);
    c.lineTo(x + 4, 3);
    c.lineTo(x, 11);
    c.fill();
  } else {
    c.moveTo(x, 5);
    c.lineTo(x, 11);
    c.stroke();
  }
}
