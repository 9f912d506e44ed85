// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a replay that stands needs further pictures. It does for a while after each input, since views glide and
// marks fade. Without a graphics card, a jump would otherwise wait for a picture that shows nothing new.

const inputs = ['pointerdown', 'pointerup', 'click', 'dblclick', 'wheel', 'keydown', 'resize', 'visibilitychange'];
/** By then a glide of the microscope is over. */
const stillAfterMs = 1500;

export class Rest {
  private wokenMs = -Infinity;

  constructor(target: EventTarget, canvases: readonly EventTarget[]) {
    const wake = () => this.wake();
    for (const input of inputs) target.addEventListener(input, wake, { capture: true, passive: true });
    target.addEventListener('pointermove', (e) => (e as PointerEvent).buttons !== 0 && wake(), { capture: true });
    for (const canvas of canvases) canvas.addEventListener('webglcontextrestored', wake);
  }

  /** Something changed. */
  wake(nowMs = performance.now()): void {
    this.wokenMs = nowMs;
  }

  still(nowMs: number): boolean {
    return nowMs - this.wokenMs > stillAfterMs;
  }
}
