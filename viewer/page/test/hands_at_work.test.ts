// SPDX-License-Identifier: GPL-3.0-or-later
// When an author's hand is at work in the studio: what others change meanwhile overtakes it.
import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { handsAtWork } from '../src/studio/hands_at_work';

class Field extends EventTarget {
  constructor(readonly type: string) {
    super();
  }
}

let root: EventTarget;
let atWork: boolean;

const happens = (where: EventTarget, what: string, more: object = {}) =>
  where.dispatchEvent(Object.assign(new Event(what), more));
/** An event of a field, as it arrives at the root. */
const inField = (type: string, what: string) => {
  const event = new Event(what);
  Object.defineProperty(event, 'target', { value: new Field(type) });
  root.dispatchEvent(event);
};
const later = () => new Promise((r) => setTimeout(r, 5));

beforeEach(() => {
  const page = Object.assign(new EventTarget(), { setTimeout: (f: () => void) => setTimeout(f) });
  vi.stubGlobal('window', page);
  vi.stubGlobal('HTMLInputElement', Field);
  root = new EventTarget();
  atWork = false;
  handsAtWork(
    root as HTMLElement,
    () => (atWork = true),
    () => (atWork = false),
  );
});
afterEach(() => vi.unstubAllGlobals());

test('a drag counts until what its release asks for is asked', async () => {
  happens(root, 'pointerdown');
  happens(window, 'pointermove', { buttons: 1 });
  expect(atWork).toBe(true);
  happens(window, 'pointerup');
  expect(atWork).toBe(true);
  await later();
  expect(atWork).toBe(false);
});

test('a drag that is released outside of the page ends when the hand is back', async () => {
  happens(root, 'pointerdown');
  happens(window, 'pointermove', { buttons: 0 });
  await later();
  expect(atWork).toBe(false);
});

test('a text counts from its first letter until it is taken or left, whatever is pressed meanwhile', async () => {
  inField('text', 'input');
  expect(atWork).toBe(true);
  happens(root, 'pointerdown');
  happens(window, 'pointerup');
  await later();
  expect(atWork).toBe(true);
  inField('text', 'change');
  expect(atWork).toBe(false);
  inField('number', 'input');
  inField('number', 'focusout');
  expect(atWork).toBe(false);
  inField('checkbox', 'input');
  expect(atWork).toBe(false);
});
