// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers over the last ten seconds, as curves of one unit in one chart.
import { palette } from '../palette';
import { el } from './dom';
import { significant } from '../languages/numbers';
import { text } from '../languages/text';

const spanS = 10;
const colours = ['#7cc4ff', palette.high, palette.good, palette.bad, '#c79bff', '#e9edf0'];

interface Frame {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export class TimeChart {
  readonly root: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly samples: { t: number; values: (number | null)[] }[] = [];

  constructor(
    label: string,
    private readonly unit: string,
    names: readonly string[],
  ) {
    this.canvas = el('canvas', { class: 'curves', width: '460', height: '180', 'aria-label': label });
    const legend = names.map((name, k) => {
      const entry = el('span', {}, name);
      entry.style.color = colourOf(k);
      return entry;
    });
    this.root = el('div', { class: 'chart' }, this.canvas, el('div', { class: 'legend' }, ...legend));
  }

  /** The curves of another scene begin anew. */
  clear(): void {
    this.samples.length = 0;
    this.draw();
  }

  /** One sample; time may jump back (a reset): then the curves begin anew. null: not known, a gap. */
  add(timeS: number, values: (number | null)[]): void {
    const last = this.samples[this.samples.length - 1];
    if (last && timeS < last.t) this.samples.length = 0;
    if (last && timeS === last.t) return;
    this.samples.push({ t: timeS, values });
    while (this.samples.length > 0 && this.samples[0]!.t < timeS - spanS) this.samples.shift();
  }

  draw(): void {
    const c = this.canvas.getContext('2d');
    const last = this.samples[this.samples.length - 1];
    if (!c || !last) return;
    const { width, height } = this.canvas;
    const frame = { left: 58, right: width - 6, top: 12, bottom: height - 24 };
    const known = this.samples.flatMap((s) => s.values.filter((v) => v !== null));
    const [low, high] = niceRange(known);
    const x = (t: number) => frame.right - ((last.t - t) / spanS) * (frame.right - frame.left);
    const y = (v: number) => frame.bottom - ((v - low) / (high - low)) * (frame.bottom - frame.top);
    c.clearRect(0, 0, width, height);
    c.font = '18px sans-serif';
    drawGrid(c, frame, [low, (low + high) / 2, high], y, this.unit);
    last.values.forEach((_, k) => this.drawCurve(c, k, x, y));
  }

  private drawCurve(c: CanvasRenderingContext2D, k: number, x: (t: number) => number, y: (v: number) => number): void {
    c.strokeStyle = colourOf(k);
    c.lineWidth = 2;
    c.beginPath();
    let pen = false;
    for (const s of this.samples) {
      const v = s.values[k] ?? null;
      if (v !== null && pen) c.lineTo(x(s.t), y(v));
      else if (v !== null) c.moveTo(x(s.t), y(v));
      pen = v !== null;
    }
    c.stroke();
  }
}

const colourOf = (k: number): string => colours[k % colours.length]!;

function drawGrid(
  c: CanvasRenderingContext2D,
  f: Frame,
  at: [number, number, number],
  y: (v: number) => number,
  unit: string,
): void {
  c.lineWidth = 1;
  c.strokeStyle = 'rgba(255,255,255,0.14)';
  c.fillStyle = '#9aa4ad';
  at.forEach((v, k) => {
    c.beginPath();
    c.moveTo(f.left, y(v));
    c.lineTo(f.right, y(v));
    c.stroke();
    const number = significant(v, 3);
    if (k !== 1) c.fillText(k === 2 && unit ? `${number} ${unit}` : number, 0, y(v) + 6, f.left + 60);
  });
  c.fillText(`−${spanS} s`, f.left, f.bottom + 20);
  c.textAlign = 'right';
  c.fillText(text('now'), f.right, f.bottom + 20);
  c.textAlign = 'left';
}

/** Next of 1, 2, 5 times a power of ten, at least as large; 0 for 0. */
export function niceTop(largest: number): number {
  if (!(largest > 0)) return 0;
  const power = 10 ** Math.floor(Math.log10(largest));
  const step = [1, 2, 5, 10].find((k) => k * power >= largest * (1 - 1e-9)) ?? 10;
  return Number((step * power).toPrecision(2));
}

/** Round ends of an axis that holds all values and 0. */
export function niceRange(values: readonly number[]): [number, number] {
  const high = niceTop(Math.max(0, ...values));
  const low = -niceTop(Math.max(0, ...values.map((v) => -v)));
  return high === 0 && low === 0 ? [0, 1] : [low === 0 ? 0 : low, high];
}
