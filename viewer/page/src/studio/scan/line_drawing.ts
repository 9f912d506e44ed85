// SPDX-License-Identifier: GPL-3.0-or-later
// A straight line that is drawn over a view, by a press, a drag and a release.
import { el } from '../../hud/dom';

export type Place = readonly [number, number];
const leastPx = 8;

export class LineDrawing {
  readonly root = el('div', { class: 'line-drawing' });
  private readonly svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  private readonly line = document.createElementNS('http://www.w3.org/2000/svg', 'line');
  private from: Place | null = null;

  /** drawn: gets both ends, px of the window. */
  constructor(private readonly drawn: (from: Place, to: Place) => void) {
    this.svg.append(this.line);
    this.root.append(this.svg);
    this.root.hidden = true;
    this.root.addEventListener('pointerdown', (e) => this.begin(e));
    this.root.addEventListener('pointermove', (e) => this.from && this.show(this.from, [e.clientX, e.clientY]));
    this.root.addEventListener('pointerup', (e) => this.end(e));
  }

  set on(on: boolean) {
    this.root.hidden = !on;
    this.from = null;
    this.show([-9, -9], [-9, -9]);
  }

  private begin(e: PointerEvent): void {
    this.root.setPointerCapture(e.pointerId);
    this.from = [e.clientX, e.clientY];
  }

  private end(e: PointerEvent): void {
    const { from } = this;
    this.from = null;
    if (from && Math.hypot(e.clientX - from[0], e.clientY - from[1]) >= leastPx)
      this.drawn(from, [e.clientX, e.clientY]);
  }

  private show(from: Place, to: Place): void {
    const box = this.root.getBoundingClientRect();
    const zoom = box.width > 0 ? this.root.clientWidth / box.width : 1;
    const set = (name: string, v: number) => this.line.setAttribute(name, String(v * zoom));
    set('x1', from[0] - box.left);
    set('y1', from[1] - box.top);
    set('x2', to[0] - box.left);
    set('y2', to[1] - box.top);
  }
}
