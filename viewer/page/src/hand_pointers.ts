// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, pen and fingers on the field: they move the active hand, or the microscope. While a mouse drags one hand, a
// finger or a pen drags the other, and the other way round.
import type { Microscope } from './camera';
import { TwoFingers } from './gestures';
import type { Hands } from './hands';
import { FingerBesidePen, PenWrist } from './pen';
import { wheelClicks, wheelZoom } from './wheel';

const wheelM = 0.0008;
/** A finger's way across the picture is coarser than a wheel's click. */
const touchDepthMPerPx = 0.00006;
const touchSwingRadPerPx = 0.004;
const fingerRollRadPerPx = 0.008;

interface Pointer {
  type: string;
  /** It moves this hand as long as it is down. */
  hand: number;
  x: number;
  y: number;
  button: number;
  dragged: boolean;
  wrist: PenWrist;
  beside: FingerBesidePen;
}

export class HandPointers {
  private readonly pointers = new Map<number, Pointer>();
  private readonly fingers = [new TwoFingers(), new TwoFingers()];

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
    hands.leaving.push((to) => this.follow(to));
  }

  private down(e: PointerEvent): void {
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(e.pointerId);
    const hand = this.handFor(e.pointerType);
    const { pointerType: type, clientX: x, clientY: y, button } = e;
    const tools = { wrist: new PenWrist(), beside: new FingerBesidePen() };
    this.pointers.set(e.pointerId, { type, hand, x, y, button, dragged: false, ...tools });
    if (e.button === 1) e.preventDefault();
    this.fingers[hand]!.clear();
  }

  /** Fingers and pen belong together, and the mouse is another device: it has the other hand meanwhile. */
  private handFor(type: string): number {
    const mouse = type === 'mouse';
    const other = [...this.pointers.values()].find((p) => (p.type === 'mouse') !== mouse && p.button === 0);
    return other ? 1 - other.hand : (this.together(type)[0]?.hand ?? this.hands.active);
  }

  /** One device goes over to the hand that becomes active; two keep their hands. */
  private follow(to: number): void {
    const down = [...this.pointers.values()];
    if (new Set(down.map((p) => p.hand)).size < 2) for (const p of down) p.hand = to;
  }

  /** What is down of the same device. */
  private together(type: string): Pointer[] {
    const mouse = type === 'mouse';
    return [...this.pointers.values()].filter((p) => (p.type === 'mouse') === mouse);
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
    const group = this.together(p.type);
    const pen = group.some((g) => g.type === 'pen');
    if (group.length >= 3) this.scope.orbit(dx / 3, dy / 3);
    else if (group.length === 2 && pen && p.type !== 'pen') this.besidePen(p, dx, dy);
    else if (group.length === 2 && !pen) this.gesture(p.hand, group);
    else this.single(p, e, dx, dy);
  }

  private single(p: Pointer, e: PointerEvent, dx: number, dy: number): void {
    const height = this.canvas.clientHeight;
    if (p.button === 2) this.scope.orbit(dx, dy);
    else if (p.button === 1) this.scope.pan(dx, dy, height);
    else if (p.button === 0) {
      this.drag(p.hand, dx, dy, height, e.shiftKey);
      if (p.type !== 'pen') return;
      const { clockwise, ...lean } = p.wrist.move(e);
      this.hands.turn(lean, p.hand);
      this.hands.rollSeen(clockwise, p.hand);
    }
  }

  private besidePen(p: Pointer, dx: number, dy: number): void {
    const step = p.beside.move(dx, dy);
    if (step?.kind === 'depth') this.hands.move({ out: step.by * touchDepthMPerPx }, p.hand);
    else if (step) this.hands.rollSeen(step.by * fingerRollRadPerPx, p.hand);
  }

  private gesture(hand: number, [a, b]: Pointer[]): void {
    const step = this.fingers[hand]!.move(a!, b!);
    if (!step) return;
    if (step.kind === 'zoom') this.scope.zoom(1 / Math.max(0.2, step.by));
    else if (step.kind === 'depth') this.hands.move({ out: step.by * touchDepthMPerPx }, hand);
    else if (step.kind === 'swing') this.hands.turn({ swing: step.by * touchSwingRadPerPx }, hand);
    else this.hands.rollSeen(step.by, hand);
  }

  private drag(hand: number, dx: number, dy: number, height: number, fine: boolean): void {
    if (!this.hands.take(hand)) return;
    // At the tip's own depth a pixel of the mouse is a pixel of the tool.
    const depth = this.scope.camera.position.clone().sub(this.hands.hands[hand]!.p).dot(this.scope.axes().z);
    const s = this.scope.metresPerPixel(Math.max(0.02, depth), height) * (fine ? 0.3 : 1);
    this.hands.move({ right: dx * s, up: -dy * s }, hand);
  }

  private up(e: PointerEvent): void {
    this.pointers.delete(e.pointerId);
    for (const f of this.fingers) f.clear();
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    if (e.shiftKey) this.hands.move({ out: wheelClicks(e) * wheelM });
    else this.scope.zoom(wheelZoom(e));
  }
}
