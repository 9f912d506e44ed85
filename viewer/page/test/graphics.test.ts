// SPDX-License-Identifier: GPL-3.0-or-later
import { expect, it } from 'vitest';
import { Graphics } from '../src/graphics';

it('says that the picture is gone, advises a reload after ten seconds, and has things drawn anew once', () => {
  const canvas = new EventTarget();
  let now = 1000;
  let drawn = 0;
  const graphics = new Graphics(
    canvas,
    () => drawn++,
    () => now,
  );
  expect(graphics.lost).toBe(false);
  expect(graphics.notice(now)).toBe('');
  canvas.dispatchEvent(new Event('webglcontextlost'));
  expect(graphics.lost).toBe(true);
  expect(graphics.notice(now)).toContain('waiting for it');
  now = 9000;
  canvas.dispatchEvent(new Event('webglcontextlost')); // a second word of the same loss does not begin anew
  expect(graphics.notice(10_999)).toContain('waiting for it');
  expect(graphics.notice(11_000)).toContain('reload the page');
  expect(drawn).toBe(0);
  canvas.dispatchEvent(new Event('webglcontextrestored'));
  expect(graphics.lost).toBe(false);
  expect(graphics.notice(20_000)).toBe('');
  expect(drawn).toBe(1);
});
