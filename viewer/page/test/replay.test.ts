// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded sessions as the page reads them: the container, pictures, timeline and clock.
import { beforeAll, describe, expect, it } from 'vitest';
import { make_render_frame_t, render_frame_t, sim_event_t } from '../src/lcm';
import { extremesByPixel } from '../src/replay/chart';
import { ReplayClock } from '../src/replay/clock';
import { BlobSource } from '../src/replay/byte_source';
import { Container } from '../src/replay/container';
import { GeometryDecoder, GeometryError } from '../src/replay/geometry';
import { keyMoments } from '../src/replay/key_moments';
import { ContainerError, crc32 } from '../src/replay/mcap_records';
import { Pictures } from '../src/replay/pictures';
import { notesJson, parseNotes } from '../src/replay/source';
import { Timeline, valueAt } from '../src/replay/timeline';
import { McapBytes } from './mcap_bytes';

const container = (bytes: Uint8Array) => Container.open(new BlobSource(new Blob([Uint8Array.from(bytes)])));
async function texts(c: Container, topics: string[]): Promise<string[]> {
  const out: string[] = [];
  for await (const m of c.messages(topics)) out.push(`${m.topic} ${m.timeS} ${said(m.data)}`);
  return out;
}
const said = (data: Uint8Array) => new TextDecoder().decode(data);

describe('container', () => {
  const file = () =>
    new McapBytes()
      .channel(1, 'A', { unit: '0.5' })
      .channel(2, 'B')
      .metadata('session', { title: 'Clipping' })
      .attachment('bundle/x', Uint8Array.of(1, 2, 3))
      .chunk([
        { channel: 1, timeS: 0, data: 'a0' },
        { channel: 1, timeS: 1, data: 'a1' },
      ])
      .chunk([{ channel: 2, timeS: 0.5, data: 'b0' }])
      .chunk([{ channel: 1, timeS: 2, data: 'a2' }]);

  const all = ['A 0 a0', 'A 1 a1', 'B 0.5 b0', 'A 2 a2'];

  it('gives the messages of topics in the order of the file, by its summary or without one', async () => {
    const whole = file().end();
    const noSummary = whole.slice();
    noSummary[noSummary.length - 30]! ^= 1;
    for (const bytes of [whole, noSummary]) {
      const c = await container(bytes);
      expect(await texts(c, ['A', 'B'])).toEqual(all);
      expect(c.chunksOf('B')).toHaveLength(1);
      expect(c.chunksOf('A', 1.5)).toHaveLength(1);
      expect(c.unitOf('A')).toBe(0.5);
      expect(c.metadata.get('session')?.get('title')).toBe('Clipping');
      expect([...(await c.attachment('bundle/x'))]).toEqual([1, 2, 3]);
      expect(c.has('bundle/y')).toBe(false);
      await expect(c.attachment('bundle/y')).rejects.toThrow(/missing/);
      expect(c.ended).toBe(true);
      expect(c.damage).toEqual([]);
    }
  });

  it('has the checksum of the standard', () => {
    const check = (s: string) => crc32(new TextEncoder().encode(s));
    expect(check('123456789')).toBe(0xcbf43926);
    expect(['', 'a', 'ab', 'abcd', 'abcde'].map(check)).toEqual([0, 0xe8b7be43, 0x9e83486d, 0xed82cd11, 0x8587d865]);
  });

  it('reads of a file with a summary only what is wanted', async () => {
    const bytes = file().attachment('large', new Uint8Array(4e6)).end();
    const source = new BlobSource(new Blob([Uint8Array.from(bytes)]));
    let read = 0;
    const c = await Container.open({
      size: source.size,
      read: (at, length) => {
        read += length;
        return source.read(at, length);
      },
    });
    expect(await texts(c, ['A', 'B'])).toEqual(all);
    expect(read).toBeLessThan(1e6);
  });

  it('reads what is whole of a file that was cut off, and says so', async () => {
    const whole = file().open();
    const c = await container(whole.subarray(0, whole.length - 20));
    expect(await texts(c, ['A'])).toEqual(['A 0 a0', 'A 1 a1']);
    expect(c.ended).toBe(false);
    expect(c.damage).toEqual(['the file is cut off or damaged; what is before can be seen']);
  });

  it('leaves out a damaged chunk and says which', async () => {
    const bytes = file().end();
    bytes[bytes.findIndex((_, k) => bytes[k] === 0x61 && bytes[k + 1] === 0x31)]! ^= 1;
    const c = await container(bytes);
    expect(await texts(c, ['A'])).toEqual(['A 2 a2']);
    expect(c.damage).toEqual(['0.0 s to 1.0 s is damaged']);
  });

  it('refuses what is no recording, and survives any damage', async () => {
    await expect(container(new Uint8Array(100))).rejects.toThrow(ContainerError);
    const good = file().end();
    let random = 7;
    const next = (n: number) => (random = (random * 48271) % 2147483647) % n;
    for (let k = 0; k < 2000; k++) {
      const bytes = good.slice(0, k % 2 === 0 ? good.length : 8 + next(good.length - 8));
      for (let n = 0; n < 3; n++) bytes[8 + next(bytes.length - 8)] = next(256);
      const c = await container(bytes);
      expect((await texts(c, ['A', 'B'])).length).toBeLessThanOrEqual(4);
    }
  });
});

/** One body with three coded numbers; differences of one byte. */
const geometry = (key: boolean, zigzags: number[]): Uint8Array =>
  Uint8Array.of(key ? 1 : 0, 1, 0, 0, 0, 0, 1, 7, 0, 0, 0, zigzags.length, 0, 0, 0, ...zigzags);

describe('geometry', () => {
  it('adds differences to the picture before', () => {
    const d = new GeometryDecoder(0.5);
    expect([...d.decode(geometry(true, [2, 4, 1])).body[0]!.x_m]).toEqual([0.5, 1, -0.5]);
    const next = d.decode(geometry(false, [1, 0, 2])).body[0]!;
    expect([...next.x_m]).toEqual([0, 1, 0]);
    expect(next.index).toBe(7);
    expect(next.nodes).toBe(1);
  });

  it('needs a complete picture first, and again after a damaged one', () => {
    const d = new GeometryDecoder(1);
    expect(() => d.decode(geometry(false, [0, 0, 0]))).toThrow(GeometryError);
    d.decode(geometry(true, [0, 0, 0]));
    expect(() => d.decode(geometry(false, [0, 0, 0]).subarray(0, 16))).toThrow(GeometryError);
    expect(() => d.decode(geometry(false, [0, 0, 0]))).toThrow(/before is missing/);
  });
});

const frame = (simTimeS: number): Uint8Array =>
  render_frame_t.encode({ ...make_render_frame_t(), sim_time_s: simTimeS });

/** Pictures at 0, 0.1 and 0.2 s, then at 2 s, after a reset. x counts them in metres. */
async function pictures(): Promise<Pictures> {
  const bytes = new McapBytes()
    .channel(1, 'FRAME')
    .channel(2, 'GEOMETRY', { unit: '1' })
    .chunk([
      { channel: 1, timeS: 0, data: frame(0) },
      { channel: 2, timeS: 0, data: geometry(true, [0, 0, 0]) },
      { channel: 1, timeS: 0.1, data: frame(0.1) },
      { channel: 2, timeS: 0.1, data: geometry(false, [2, 0, 0]) },
      { channel: 1, timeS: 0.2, data: frame(0.2) },
      { channel: 2, timeS: 0.2, data: geometry(false, [2, 0, 0]) },
    ])
    .chunk([
      { channel: 1, timeS: 2, data: frame(0) },
      { channel: 2, timeS: 2, data: geometry(true, [6, 0, 0]) },
    ])
    .end();
  return new Pictures(await container(bytes));
}

describe('pictures', () => {
  const x = async (p: Pictures, t: number) => {
    const m = (await p.at(t))!;
    return [m.before.frame.body[0]!.x_m[0], m.after.frame.body[0]!.x_m[0], m.share];
  };
  it('are found by time, with the place between them, in any order', async () => {
    const p = await pictures();
    expect(await x(p, 0.15)).toEqual([1, 2, expect.closeTo(0.5)]);
    expect(await x(p, 5)).toEqual([3, 3, 0]);
    expect(await x(p, 0.05)).toEqual([0, 1, expect.closeTo(0.5)]);
    expect(await x(p, -1)).toEqual([0, 1, 0]);
  });
  it('do not move from before a reset to after it', async () => {
    expect(await x(await pictures(), 1)).toEqual([2, 2, 0]);
  });
});

describe('timeline', () => {
  const metrics = (pass: number, time: number, value: number) =>
    JSON.stringify({ pass, time_s: time, metrics: [{ id: 'path', hand: 'left', unit: 'm', value }] });
  const event = (kind: string) =>
    sim_event_t.encode({
      ...{ session: 0n, sequence: 1n, time_us: 0n, sim_time_s: 1, kind, id: 'x', text: 'Too deep', value: 0, hand: -1 },
    });
  const review = {
    ...{ group: 'experts', sessions: 12, earlier_runs: 1 },
    to_work_on: [{ text: 'Path', value: '9 mm', low: '1 mm', high: '3 mm', worst_s: 1.5 }, { text: 'Tremor' }],
    comparison: [{ text: 'Time', now: '40 s', last: '50 s', best: '45 s', change: 1 }],
  };
  const recorded = () =>
    new McapBytes()
      .channel(1, 'SIM_EVENT')
      .channel(2, 'HANDS')
      .channel(3, 'METRICS')
      .channel(4, 'CHANNELS')
      .channel(5, 'REVIEW')
      .metadata('channels', { '0000': 'artery.flow m^3/s' })
      .metadata('metrics', { path: 'Length of the path' })
      .chunk([
        { channel: 2, timeS: 0.1, data: '[0.1,0.5,null,0.02]' },
        { channel: 4, timeS: 0.1, data: '[0.1,3e-6]' },
        { channel: 1, timeS: 0.4, data: event('fault') },
        { channel: 3, timeS: 1, data: metrics(1, 1, 0.2) },
        { channel: 3, timeS: 5, data: metrics(2, 1.5, 0.1) },
        { channel: 1, timeS: 6, data: event('fault') },
        { channel: 1, timeS: 7, data: event('goal') },
        { channel: 3, timeS: 8, data: 'no json' },
        { channel: 5, timeS: 8, data: JSON.stringify({ pass: 2, review }) },
        { channel: 5, timeS: 8.5, data: '{"pass": 3}' },
      ])
      .end();
  let t: Timeline;
  beforeAll(async () => {
    t = await Timeline.read(await container(recorded()));
  });
  it('has curves of hands, metrics and channels', () => {
    expect(valueAt(t.hands[0]!, 0.2)).toBe(0.5);
    expect(valueAt(t.hands[1]!, 0.2)).toBeNaN();
    expect(valueAt(t.hands[0]!, 0.05)).toBeNaN();
    expect(t.metrics.map((m) => [m.text, m.unit, ...m.values])).toEqual([
      ['Length of the path, left hand', 'm', 0.2, 0.1],
    ]);
    expect(t.channels.map((c) => [c.id, c.unit, c.values[0]])).toEqual([['artery.flow', 'm^3/s', 3e-6]]);
  });
  it('has key moments: what happened first, the largest forces, the end', () => {
    expect(keyMoments(t, null, 9).map((m) => [m.timeS, m.text, m.bad])).toEqual([
      [0.1, 'Largest force, left hand: 0.50 N', false],
      [0.4, 'Too deep', true],
      [7, 'Too deep', false],
      [9, 'The end', false],
    ]);
  });
  it('has what the engine found of a pass, at times of the recording', () => {
    const found = t.reviews[0]!;
    expect([found.pass, found.group, found.sessions, found.earlierRuns]).toEqual([2, 'experts', 12, 1]);
    expect(found.toWorkOn.map((w) => [w.text, w.worstS])).toEqual([
      ['Path', 5],
      ['Tremor', null],
    ]);
    expect(found.comparison[0]).toEqual({ text: 'Time', now: '40 s', last: '50 s', best: '45 s', change: 1 });
    expect(t.reviews[1]).toMatchObject({ pass: 3, group: '', toWorkOn: [], comparison: [] });
    expect(keyMoments(t, found, 9).map((m) => m.text)).toContain('To work on: Path');
  });
  it('goes from fault to fault, and knows when the exercise began', () => {
    expect(t.fault(0, 1)?.timeS).toBe(0.4);
    expect(t.fault(0.4, 1)?.timeS).toBe(6);
    expect(t.fault(6, 1)).toBeNull();
    expect(t.fault(6, -1)?.timeS).toBe(0.4);
    expect(t.passesS).toEqual([0, 3.5]);
  });
});

describe('clock', () => {
  it('runs at its speed, stands at the end, and starts again from there', () => {
    const c = new ReplayClock(10);
    c.advance(1);
    expect(c.timeS).toBe(0);
    c.toggle();
    c.changeSpeed(1);
    c.advance(2);
    expect(c.timeS).toBe(4);
    c.advance(20);
    expect([c.timeS, c.playing]).toEqual([10, false]);
    c.toggle();
    expect([c.timeS, c.playing]).toEqual([0, true]);
  });
  it('has speeds from a tenth to eight times', () => {
    const c = new ReplayClock(10);
    for (let k = 0; k < 20; k++) c.changeSpeed(-1);
    expect(c.speed).toBe(0.1);
    for (let k = 0; k < 20; k++) c.changeSpeed(1);
    expect(c.speed).toBe(8);
  });
  it('marks a stretch from either end', () => {
    const c = new ReplayClock(10);
    c.seek(4);
    c.mark('from');
    expect(c.stretch).toEqual({ fromS: 4, toS: 10 });
    c.seek(6);
    c.mark('to');
    expect(c.stretch).toEqual({ fromS: 4, toS: 6 });
    c.seek(2);
    c.mark('to');
    expect(c.stretch).toEqual({ fromS: 0, toS: 2 });
  });
});

describe('chart and notes', () => {
  it('keeps the peaks of a pixel', () => {
    const series = { timesS: Float64Array.of(0, 0.01, 0.02, 9), values: Float64Array.of(1, 7, NaN, 2) };
    expect(extremesByPixel(series, 10, 10)).toEqual([
      { x: 0, low: 1, high: 7 },
      { x: 9, low: 2, high: 2 },
    ]);
  });
  it('writes notes and reads them, in order, without what is none', () => {
    const notes = [
      { timeS: 1, text: 'a' },
      { timeS: 2.5, text: 'b' },
    ];
    expect(parseNotes(JSON.parse(notesJson([...notes].reverse())))).toEqual(notes);
    expect(parseNotes([{ time_s: 'x', text: 'a' }, { time_s: 1 }, 3])).toEqual([]);
    expect(parseNotes({})).toEqual([]);
  });
});
