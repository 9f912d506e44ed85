// SPDX-License-Identifier: GPL-3.0-or-later
// The page's graphics context, which a browser takes away when the graphics card resets or runs out of memory. three
// asks for it back; here is kept whether it is gone, and what must be drawn anew once it is there again.
import { text } from './languages/text';

export class Graphics {
  private lostMs: number | null = null;

  /**
   * restored: what was drawn into textures is lost with the context and has to be made again; what was uploaded three
   * sees to.
   */
  constructor(canvas: EventTarget, restored: () => void, now: () => number = () => performance.now()) {
    canvas.addEventListener('webglcontextlost', () => {
      this.lostMs ??= now();
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.lostMs = null;
      restored();
    });
  }

  get lost(): boolean {
    return this.lostMs !== null;
  }

  /**
   * What to say of it, '' when nothing is amiss. Browsers give up on a card that fails again and again: only a reload
   * helps then.
   */
  notice(nowMs: number): string {
    if (this.lostMs === null) return '';
    const soon = nowMs - this.lostMs < 10_000;
    const advice = soon
      ? text('waiting for it; the exercise goes on …')
      : text('reload the page if it does not come back; the exercise goes on');
    return `${text('The graphics card was reset: no picture')}\n${advice}`;
  }
}
