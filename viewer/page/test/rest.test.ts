// SPDX-License-Identifier: GPL-3.0-or-later
// When a replay that stands is drawn.
import { describe, expect, it } from 'vitest';
import { Rest } from '../src/replay/rest';

describe('the rest of a replay', () => {
  it('begins a while after the last input', () => {
    const page = new EventTarget();
    const canvas = new EventTarget();
    const rest = new Rest(page, [canvas]);
    const now = performance.now();
    expect(rest.still(now)).toBe(true);
    for (const [target, event] of [
      [page, new Event('keydown')],
      [page, new Event('wheel')],
      [page, Object.assign(new Event('pointermove'), { buttons: 1 })],
      [canvas, new Event('webglcontextrestored')],
    ] as const) {
      rest.wake(-Infinity);
      target.dispatchEvent(event);
      expect(rest.still(now + 1000)).toBe(false);
      expect(rest.still(performance.now() + 1600)).toBe(true);
    }
  });

  it('goes on while the pointer moves without a button', () => {
    const page = new EventTarget();
    const rest = new Rest(page, []);
    page.dispatchEvent(Object.assign(new Event('pointermove'), { buttons: 0 }));
    expect(rest.still(performance.now())).toBe(true);
  });
});
