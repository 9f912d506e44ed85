// SPDX-License-Identifier: GPL-3.0-or-later
// A brush over the view of the vessel: a press, a drag and a release make a stroke on the surface.
import { el } from '../../hud/dom';
import type { Point } from '../api';

export interface BrushEvents {
  /** The place of the surface under a place of the window; null: there is none. */
  at(x: number, y: number): Point | null;
  /** The stroke so far. */
  drawn(stroke: readonly Point[]): void;
  done(stroke: readonly Point[]): void;
  /** Whether a place adds to the stroke. */
  adds(stroke: readonly Point[], p: Point): boolean;
}

export class Brush {
  readonly root = el('div', { class: 'brush-over' });
  private stroke: Point[] | null = null;

  constructor(private readonly events: BrushEvents) {
    this.root.hidden = true;
    this.root.addEventListener('pointerdown', (e) => this.begin(e));
    this.root.addEventListener('pointermove', (e) => this.go(e));
    this.root.addEventListener('pointerup', () => this.end());
    this.root.addEventListener('pointercancel', () => this.end());
  }

  set on(on: boolean) {
    this.root.hidden = !on;
    this.stroke = null;
  }

  get drawing(): boolean {
    return this.stroke !== null;
  }

  private begin(e: PointerEvent): void {
    if (e.button !== 0) return;
    this.root.setPointerCapture(e.pointerId);
    this.stroke = [];
    this.go(e);
  }

  private go(e: PointerEvent): void {
    if (!this.stroke) return;
    const p = this.events.at(e.clientX, e.clientY);
    if (!p || !this.events.adds(this.stroke, p)) return;
    this.stroke.push(p);
    this.events.drawn(this.stroke);
  }

  private end(): void {
    const { stroke } = this;
    this.stroke = null;
    if (stroke && stroke.length > 0) this.events.done(stroke);
  }
}
