// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, keyboard and touch as two hands: one is active at a time; a hand is the user's from the first drag or
// movement key until it is released, and only then its pose is sent, 60 times a second.
import * as THREE from 'three';
import type { Microscope } from './camera';
import type { Connection } from './connection';
import { HandPose } from './hand_pose';

export interface ToolPoses {
  /** Present pose of the tool held by a hand, or null. */
  toolPose(hand: number): { p: THREE.Vector3; q: THREE.Quaternion } | null;
}

export interface HandActions {
  focusAt(x: number, y: number): void;
  togglePause(): void;
  toggleHelp(): void;
  nextTool(hand: number, step: 1 | -1): void;
  changed(): void;
}

const keyboardMPerS = 0.012;
const keyboardRadPerS = 0.9;
const wheelM = 0.0008;
const sendPeriodMs = 1000 / 60;
const moving = new Set([
  'KeyW',
  'KeyS',
  'KeyA',
  'KeyD',
  'KeyQ',
  'KeyE',
  'KeyR',
  'KeyF',
  'ArrowLeft',
  'ArrowRight',
  'ArrowUp',
  'ArrowDown',
]);

export class Hands {
  readonly hands = [new HandPose(), new HandPose()];
  active = 1;
  private readonly keys = new Set<string>();
  private readonly pointers = new Map<number, { x: number; y: number; button: number; dragged: boolean }>();
  private lastSentMs = 0;
  private pinch = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly scope: Microscope,
    private readonly link: Connection,
    private readonly tools: ToolPoses,
    private readonly actions: HandActions,
    private readonly mayDrive: boolean,
  ) {
    canvas.addEventListener('pointerdown', (e) => this.down(e));
    canvas.addEventListener('pointermove', (e) => this.move(e));
    for (const name of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(name, (e) => this.up(e));
    canvas.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    canvas.addEventListener('contextmenu', (e) => e.preventDefault());
    canvas.addEventListener('dblclick', (e) => actions.focusAt(e.clientX, e.clientY));
    window.addEventListener('keydown', (e) => this.key(e, true));
    window.addEventListener('keyup', (e) => this.key(e, false));
    window.addEventListener('blur', () => this.letGo());
  }

  setActive(hand: number): void {
    const old = this.hands[this.active]!;
    old.button1 = old.button2 = false;
    this.active = hand;
    this.actions.changed();
  }

  release(hand: number): void {
    this.hands[hand]!.release();
    this.actions.changed();
  }

  releaseAll(): void {
    this.hands.forEach((h) => h.release());
    this.actions.changed();
  }

  /** Buttons of the screen, for touch. */
  press(button: 1 | 2, on: boolean): void {
    if (on && !this.take()) return;
    const h = this.hands[this.active]!;
    if (button === 1) h.button1 = on;
    else h.button2 = on;
    this.actions.changed();
  }

  /** Held keys move the hand; poses go out at 60 Hz at most. */
  update(dt: number, nowMs: number): void {
    this.applyKeys(dt);
    if (nowMs - this.lastSentMs < sendPeriodMs - 2) return;
    this.lastSentMs = nowMs;
    this.hands.forEach((h, hand) => {
      if (!h.taken) return;
      this.link.sendHand({
        hand,
        p_m: Float64Array.from(h.p.toArray()),
        q: Float64Array.from([h.q.w, h.q.x, h.q.y, h.q.z]),
        button1: h.button1,
        button2: h.button2,
      });
    });
  }

  private take(): boolean {
    if (!this.mayDrive) return false;
    const h = this.hands[this.active]!;
    if (h.taken) return true;
    const pose = this.tools.toolPose(this.active);
    if (!pose) return false;
    h.take(pose.p, pose.q);
    this.actions.changed();
    return true;
  }

  private shift(by: THREE.Vector3): void {
    if (this.take()) this.hands[this.active]!.move(by, this.scope.homeTarget);
  }

  private applyKeys(dt: number): void {
    const on = (code: string) => (this.keys.has(code) ? 1 : 0);
    if (![...this.keys].some((k) => moving.has(k)) || !this.take()) return;
    const { x, y, z } = this.scope.axes();
    const fine = on('ShiftLeft') || on('ShiftRight') ? 0.3 : 1;
    const s = keyboardMPerS * fine * dt;
    const by = new THREE.Vector3()
      .addScaledVector(z, (on('KeyS') - on('KeyW')) * s)
      .addScaledVector(x, (on('ArrowRight') - on('ArrowLeft')) * s)
      .addScaledVector(y, (on('ArrowUp') - on('ArrowDown')) * s);
    this.shift(by);
    const h = this.hands[this.active]!;
    const a = keyboardRadPerS * fine * dt;
    const along = new THREE.Vector3(0, 0, 1).applyQuaternion(h.q);
    h.turn(along, (on('KeyE') - on('KeyQ')) * a);
    h.turn(y, (on('KeyD') - on('KeyA')) * a);
    h.turn(x, (on('KeyF') - on('KeyR')) * a);
  }

  private down(e: PointerEvent): void {
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(e.pointerId);
    this.pointers.set(e.pointerId, { x: e.clientX, y: e.clientY, button: e.button, dragged: false });
    if (e.button === 1) e.preventDefault();
    this.pinch = 0;
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
    if (this.pointers.size >= 2) {
      // Two fingers: pinch zooms, sliding together turns the microscope.
      const [a, b] = [...this.pointers.values()];
      const d = Math.hypot(a!.x - b!.x, a!.y - b!.y);
      if (this.pinch > 0 && d > 0) this.scope.zoom(this.pinch / d);
      this.pinch = d;
      this.scope.orbit(dx / 2, dy / 2);
    } else if (p.button === 2) this.scope.orbit(dx, dy);
    else if (p.button === 1) this.scope.pan(dx, dy, height);
    else if (p.button === 0) this.drag(dx, dy, height, e.shiftKey);
  }

  private drag(dx: number, dy: number, height: number, fine: boolean): void {
    if (!this.take()) return;
    const { x, y, z } = this.scope.axes();
    // At the tip's own depth a pixel of the mouse is a pixel of the tool.
    const depth = this.scope.camera.position.clone().sub(this.hands[this.active]!.p).dot(z);
    const s = this.scope.metresPerPixel(Math.max(0.02, depth), height) * (fine ? 0.3 : 1);
    this.shift(new THREE.Vector3().addScaledVector(x, dx * s).addScaledVector(y, -dy * s));
  }

  private up(e: PointerEvent): void {
    this.pointers.delete(e.pointerId);
    this.pinch = 0;
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    const clicks = Math.max(-3, Math.min(3, (e.deltaY || e.deltaX) / 100));
    if (e.shiftKey) this.shift(this.scope.axes().z.multiplyScalar(clicks * wheelM));
    else this.scope.zoom(1.12 ** clicks);
  }

  private key(e: KeyboardEvent, down: boolean): void {
    if (
      e.target instanceof HTMLSelectElement ||
      e.target instanceof HTMLInputElement ||
      e.ctrlKey ||
      e.metaKey ||
      e.altKey
    )
      return;
    if (moving.has(e.code) || e.code.startsWith('Shift')) {
      if (down) this.keys.add(e.code);
      else this.keys.delete(e.code);
      if (!e.code.startsWith('Shift')) e.preventDefault();
      return;
    }
    if (e.code === 'Space' || e.code === 'KeyB') {
      e.preventDefault();
      if (!e.repeat) this.press(e.code === 'Space' ? 1 : 2, down);
      return;
    }
    if (!down || e.repeat) return;
    switch (e.code) {
      case 'Tab':
        e.preventDefault();
        this.setActive(1 - this.active);
        break;
      case 'Digit1':
        this.setActive(0);
        break;
      case 'Digit2':
        this.setActive(1);
        break;
      case 'KeyG':
        this.release(this.active);
        break;
      case 'KeyV':
        this.scope.reset();
        break;
      case 'KeyC': {
        const t = this.tools.toolPose(this.active);
        if (t) this.scope.focus(t.p);
        break;
      }
      case 'KeyP':
        this.actions.togglePause();
        break;
      case 'KeyT':
        this.actions.nextTool(this.active, e.shiftKey ? -1 : 1);
        break;
      case 'KeyH':
      case 'Slash':
        this.actions.toggleHelp();
        break;
    }
  }

  private letGo(): void {
    this.keys.clear();
    this.pointers.clear();
    for (const h of this.hands) h.button1 = h.button2 = false;
    this.actions.changed();
  }
}
