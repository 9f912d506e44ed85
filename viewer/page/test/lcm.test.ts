// SPDX-License-Identifier: GPL-3.0-or-later
// The generated codec against bytes and fingerprints made by lcm-gen's Python encoder (lcm_known_bytes.json).
import { describe, expect, it } from 'vitest';
import * as lcm from '../src/lcm';
import known from './lcm_known_bytes.json';

type AnyCodec = lcm.Codec<unknown>;
const isCodec = (v: unknown): v is AnyCodec => typeof v === 'object' && v !== null && 'fingerprint' in v;
const codecs = (Object.values(lcm) as unknown[]).filter(isCodec);
const hex = (b: Uint8Array) => [...b].map((x) => x.toString(16).padStart(2, '0')).join('');
const bytes = (s: string) => Uint8Array.from(s.match(/../g)!.map((x) => parseInt(x, 16)));

describe('lcm codec', () => {
  it('has the fingerprints of lcm-gen', () => {
    expect(Object.fromEntries(codecs.map((c) => [c.name, c.fingerprint.toString(16).padStart(16, '0')]))).toEqual(
      known.fingerprints,
    );
  });

  it.each(Object.entries(known.bytes))('%s: decodes and encodes back to the same bytes', (name, text) => {
    const codec = codecs.find((c) => c.name === name)!;
    expect(hex(codec.encode(codec.decode(bytes(text))))).toBe(text);
  });

  it('reads values, not only bytes', () => {
    const f = lcm.render_frame_t.decode(bytes(known.bytes.render_frame_t));
    expect(f.session).toBe(1795254564745000n);
    expect(f.paused).toBe(true);
    expect([...f.body[0]!.x_m]).toEqual([0.5, 0.25, -1, 2, 4, 8]);
    expect([f.channel[0], f.channel[1], f.channel[2]]).toEqual([0.25, NaN, -2]);
    expect(f.drawable.map((d) => [d.index, ...d.data])).toEqual([[1, 1, 2, 3, -1, 4, 5, 6, -1], [2]]);
    expect(f.tool[0]!.hand).toBe(-1);
    expect([f.tool[0]!.state, f.tool[0]!.opening_rad]).toEqual([2, 0.25]);
    expect([...f.tool[0]!.q]).toEqual([0.5, 0.5, 0.5, 0.5]);
    expect(f.hud_json).toBe('{"goals":[]}');
    expect(lcm.user_command_t.decode(bytes(known.bytes.user_command_t))).toEqual({
      time_us: -5n,
      sender: 'viewer-1',
      command: 'pause',
      argument: 'ä€',
    });
    expect(lcm.device_state_t.decode(bytes(known.bytes.device_state_t)).hand[0]!.device).toBe('mouse');
  });

  it('refuses every truncation, a wrong fingerprint, left-over bytes and absurd counts', () => {
    const whole = bytes(known.bytes.render_frame_t);
    for (let n = 0; n < whole.length; n++) expect(() => lcm.render_frame_t.decode(whole.subarray(0, n))).toThrow();
    expect(() => lcm.render_frame_t.decode(Uint8Array.from([...whole, 0]))).toThrow(/left over/);
    expect(() => lcm.hand_input_t.decode(whole)).toThrow(/fingerprint/);
    const huge = whole.slice();
    huge.set([0x7f, 0xff, 0xff, 0xff], 8 + 8 * 3 + 8 + 1); // bodies
    expect(() => lcm.render_frame_t.decode(huge)).toThrow();
    huge.set([0xff, 0xff, 0xff, 0xff], 8 + 8 * 3 + 8 + 1);
    expect(() => lcm.render_frame_t.decode(huge)).toThrow();
  });

  it('survives random damage: a message or an error, never anything else', () => {
    const whole = bytes(known.bytes.render_frame_t);
    let seed = 1;
    const random = (n: number) => (seed = (seed * 48271) % 2147483647) % n;
    let decoded = 0;
    for (let k = 0; k < 3000; k++) {
      const b = whole.slice();
      for (let j = 0; j <= random(4); j++) b[8 + random(b.length - 8)] = random(256);
      try {
        lcm.render_frame_t.decode(b);
        decoded++;
      } catch (e) {
        expect(e instanceof RangeError || e instanceof TypeError).toBe(true);
      }
    }
    expect(decoded).toBeGreaterThan(0);
  });

  it('will not encode arrays that disagree with their counts', () => {
    const f = lcm.render_frame_t.make();
    f.channels = 2;
    expect(() => lcm.render_frame_t.encode(f)).toThrow(/channel/);
  });
});
