// SPDX-License-Identifier: GPL-3.0-or-later
// Channels, drawables and materials: what scene.json declares, what frames bring, and what is wrong with either.
import { describe, expect, it } from 'vitest';
import { chartGroups } from '../src/hud/channel_curves';
import { tableOf } from '../src/hud/vitals';
import { fluidLook } from '../src/materials/fluid_look';
import { labelText } from '../src/drawables/shapes';
import { tubeIndices } from '../src/drawables/tubes';
import * as lcm from '../src/lcm';
import { Playback } from '../src/playback';
import { barShare, Channels, channelText, isShare, level, numberText, shortName } from '../src/step_data/channels';
import {
  type ChannelData,
  type DrawableData,
  materialOf,
  parseChannels,
  parseDrawables,
  parseMaterials,
} from '../src/step_data/declarations';
import { checkDrawable, elements, mixDrawable } from '../src/step_data/drawable_data';

const mmHg = { unit: 'mmHg', scale: 0.0075, digits: 0 };
const text = [
  {
    id: 'suture.tension',
    unit: 'N',
    size: 1,
    offset: 0,
    shown: 'curve',
    display: { unit: 'mN', scale: 1000, digits: 1 },
  },
  { id: 'suture.pull', unit: 'N', size: 3, offset: 1 },
  { id: 'net.a.pressure', unit: 'Pa', size: 1, offset: 4, group: 'a', shown: 'vital', display: mmHg },
  { id: 'net.a.share', unit: '1', size: 1, offset: 5, group: 'a', shown: 'vital', min: 0, max: 1 },
  { id: 'net.b.share', unit: '1', size: 1, offset: 6, group: 'b', shown: 'vital', min: 0, max: 1 },
  { id: 'net.left', unit: '1', size: 1, offset: 7, shown: 'vital', max: 67, display: { digits: 0 } },
];

describe('declared channels', () => {
  it('are read with what they leave out', () => {
    const [tension, pull, pressure] = parseChannels(text);
    expect([tension!.component, tension!.name, tension!.shown, tension!.min]).toEqual([
      'suture',
      'tension',
      'curve',
      null,
    ]);
    expect([pull!.display, pull!.shown, pull!.bands]).toEqual([{ unit: 'N', scale: 1, digits: 2 }, 'none', null]);
    expect([pressure!.name, shortName(pressure!)]).toEqual(['a.pressure', 'pressure']);
    expect(parseChannels(undefined)).toEqual([]);
  });

  it('say which entry is wrong, and why', () => {
    expect(() => parseChannels({})).toThrow('channels is not a list');
    expect(() => parseChannels([7])).toThrow('channels[0] is not an object');
    expect(() => parseChannels([{ size: 1 }])).toThrow('channels[0].id is missing');
    expect(() => parseChannels([{ id: 'a.b', size: 2, offset: 0 }])).toThrow('channel a.b has size 2');
    expect(() => parseChannels([{ ...text[0] }, { ...text[1], offset: 2 }])).toThrow(
      'suture.pull has offset 2, expected 1',
    );
  });
});

describe('channels of a frame', () => {
  const channels = new Channels(parseChannels(text));
  const numbers = Float32Array.from([0.02, 3, 4, 0, 16000, 0.5, NaN, 24]);

  it('are found by name; vectors by their length', () => {
    channels.read(numbers);
    expect(channels.value('suture.tension')).toBeCloseTo(0.02, 8);
    expect(channels.value('suture.pull')).toBe(5);
    expect(channels.value('nobody.knows')).toBeNull();
  });

  it('bear what is not known: NaN and infinity are gaps, not numbers', () => {
    channels.read(Float32Array.from([Infinity, 3, NaN, 0, 1, 1, NaN, 1]));
    expect(['suture.tension', 'suture.pull', 'net.b.share'].map((id) => channels.value(id))).toEqual([
      null,
      null,
      null,
    ]);
    expect(channelText(channels.find('suture.tension')!, null)).toBe('–');
  });

  it('are refused when their count is wrong; then nothing is known', () => {
    channels.read(numbers);
    expect(() => channels.read(numbers.subarray(1))).toThrow('7 numbers of channels, the scene declares 8');
    expect(channels.value('suture.tension')).toBeNull();
  });

  it('are written as declared: units, bars, counts, no minus before zero', () => {
    const [tension, , pressure, share, , left] = channels.all as [never, never, never, never, never, never];
    expect([channelText(tension, 0.0203), channelText(pressure, 16000), channelText(left, 24)]).toEqual([
      '20.3 mN',
      '120 mmHg',
      '24 of 67',
    ]);
    expect([numberText(pressure, -3), numberText(tension, -1e-9)]).toEqual(['0', '0.0']);
    const percent = { ...(share as ChannelData), max: null, display: { unit: '%', scale: 100, digits: 0 } };
    expect([isShare(percent), barShare(percent, 0.25)]).toEqual([true, 0.25]);
    expect([isShare(share), isShare(left), isShare(pressure), barShare(share, 0.5), barShare(share, 7)]).toEqual([
      true,
      false,
      false,
      0.5,
      1,
    ]);
  });

  it('have the colour of their bands', () => {
    const c = { ...channels.all[0]!, bands: { good: [0.8, null], high: [0.5, 2] } } as never;
    expect([0.9, 0.6, 0.1, null].map((v) => level(c, v))).toEqual(['good', 'high', 'too_much', 'none']);
    expect(level(channels.all[0]!, 1)).toBe('none');
  });

  it('are laid out by group, and charted by component and unit', () => {
    const { lines, columns, rows } = tableOf(channels.all.filter((c) => c.component === 'net'));
    expect([lines.map((c) => c.id), columns]).toEqual([['net.left'], ['pressure', 'share']]);
    expect(rows.map((r) => [r.group, ...r.cells.map((c) => c?.id ?? null)])).toEqual([
      ['a', 'net.a.pressure', 'net.a.share'],
      ['b', null, 'net.b.share'],
    ]);
    expect(chartGroups(channels.all).map((g) => g.map((c) => c.id))).toEqual([
      ['suture.tension'],
      ['suture.pull'],
      ['net.a.pressure'],
      ['net.a.share', 'net.b.share', 'net.left'],
    ]);
  });
});

const line = { id: 'suture.thread', kind: 'polylines', material: 'nylon', points_per_line: 2 };
const one = (d: object): DrawableData => parseDrawables([d])[0]!;

describe('declared drawables', () => {
  it('are read with what they leave out', () => {
    const d = one(line);
    expect([d.index, d.component, d.name, d.pointsPerLine, d.count]).toEqual([0, 'suture', 'thread', 2, 0]);
    expect(d.radiusM).toBeGreaterThan(0);
  });

  it('say which entry is wrong, and why', () => {
    expect(() => one({ kind: 'points' })).toThrow('drawables[0].id is missing');
    expect(() => one({ id: 'a.b', kind: 'cloud' })).toThrow('drawable a.b has kind "cloud", not one of points');
    expect(() => one({ ...line, points_per_line: 1 })).toThrow('points_per_line is 1');
    expect(() => one({ id: 'a.b', kind: 'patch', vertices: 3 })).toThrow('drawables[0].triangles is undefined');
    expect(() => one({ id: 'a.b', kind: 'links', parts: [{}] })).toThrow('drawables[0].parts[0].vertices');
  });

  it('have materials as data; unknown names and styles are plain', () => {
    const m = parseMaterials({ nylon: { style: 'hologram', rgba: [0, 1, 0], roughness: 7 } });
    expect(m.get('nylon')).toEqual({
      style: 'hologram',
      rgba: [0, 1, 0, 1],
      roughness: 1,
      metalness: 0,
      translucency: 0,
    });
    expect(materialOf(m, 'silk').style).toBe('solid');
    expect(() => parseMaterials({ nylon: 3 })).toThrow('material nylon is not an object');
  });
});

describe('numbers of drawables', () => {
  const numbers = (...n: number[]) => Float32Array.from(n);

  it('fit their kind', () => {
    checkDrawable(one(line), numbers(0, 0, 0, 1, 1, 0, 0, 1));
    expect(elements(one(line), numbers(0, 0, 0, 1, 1, 0, 0, 1))).toBe(1);
    checkDrawable(one({ id: 'a.b', kind: 'plane' }), numbers(0, 0, 0, 0, 0, 1, 0.01, NaN));
    checkDrawable(one(line), numbers());
  });

  it('are refused when they are too few, too many or no numbers, with the name of the drawable', () => {
    expect(() => checkDrawable(one(line), numbers(1, 2, 3, 4))).toThrow(
      'suture.thread: 4 numbers are not a multiple of 8',
    );
    expect(() => checkDrawable(one(line), numbers(0, NaN, 0, 1, 1, 0, 0, 1))).toThrow('suture.thread: number 1 is NaN');
    const plane = one({ id: 'a.b', kind: 'plane' });
    expect(() => checkDrawable(plane, new Float32Array(16))).toThrow('a.b: 16 numbers, expected 8');
    const mesh = { vertices: 3, triangles: 1, positions: 'p.bin', indices: 'i.bin' };
    const patch = one({ id: 'a.b', kind: 'patch', ...mesh });
    expect(() => checkDrawable(patch, new Float32Array(8))).toThrow('a.b: 8 numbers, expected 12 of 3 vertices');
    expect(() =>
      checkDrawable(one({ id: 'a.b', kind: 'links', parts: [mesh] }), numbers(0, 0, 0, Infinity, 0, 0, 0, 1)),
    ).toThrow('number 3 is Infinity');
  });

  it('of a line that is gone may be anything', () => {
    checkDrawable(one(line), numbers(NaN, NaN, NaN, -1, NaN, NaN, NaN, -1));
  });

  it('are mixed between frames, except where a line parts or comes', () => {
    const out = new Float32Array(8);
    mixDrawable(one(line), numbers(0, 0, 0, 1, 0, 0, 0, 1), numbers(2, 0, 0, 0.5, 4, 0, 0, -1), 0.5, out);
    expect([...out]).toEqual([1, 0, 0, 0.75, 4, 0, 0, -1]);
    mixDrawable(one(line), numbers(0, 0), numbers(2, 0, 0, 1, 4, 0, 0, 1), 0.5, out);
    expect([...out]).toEqual([2, 0, 0, 1, 4, 0, 0, 1]);
  });

  it('turn the shorter way round', () => {
    const mesh = { vertices: 3, triangles: 1, positions: 'p.bin', indices: 'i.bin' };
    const out = new Float32Array(8);
    const d = one({ id: 'a.b', kind: 'links', parts: [mesh] });
    mixDrawable(d, numbers(0, 0, 0, 1, 0, 0, 0, 0), numbers(0, 0, 0, -1, 0, 0, 0, 0), 0.5, out);
    expect([...out.subarray(3, 7)].map(Math.abs)).toEqual([1, 0, 0, 0]);
  });

  it('come through the playback checked, each on its own', () => {
    const [thread, knots] = parseDrawables([line, { id: 'suture.knots', kind: 'points' }]);
    const frame = (sequence: bigint, x: number, bad: number[]) =>
      Object.assign(lcm.render_frame_t.make(), {
        sequence,
        drawable: [
          { index: 0, floats: 8, data: numbers(x, 0, 0, 1, x, 1, 0, 1) },
          { index: 1, floats: bad.length, data: Float32Array.from(bad) },
        ],
      });
    const p = new Playback();
    p.push(frame(1n, 0, [0, 0, 0, 0]), 0);
    p.push(frame(2n, 2, [0, 0, 0]), 16);
    expect([...p.drawable(thread!, 0.5)!]).toEqual([1, 0, 0, 1, 1, 1, 0, 1]);
    expect(() => p.drawable(knots!, 0.5)).toThrow('suture.knots: 3 numbers');
    expect(() => p.drawable(knots!, 0.5)).toThrow('suture.knots');
    p.push(frame(3n, 2, [1, 0, 0, 0]), 32);
    expect([...p.drawable(knots!, 1)!]).toEqual([1, 0, 0, 0]);
    expect(p.drawable({ ...thread!, index: 7 }, 1)).toBeNull();
  });
});

describe('shapes', () => {
  it('close tubes around their lines and never across them', () => {
    const t = tubeIndices(2, 3);
    expect(t.length).toBe(2 * 2 * 8 * 6);
    const lineOf = (v: number) => Math.floor(v / 24);
    for (let k = 0; k < t.length; k += 3) expect(new Set([t[k]!, t[k + 1]!, t[k + 2]!].map(lineOf)).size).toBe(1);
  });

  it('write a label with its value', () => {
    expect([labelText('pull {}', 0.12345, 'N'), labelText('{}', NaN, 'N'), labelText('here', 1, '')]).toEqual([
      'pull 0.123 N',
      '–',
      'here',
    ]);
  });

  it("take a fluid's light from its colour, unless it is known better", () => {
    const m = {
      style: 'fluid',
      rgba: [1, 1, 1, 1] as [number, number, number, number],
      roughness: 0,
      metalness: 0,
      translucency: 1,
    };
    expect(fluidLook('blood', m).absorb).toEqual([1500, 8200, 7400]);
    const clear = fluidLook('saline', m);
    const milky = fluidLook('milk', { ...m, translucency: 0 });
    expect(clear.absorb[0]).toBeLessThan(10);
    expect(milky.absorb[0]).toBe(850);
    expect(fluidLook('dye', { ...m, rgba: [0, 1, 0, 1] }).stain[0]).toBeLessThan(1);
  });
});
