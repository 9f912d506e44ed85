// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of both hands over the last ten seconds, as curves.
import { el } from './dom';

const span_s = 10;
const colours = ['#7cc4ff', '#f0b64a'];
const names = ['left', 'right'];

export class ForceCurves {
  readonly root = el('canvas', { class: 'curves', width: '460', height: '200', 'aria-label': 'forces of the hands over ten seconds' });
  private readonly samples: { t: number; f: (number | null)[] }[] = [];

  /** One sample; time may jump back (a reset): then the curves begin anew. */
  add(time_s: number, forces: (number | null)[]): void {
    const last = this.samples[this.samples.length - 1];
    if (last && time_s < last.t) this.samples.length = 0;
    if (last && time_s === last.t) return;
    this.samples.push({ t: time_s, f: forces });
    while (this.samples.length > 0 && this.samples[0]!.t < time_s - span_s) this.samples.shift();
  }

  draw(): void {
    const c = this.root.getContext('2d');
    const last = this.samples[this.samples.length - 1];
    if (!c || !last) return;
    const { width, height } = this.root;
    const top = nice_top(Math.max(...this.samples.flatMap((s) => s.f.map((f) => f ?? 0))));
    const left = 46, bottom = height - 24, right = width - 6, high = bottom - 10;
    const x = (t: number) => right - ((last.t - t) / span_s) * (right - left);
    const y = (f: number) => bottom - (Math.min(f, top) / top) * high;
    c.clearRect(0, 0, width, height);
    c.font = '18px sans-serif';
    c.lineWidth = 1;
    for (const [f, text] of [[0, '0'], [top / 2, ''], [top, `${top} N`]] as [number, string][]) {
      c.strokeStyle = 'rgba(255,255,255,0.14)';
      c.beginPath(); c.moveTo(left, y(f)); c.lineTo(right, y(f)); c.stroke();
      c.fillStyle = '#9aa4ad';
      c.fillText(text, 0, y(f) + 6);
    }
    c.fillText('−10 s', left, height - 4);
    c.fillText('now', right - 36, height - 4);
    for (const hand of [0, 1]) {
      c.strokeStyle = c.fillStyle = colours[hand]!;
      c.fillText(names[hand]!, left + 90 + 70 * hand, height - 4);
      c.lineWidth = 2;
      c.beginPath();
      let pen = false;
      for (const s of this.samples) {
        const f = s.f[hand] ?? null;
        if (f === null) { pen = false; continue; }
        if (pen) c.lineTo(x(s.t), y(f));
        else c.moveTo(x(s.t), y(f));
        pen = true;
      }
      c.stroke();
    }
  }
}

/** Next of 0.2, 0.5, 1, 2, 5, ... newtons. */
export function nice_top(largest: number): number {
  let step = 0.2;
  while (step < largest) for (const k of [2.5, 2, 2]) { step = Number((step * k).toPrecision(2)); if (step >= largest) break; }
  return step;
}
