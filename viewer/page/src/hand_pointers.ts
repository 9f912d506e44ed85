// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, pen and fingers on the field: they move the active hand, or the microscope.
import type { Microscope } from './camera';
import { TwoFingers } from './gestures';
import type { Hands } from './hands';

const wheelM = 0.0008;
/** A finger's way across the picture is coarser than a wheel's click. */
const touchDepthMPerPx = 0.00006;
const touchSwingRadPerPx = 0.004;

interface Pointer {
  x: number;
  y: number;
  button: number;
  dragged: boolean;
}

export class HandPointers {
  private readonly pointers = new Map<number, Pointer>();
  private readonly fingers = new TwoFingers();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly scope: Microscope,
    private readonly hands: Hands,
    focusAt: (x: number, y: number) => void,
  ) {
    canvas.addEventListener('pointerdown', (e) => this.down(e));
    canvas.addEventListener('pointermove', (e) => this.move(e));
    for (const name of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(name, (e) => this.up(e));
    canvas.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    canvas.addEventListener('contextmenu', (e) => e.preventDefault());
    canvas.addEventListener('dblclick', (e) => focusAt(e.clientX, e.clientY));
    window.addEventListener('blur', () => this.pointers.clear());
  }

  private down(e: PointerEvent): void {
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(e.pointerId);
    this.pointers.set(e.pointerId, { x: e.clientX, y: e.clientY, button: e.button, dragged: false });
    if (e.button === 1) e.preventDefault();
    this.fingers.clear();
  }

  private move(e: PointerEvent): void {
    const p = this.pointers.get(e.pointerId);
    if (!p) return;
    const dx = e.clientX - p.x;
    const dy = e.clientY - p.y;
    // A click is no drag: it must not take the hand.
    if (!p.dragged && Math.hypot(dx, dy) < 3) return;
    p.dragged = true;
    p.x = e.clientX;
    p.y = e.clientY;
    const height = this.canvas.clientHeight;
    if (this.pointers.size >= 3) this.scope.orbit(dx / 3, dy / 3);
    else if (this.pointers.size === 2) this.gesture();
    else if (p.button === 2) this.scope.orbit(dx, dy);
    else if (p.button === 1) this.scope.pan(dx, dy, height);
    else if (p.button === 0) this.drag(dx, dy, height, e.shiftKey);
  }

  private gesture(): void {
    const [a, b] = [...this.pointers.values()];
    const step = this.fingers.move(a!, b!);
    if (!step) return;
    if (step.kind === 'zoom') this.scope.zoom(1 / Math.max(0.2, step.by));
    else if (step.kind === 'depth') this.hands.move({ out: step.by * touchDepthMPerPx });
    else if (step.kind === 'swing') this.hands.turn({ swing: step.by * touchSwingRadPerPx });
    else this.hands.rollSeen(step.by);
  }

  private drag(dx: number, dy: number, height: number, fine: boolean): void {
    if (!this.hands.take()) return;
    // At the tip's own depth a pixel of the mouse is a pixel of the tool.
    const tip = this.hands.hands[this.hands.active]!.p;
    const depth = this.scope.camera.position.clone().sub(tip).dot(this.scope.axes().z);
    const s = this.scope.metresPerPixel(Math.max(0.02, depth), height) * (fine ? 0.3 : 1);
    this.hands.move({ right: dx * s, up: -dy * s });
  }

  private up(e: PointerEvent): void {
    this.pointers.delete(e.pointerId);
    this.fingers.clear();
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    const clicks = Math.max(-3, Math.min(3, (e.deltaY || e.deltaX) / 100));
    if (e.shiftKey) this.hands.move({ out: clicks * wheelM });
    else this.scope.zoom(1.12 ** clicks);
  }
}
