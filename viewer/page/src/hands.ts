// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, keyboard and touch as two hands: one is active at a time; a hand is the user's from the first drag or
// movement key until it is released, and only then its pose is sent, 60 times a second. A button whose key is held
// while the user goes to the other hand stays on, latched.
import * as THREE from 'three';
import type { Microscope } from './camera';
import type { Connection } from './connection';
import { TwoFingers } from './gestures';
import { type Button, HandPose } from './hand_pose';
import { isControl, isTyping, keyOf } from './keyboard';

export interface ToolPoses {
  /** Present pose of the tool held by a hand, or null. */
  toolPose(hand: number): { p: THREE.Vector3; q: THREE.Quaternion } | null;
}

/** buttons: of the hand, 1 and 2. */
export interface HandState {
  taken: boolean;
  buttons: { on: boolean; latched: boolean }[];
}

export interface HandActions {
  focusAt(x: number, y: number): void;
  togglePause(): void;
  toggleHelp(): void;
  nextTool(hand: number, step: 1 | -1): void;
  /** The user wants to leave the field for the controls. */
  leaveField(): void;
  changed(): void;
}

const keyboardMPerS = 0.012;
const keyboardRadPerS = 0.9;
const wheelM = 0.0008;
const sendPeriodMs = 1000 / 60;
/** A finger's way across the picture is coarser than a wheel's click. */
const touchDepthMPerPx = 0.00006;
const touchSwingRadPerPx = 0.004;
const arrows = new Set(['arrowleft', 'arrowright', 'arrowup', 'arrowdown']);
const moving = new Set(['w', 's', 'a', 'd', 'q', 'e', 'r', 'f', ...arrows]);
const buttonOf: Record<string, Button> = { space: 1, b: 2 };
const sideOf = (hand: number): string => (hand === 0 ? 'left' : 'right');

export class Hands {
  readonly hands = [new HandPose(), new HandPose()];
  active = 1;
  /** What each held key means; a key keeps its meaning until it goes up, whatever else is pressed meanwhile. */
  private readonly keys = new Map<string, string>();
  /** Held keys that press a button, with the hand they press it for. */
  private readonly pressing = new Map<string, { hand: HandPose; button: Button }>();
  private readonly pointers = new Map<number, { x: number; y: number; button: number; dragged: boolean }>();
  private readonly fingers = new TwoFingers();
  private lastSentMs = 0;

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
    // Nobody sees the field of a hidden page.
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'hidden') this.releaseAll();
    });
  }

  setActive(hand: number): void {
    if (hand !== this.active) {
      this.hands[this.active]!.latchHeld();
      this.pressing.clear();
    }
    this.active = hand;
    this.actions.changed();
  }

  /** Gives a hand back: its buttons are off, and it glides to where the arm, the motion or its home is. */
  release(hand: number): void {
    const h = this.hands[hand]!;
    if (h.taken) this.link.sendCommand('release', sideOf(hand));
    h.release();
    this.actions.changed();
  }

  releaseAll(): void {
    this.hands.forEach((_, hand) => this.release(hand));
    this.pressing.clear();
  }

  /** Buttons of the screen, for touch: on while a finger is on them. */
  press(button: Button, on: boolean): void {
    if (on && !this.take()) return;
    this.hands[this.active]!.hold(button, on);
    this.actions.changed();
  }

  /** Latches a hand's button, or lets it go. */
  toggleLatch(hand: number, button: Button): void {
    if (!this.take(hand)) return;
    const h = this.hands[hand]!;
    h.latch(button, !h.on(button));
    this.actions.changed();
  }

  /** What panels show of each hand. */
  view(): HandState[] {
    return this.hands.map((h) => ({
      taken: h.taken,
      buttons: ([1, 2] as const).map((b) => ({ on: h.on(b), latched: h.latched(b) })),
    }));
  }

  /** Hands keep their own time: a slow picture must not make them slow. */
  start(): void {
    let last = performance.now();
    setInterval(() => {
      const now = performance.now();
      this.update(Math.min(0.1, (now - last) / 1000), now);
      last = now;
    }, sendPeriodMs);
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

  private take(hand = this.active): boolean {
    if (!this.mayDrive) return false;
    const h = this.hands[hand]!;
    if (h.taken) return true;
    const pose = this.tools.toolPose(hand);
    if (!pose) return false;
    h.take(pose.p, pose.q);
    this.actions.changed();
    return true;
  }

  private shift(by: THREE.Vector3): void {
    if (this.take()) this.hands[this.active]!.move(by, this.scope.homeTarget);
  }

  private applyKeys(dt: number): void {
    const down = new Set(this.keys.values());
    const on = (key: string) => (down.has(key) ? 1 : 0);
    if (![...down].some((k) => moving.has(k)) || !this.take()) return;
    const { x, y, z } = this.scope.axes();
    const fine = on('shift') ? 0.3 : 1;
    const s = keyboardMPerS * fine * dt;
    const by = new THREE.Vector3()
      .addScaledVector(z, (on('s') - on('w')) * s)
      .addScaledVector(x, (on('arrowright') - on('arrowleft')) * s)
      .addScaledVector(y, (on('arrowup') - on('arrowdown')) * s);
    this.shift(by);
    const h = this.hands[this.active]!;
    const a = keyboardRadPerS * fine * dt;
    h.turn(h.shaft(), (on('e') - on('q')) * a);
    h.turn(y, (on('d') - on('a')) * a);
    h.turn(x, (on('f') - on('r')) * a);
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
    if (step.kind === 'zoom') {
      this.scope.zoom(1 / Math.max(0.2, step.by));
      return;
    }
    if (!this.take()) return;
    const h = this.hands[this.active]!;
    const { y, z } = this.scope.axes();
    if (step.kind === 'depth') this.shift(z.multiplyScalar(step.by * touchDepthMPerPx));
    else if (step.kind === 'swing') h.turn(y, step.by * touchSwingRadPerPx);
    // Clockwise on the screen is a negative turn about the axis to the viewer.
    else h.turn(h.shaft().dot(z) >= 0 ? h.shaft() : h.shaft().negate(), -step.by);
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
    this.fingers.clear();
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    const clicks = Math.max(-3, Math.min(3, (e.deltaY || e.deltaX) / 100));
    if (e.shiftKey) this.shift(this.scope.axes().z.multiplyScalar(clicks * wheelM));
    else this.scope.zoom(1.12 ** clicks);
  }

  private key(e: KeyboardEvent, down: boolean): void {
    if (!down) return this.keyUp(e.code);
    const key = keyOf(e);
    if (isTyping(e.target) || e.ctrlKey || e.metaKey || e.altKey) return;
    if (isControl(e.target) && (key === 'space' || key === 'enter' || key === 'tab' || arrows.has(key))) return;
    if (moving.has(key) || key === 'shift') {
      this.keys.set(e.code, key);
      if (key !== 'shift') e.preventDefault();
      return;
    }
    const button = buttonOf[key];
    if (button) {
      e.preventDefault();
      if (!e.repeat) this.pressKey(e.code, button);
      return;
    }
    if (e.repeat) return;
    // Shift and Tab, and Escape, lead out of the field to the controls.
    if (key === 'tab' && !e.shiftKey) {
      e.preventDefault();
      this.setActive(1 - this.active);
    } else if (key === 'escape' && !isControl(e.target)) this.actions.leaveField();
    else this.command(key, e.shiftKey);
  }

  private keyUp(code: string): void {
    this.keys.delete(code);
    const pressed = this.pressing.get(code);
    if (!pressed) return;
    this.pressing.delete(code);
    pressed.hand.hold(pressed.button, false);
    this.actions.changed();
  }

  /** The key of a latched button lets it go. */
  private pressKey(code: string, button: Button): void {
    if (!this.take()) return;
    const hand = this.hands[this.active]!;
    if (hand.latched(button)) hand.latch(button, false);
    else {
      hand.hold(button, true);
      this.pressing.set(code, { hand, button });
    }
    this.actions.changed();
  }

  private command(key: string, shift: boolean): void {
    const focus = () => {
      const t = this.tools.toolPose(this.active);
      if (t) this.scope.focus(t.p);
    };
    const commands: Record<string, () => void> = {
      '1': () => this.setActive(0),
      '2': () => this.setActive(1),
      g: () => this.release(this.active),
      v: () => this.scope.reset(),
      c: focus,
      p: () => this.actions.togglePause(),
      t: () => this.actions.nextTool(this.active, shift ? -1 : 1),
      h: () => this.actions.toggleHelp(),
      '?': () => this.actions.toggleHelp(),
    };
    commands[key]?.();
  }

  /** The window has lost the keys: what they held is let go, what is latched stays. */
  private letGo(): void {
    this.keys.clear();
    this.pressing.clear();
    this.pointers.clear();
    for (const h of this.hands) h.letGoHeld();
    this.actions.changed();
  }
}
