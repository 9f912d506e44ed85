// SPDX-License-Identifier: GPL-3.0-or-later
// When a replay that stands is drawn: once after each change, and not between. Without a graphics card, a jump would
// otherwise wait for a picture that shows nothing new.

const inputs = ['pointerdown', 'pointerup', 'click', 'dblclick', 'wheel', 'keydown', 'visibilitychange'];
/** From an input until its picture in full detail. */
const detailAfterMs = 400;
/** The same after jumps that follow each other: the next one should not wait for such a picture. */
const detailAfterJumpsMs = 800;
/** Between jumps that follow each other, at most. */
const jumpsFollowMs = 700;
/** From an input until the panels beside the picture stand. */
const panelsStandAfterMs = 1500;

export class Rest {
  private dueMs = Infinity;
  private inputMs = -Infinity;
  private jumpMs = -Infinity;
  private waitMs = detailAfterMs;

  constructor(target: EventTarget, canvases: readonly EventTarget[]) {
    const input = () => this.input();
    for (const name of inputs) target.addEventListener(name, input, { capture: true, passive: true });
    target.addEventListener('pointermove', (e) => (e as PointerEvent).buttons !== 0 && input(), { capture: true });
    target.addEventListener('resize', () => this.wake());
    for (const canvas of canvases) canvas.addEventListener('webglcontextrestored', () => this.wake());
  }

  /** A person did something: a picture comes when there is no further input for a moment. */
  input(nowMs = performance.now()): void {
    this.inputMs = nowMs;
    this.dueMs = nowMs + this.waitMs;
  }

  /** The picture of a jump was drawn in less detail. */
  jump(nowMs = performance.now()): void {
    this.waitMs = nowMs - this.jumpMs < jumpsFollowMs ? detailAfterJumpsMs : detailAfterMs;
    this.jumpMs = nowMs;
    this.input(nowMs);
  }

  /** The picture is no longer right. */
  wake(nowMs = performance.now()): void {
    this.inputMs = this.dueMs = nowMs;
  }

  /** Whether a picture is due. */
  due(nowMs: number): boolean {
    return nowMs >= this.dueMs;
  }

  /** A picture in full detail begins: it shows all that has happened. */
  begin(): void {
    this.dueMs = Infinity;
    this.waitMs = detailAfterMs;
  }

  /** Panels may still change. */
  panels(nowMs: number): boolean {
    return nowMs - this.inputMs < panelsStandAfterMs;
  }
}
