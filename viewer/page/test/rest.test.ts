// SPDX-License-Identifier: GPL-3.0-or-later
// When a replay that stands is drawn.
import { describe, expect, it } from 'vitest';
import { Rest } from '../src/replay/rest';

describe('the rest of a replay', () => {
  it('ends with one picture, a moment after the last input', () => {
    const page = new EventTarget();
    const rest = new Rest(page, []);
    const now = performance.now();
    expect(rest.due(now)).toBe(false);
    expect(rest.panels(now)).toBe(false);
    for (const event of [new Event('keydown'), Object.assign(new Event('pointermove'), { buttons: 1 })]) {
      page.dispatchEvent(event);
      expect(rest.due(now + 300)).toBe(false);
      expect(rest.due(performance.now() + 450)).toBe(true);
      expect(rest.panels(performance.now() + 450)).toBe(true);
      rest.begin();
      expect(rest.due(Number.MAX_VALUE)).toBe(false);
      expect(rest.panels(performance.now() + 1600)).toBe(false);
    }
  });

  it('is put off by further inputs', () => {
    const rest = new Rest(new EventTarget(), []);
    rest.input(1000);
    rest.input(1200);
    expect(rest.due(1500)).toBe(false);
    expect(rest.due(1600)).toBe(true);
  });

  it('is put off for longer while jumps follow each other', () => {
    const rest = new Rest(new EventTarget(), []);
    rest.jump(1000);
    expect(rest.due(1450)).toBe(true);
    rest.jump(1600);
    expect(rest.due(2350)).toBe(false);
    expect(rest.due(2450)).toBe(true);
    rest.begin();
    rest.jump(4000);
    expect(rest.due(4450)).toBe(true);
  });

  it('ends at once when the picture is no longer right', () => {
    const page = new EventTarget();
    const canvas = new EventTarget();
    const rest = new Rest(page, [canvas]);
    for (const [target, event] of [
      [page, 'resize'],
      [canvas, 'webglcontextrestored'],
    ] as const) {
      target.dispatchEvent(new Event(event));
      expect(rest.due(performance.now())).toBe(true);
      rest.begin();
    }
  });

  it('goes on while the pointer moves without a button', () => {
    const page = new EventTarget();
    const rest = new Rest(page, []);
    page.dispatchEvent(Object.assign(new Event('pointermove'), { buttons: 0 }));
    expect(rest.due(Number.MAX_VALUE)).toBe(false);
  });
});
