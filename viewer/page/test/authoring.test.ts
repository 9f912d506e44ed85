// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { noticeLines } from '../src/hud/notice';
import { middle, parseInventory } from '../src/inventory';

describe('errors of a saved scene', () => {
  it('are split into place, kind and text', () => {
    expect(
      noticeLines(
        'a b/s.xml:4:38: error: <x> has no parameter "y"; did you mean "z"?\ns.xml: warning: w: x\nplain\n\n',
      ),
    ).toEqual([
      { place: 'a b/s.xml:4:38', kind: 'error', text: '<x> has no parameter "y"; did you mean "z"?' },
      { place: 's.xml', kind: 'warning', text: 'w: x' },
      { place: '', kind: '', text: 'plain' },
    ]);
    expect(noticeLines('')).toEqual([]);
  });
});

describe('inventory', () => {
  const item = {
    group: 'body',
    name: 'b',
    element: 'soft_body',
    size: '1 x 2 x 3 mm',
    values: [['young', '2 kPa'], 'odd'],
    file: 's.xml:1',
    lines_m: [0, 0, 0, 0.002, 0, 0],
    points_m: [0, 0.004, 0],
  };

  it('is read, and what is misshapen is left out', () => {
    const items = parseInventory({
      items: [item, { group: 'x' }, { ...item, name: 'c', lines_m: [1, 2], points_m: 'no', values: 3 }],
    });
    expect(items.map((i) => i.name)).toEqual(['b', 'c']);
    expect(items[0]!.values).toEqual([['young', '2 kPa']]);
    expect(items[0]!.lines.length).toBe(6);
    expect(items[1]!.lines.length).toBe(0);
    expect(items[1]!.values).toEqual([]);
    for (const bad of [null, 3, {}, { items: 'x' }]) expect(parseInventory(bad)).toEqual([]);
  });

  it('says where an item is', () => {
    const [b, c] = parseInventory({ items: [item, { ...item, lines_m: [], points_m: [] }] });
    expect(
      middle(b!)!
        .toArray()
        .map((x) => Math.round(x * 1e6)),
    ).toEqual([1000, 2000, 0]);
    expect(middle(c!)).toBeNull();
  });
});
