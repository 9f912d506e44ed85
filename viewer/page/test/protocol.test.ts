// SPDX-License-Identifier: GPL-3.0-or-later
// Framing of packets, options of the address line, HUD text.
import { describe, expect, it } from 'vitest';
import { clockText, forceBar, forceLevel, parseHud } from '../src/hud/state';
import { parseOptions } from '../src/options';
import { pack, unpack } from '../src/protocol';

describe('protocol', () => {
  it('packs as length, name, payload', () => {
    const b = pack('AB', Uint8Array.from([1, 2, 3]));
    expect([...b]).toEqual([2, 65, 66, 1, 2, 3]);
    const p = unpack(b)!;
    expect(p.channel).toBe('AB');
    expect([...p.payload]).toEqual([1, 2, 3]);
  });

  it('unpacks views with an offset and empty payloads', () => {
    const outer = Uint8Array.from([9, 9, 1, 88]);
    expect(unpack(outer.subarray(2))).toEqual({ channel: 'X', payload: new Uint8Array(0) });
  });

  it('refuses what is no packet', () => {
    for (const bad of [[], [0], [0, 1], [3, 65, 66], [2, 65, 7], [1, 200]])
      expect(unpack(Uint8Array.from(bad))).toBeNull();
    expect(() => pack('', new Uint8Array(0))).toThrow();
    expect(() => pack('ä', new Uint8Array(0))).toThrow();
    expect(() => pack('A'.repeat(256), new Uint8Array(0))).toThrow();
  });
});

describe('options', () => {
  it('reads the address line', () => {
    const plain = { ghost: '', stereo: 'off', angleDeg: 5, infrared: false, depth: true };
    expect(parseOptions('?role=instructor&quality=ultra&nohud&t=4.5')).toEqual({
      role: 'instructor',
      quality: 'ultra',
      hud: false,
      freezeAtS: 4.5,
      ...plain,
    });
    expect(parseOptions('')).toEqual({ role: 'trainee', quality: null, hud: true, freezeAtS: null, ...plain });
    expect(parseOptions('?role=king&quality=best&t=soon')).toEqual({
      role: 'trainee',
      quality: null,
      hud: true,
      freezeAtS: null,
      ...plain,
    });
    expect(parseOptions('?stereo=anaglyph&angle=3&icg')).toMatchObject({
      stereo: 'anaglyph',
      angleDeg: 3,
      infrared: true,
    });
    expect(parseOptions('?stereo=hologram&angle=900')).toMatchObject({ stereo: 'off', angleDeg: 9 });
  });
});

describe('hud text', () => {
  it('reads the exercise state', () => {
    const s = parseHud(
      '{"goals":[{"id":"a","text":"A","done":true}],"faults":[{"id":"f","count":2,"times_s":[1.5,null]}],' +
        '"state":"running","elapsed_s":61.25,"mode":"test","report":"/r/report.html","recording":"/s/a.insula"}',
    )!;
    expect(s.goals).toEqual([{ id: 'a', text: 'A', done: true }]);
    expect(s.faults).toEqual([{ id: 'f', text: 'f', count: 2, timesS: [1.5], advice: '' }]);
    expect([s.mode, s.report]).toEqual(['test', '/r/report.html']);
    expect([s.recording, s.unrecorded]).toEqual(['/s/a.insula', '']);
    expect([s.elapsedS, s.message]).toEqual([61.25, '']);
  });

  it('bears nonsense', () => {
    expect(parseHud('{')).toBeNull();
    expect(parseHud('7')).toBeNull();
    expect(parseHud('{"goals":{"a":1},"faults":[null,3],"elapsed_s":"late"}')).toMatchObject({
      goals: [],
      faults: [],
      elapsedS: null,
    });
  });

  it('shows time and force', () => {
    expect([clockText(0), clockText(61.25), clockText(-3)]).toEqual(['0:00.0', '1:01.3', '0:00.0']);
    expect(forceBar(3.3)).toBe(1);
    expect(forceBar(50)).toBe(1);
    expect(forceBar(0.825)).toBeCloseTo(0.5, 12);
    expect([0.1, 0.3, 0.6].map(forceLevel)).toEqual(['good', 'high', 'too_much']);
  });
});
