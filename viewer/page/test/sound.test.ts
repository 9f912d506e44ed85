// SPDX-License-Identifier: GPL-3.0-or-later
// What is heard of what: the table of sounds, the settings, the pitch of the heart, alarms, and the limits of each.
import { describe, expect, it } from 'vitest';
import { Alarms } from '../src/sound/alarms';
import { Beats } from '../src/sound/beats';
import { Desk } from '../src/sound/desk';
import { begunMs, count, freshReport } from '../src/sound/meter';
import { ceiling, limited } from '../src/sound/mixer';
import { Poisson } from '../src/sound/poisson';
import { RateLimit } from '../src/sound/rate_limit';
import { defaultSettings, readSettings, writeSettings } from '../src/sound/settings';
import { eventSounds, hasLimits, inflowOf, partingOf, pressureOfPulse, soundOf, voices } from '../src/sound/table';
import { dropsPerSecond, streamOf } from '../src/sound/voices/bleeding';
import { pitchOfPressure } from '../src/sound/voices/heart';
import { makeRandom } from '../src/random';
import { parseChannels, parseDrawables, parseMaterials } from '../src/step_data/declarations';
import { FakeAudio } from './fake_audio';

const mmHg = 133.322;

describe('the table of sounds', () => {
  it('tells cutting from tearing, and clicks of clips from each other', () => {
    const [left, none] = [0, -1];
    expect(partingOf({ kind: 'strand_cut', hand: left })).toEqual({ what: 'strand', by: 'cut' });
    expect(partingOf({ kind: 'strand_torn', hand: none })).toEqual({ what: 'strand', by: 'torn' });
    expect(partingOf({ kind: 'goal', hand: left })).toBeNull();
    // A vein's event says by its hand whether an edge or a pull has parted it.
    expect(partingOf({ kind: 'vein_parted', hand: left })).toEqual({ what: 'vein', by: 'cut' });
    expect(partingOf({ kind: 'vein_parted', hand: none })).toEqual({ what: 'vein', by: 'torn' });
    expect(partingOf({ kind: 'perforator_torn', hand: left })).toEqual({ what: 'artery', by: 'torn' });
    const clips = Object.values(eventSounds).flatMap((s) => (s.clip ? [s.clip] : []));
    expect(new Set(clips).size).toBe(4);
  });

  it('warns of a rupture with the highest priority, and of a fault with the lowest', () => {
    expect(soundOf('rupture')?.alarm).toBe('high');
    expect(soundOf('fault')?.alarm).toBe('low');
  });

  it('keeps silent about what it does not know', () => {
    expect(soundOf('goal')).toBeNull();
    expect(soundOf('constructor')).toBeNull();
  });

  it('finds by declaration what limits have, what beats, and what fluid comes in', () => {
    const bands = { good: [0.75, null], high: [0.5, null] };
    const channels = parseChannels([
      { id: 'pump.phase', unit: '1', size: 1, offset: 0 },
      { id: 'pump.inside', unit: 'Pa', size: 1, offset: 1, shown: 'none' },
      { id: 'pump.mean', unit: 'Pa', size: 1, offset: 2, shown: 'vital' },
      { id: 'net.share', unit: '1', size: 1, offset: 3, shown: 'vital', bands },
      { id: 'net.grade', unit: '1', size: 1, offset: 4, shown: 'none', bands },
    ]);
    expect(channels.filter(hasLimits).map((c) => c.id)).toEqual(['net.share']);
    expect(pressureOfPulse(channels, 'pump.phase')?.id).toBe('pump.mean');
    expect(pressureOfPulse(channels, '')).toBeNull();
    const materials = parseMaterials({ milk: { style: 'fluid' }, silk: { style: 'solid' } });
    const [pool, pane] = parseDrawables([
      { id: 'a.pool', kind: 'plane', material: 'milk', rate_channel: 'a.rate' },
      { id: 'a.pane', kind: 'plane', material: 'silk', rate_channel: 'a.rate' },
    ]);
    expect(inflowOf(pool!, materials)).toBe('a.rate');
    expect(inflowOf(pane!, materials)).toBe('');
  });
});

describe('settings of the sound', () => {
  const store = (kept: string | null) => ({ getItem: () => kept, setItem: () => undefined });

  it('are off at first, and come back as they were', () => {
    expect(readSettings(store(null)).on).toBe(false);
    let kept = '';
    const memory = { getItem: () => kept, setItem: (_: string, v: string) => void (kept = v) };
    const chosen = {
      on: true,
      volume: 0.3,
      groups: { monitor: false, instruments: true, doppler: false, alarms: false, hints: true },
    };
    writeSettings(memory, chosen);
    expect(readSettings(memory)).toEqual(chosen);
  });

  it.each(['{', '7', 'null', '{"on":"yes","volume":7,"groups":[]}'])('survive what a browser may keep: %s', (kept) => {
    expect(readSettings(store(kept))).toEqual(defaultSettings());
  });

  it('survive a browser that keeps nothing', () => {
    const full = () => {
      throw new Error('full');
    };
    expect(readSettings({ getItem: full, setItem: full })).toEqual(defaultSettings());
    expect(() => writeSettings({ getItem: full, setItem: full }, defaultSettings())).not.toThrow();
  });
});

describe('the heart monitor', () => {
  it('falls by an octave when the pressure falls by 60 mmHg, within limits', () => {
    expect(pitchOfPressure(90 * mmHg)).toBeCloseTo(620);
    expect(pitchOfPressure(30 * mmHg)).toBeCloseTo(310);
    expect(pitchOfPressure(75 * mmHg)).toBeLessThan(pitchOfPressure(95 * mmHg));
    expect(pitchOfPressure(0)).toBeCloseTo(310);
    expect(pitchOfPressure(400 * mmHg)).toBeCloseTo(1240);
    expect(pitchOfPressure(null)).toBeCloseTo(620);
  });

  it('beats once at each systole, with the mean pressure of the beat before', () => {
    const beats = new Beats();
    const heard: number[] = [];
    const pressures: (number | null)[] = [];
    for (let k = 0; k < 300; k++) {
      const phase = (k / 60 + 0.5) % 1;
      const beat = beats.read(phase, 80 + 40 * (1 - phase));
      if (!beat) continue;
      heard.push(k);
      pressures.push(beat.pressurePa);
    }
    expect(heard).toEqual([30, 90, 150, 210, 270]);
    expect(pressures[1]).toBeCloseTo(100, 0);
  });

  it('is silent without a pulse', () => {
    const beats = new Beats();
    expect([0.9, null, 0.1, 0.2].map((p) => beats.read(p, null))).toEqual([null, null, null, null]);
  });
});

describe('drops', () => {
  it('fall as often as the rate says, as a Poisson process', () => {
    const drops = new Poisson(makeRandom(3));
    const counts = Array.from({ length: 4000 }, () => {
      let n = 0;
      for (let k = 0; k < 60; k++) n += drops.count(5, 1 / 60);
      return n;
    });
    const mean = counts.reduce((s, n) => s + n, 0) / counts.length;
    const variance = counts.reduce((s, n) => s + (n - mean) ** 2, 0) / counts.length;
    // 4000 seconds: the mean is known within 3 standard errors, 3 sqrt(5 / 4000).
    expect(Math.abs(mean - 5)).toBeLessThan(0.11);
    expect(Math.abs(variance / mean - 1)).toBeLessThan(0.07);
  });

  it('are the same with the same seed, and none falls without a flow', () => {
    const run = () => {
      const drops = new Poisson(makeRandom(11));
      return Array.from({ length: 100 }, () => drops.count(12, 0.05));
    };
    expect(run()).toEqual(run());
    const drops = new Poisson(makeRandom(11));
    expect(Array.from({ length: 1000 }, () => drops.count(0, 1)).every((n) => n === 0)).toBe(true);
  });

  it('are followed by a stream when it bleeds fast', () => {
    expect(dropsPerSecond(0)).toBe(0);
    expect(dropsPerSecond(1e-7)).toBeCloseTo(2);
    expect(dropsPerSecond(1e-5)).toBe(dropsPerSecond(2e-6));
    expect(streamOf(5e-8)).toBeNull();
    expect(streamOf(1e-6)!.level).toBeGreaterThan(1.5 * streamOf(2e-7)!.level);
  });
});

describe('limits', () => {
  it('let through what comes one by one, and a few of what comes at once', () => {
    const limit = new RateLimit(3, 0.2);
    expect([0, 0, 0, 0, 0.1].map((t) => limit.allows(t))).toEqual([true, true, true, false, false]);
    expect([1, 2, 3, 4].map((t) => limit.allows(t))).toEqual([true, true, true, true]);
  });

  it('hold when thirty strands part at once', () => {
    const audio = new FakeAudio();
    const report = freshReport();
    const desk = new Desk(audio as unknown as AudioContext, report);
    for (let k = 0; k < 30; k++) desk.part({ what: 'strand', by: k % 2 ? 'torn' : 'cut' }, performance.now());
    expect(report.by_voice.strand).toBe(voices.strand.most);
    expect(report.left_out).toBe(30 - voices.strand.most);
    expect(audio.starts.length).toBeLessThanOrEqual(2 * voices.strand.most);
    expect(audio.ends).toBe(audio.starts.length);
    audio.currentTime = 1;
    desk.part({ what: 'strand', by: 'cut' }, performance.now());
    expect(report.by_voice.strand).toBe(voices.strand.most + 1);
  });

  it('begin every sound at once', () => {
    const audio = new FakeAudio();
    audio.currentTime = 5;
    const report = freshReport();
    const desk = new Desk(audio as unknown as AudioContext, report);
    desk.click('shut', performance.now());
    desk.beat(null, performance.now());
    desk.hit('bone', 0.5, performance.now());
    expect(audio.starts.every((t) => t === 5)).toBe(true);
    expect(report.played).toBe(3);
  });

  it('measure when the audio begins a sound on the clock of its output', () => {
    const audio = new FakeAudio();
    expect(begunMs(audio, 0.1, 50), 'before the first output: a buffer later').toBe(55);
    // The loudspeaker has 2.000 s at 1000 ms; so 2.025 s leaves it at 1025 ms, and was begun 10 ms before.
    audio.output = { contextTime: 2, performanceTime: 1000 };
    expect(begunMs(audio, 2.025, 1003)).toBeCloseTo(1015, 9);
    expect(begunMs(audio, 2.025, 1020), 'never before it was asked for').toBe(1020);
    const report = freshReport();
    const arrived = performance.now();
    audio.output = { contextTime: 2, performanceTime: arrived + 1e6 };
    count(report, 'clip', arrived, 2.025, audio);
    expect(report.latest_ms).toBeCloseTo(1e6 + 15, 6);
    expect(report).toMatchObject({ played: 1, late: 1, by_voice: { clip: 1 }, device_ms: 10 });
    expect(report.latest_ms_max).toBe(report.latest_ms);
  });

  it('let one suction sound, however many frames say that it goes on', () => {
    const audio = new FakeAudio();
    const desk = new Desk(audio as unknown as AudioContext, freshReport());
    for (let k = 0; k < 600; k++) {
      audio.currentTime = k / 60;
      desk.suck(k % 100 < 50 ? 'air' : 'tissue', 0, 0);
    }
    expect(audio.starts.length).toBe(2);
    desk.suck(null, 0, 0);
    expect(audio.ends).toBe(2);
  });
});

describe('the limiter', () => {
  it('changes nothing that is quiet, and lets nothing above its ceiling', () => {
    expect(limited(0.4)).toBe(0.4);
    expect(limited(-0.4)).toBe(-0.4);
    let last = -Infinity;
    for (let x = -4; x <= 4; x += 0.01) {
      const y = limited(x);
      expect(Math.abs(y)).toBeLessThanOrEqual(ceiling);
      expect(y).toBeGreaterThanOrEqual(last);
      last = y;
    }
  });
});

describe('alarms', () => {
  const run = (alarms: Alarms, present: ReadonlyMap<string, 'medium' | 'high'>, fromS: number, toS: number) => {
    const heard: number[] = [];
    for (let t = fromS; t < toS; t += 0.1)
      if (alarms.watch(present, t)) {
        heard.push(Math.round(t));
        alarms.began('medium', t, 1);
      }
    return heard;
  };

  it('that last sound after a second, and remind after ever longer pauses', () => {
    const alarms = new Alarms();
    expect(run(alarms, new Map([['flow', 'medium']]), 0, 200)).toEqual([1, 21, 61, 141]);
    expect(run(alarms, new Map(), 200, 210)).toEqual([]);
    expect(run(alarms, new Map([['flow', 'medium']]), 210, 215)).toEqual([211]);
  });

  it('do not sound for what passes in a moment', () => {
    expect(run(new Alarms(), new Map([['flow', 'medium']]), 0, 0.8)).toEqual([]);
  });

  it('several at once are one burst', () => {
    const both = new Map([['superior', 'medium'] as const, ['inferior', 'medium'] as const]);
    expect(run(new Alarms(), both, 0, 15)).toEqual([1]);
  });

  it('give way to a higher one alone', () => {
    const alarms = new Alarms();
    expect(alarms.event('low', 0)).toBe(true);
    alarms.began('low', 0, 0.6);
    expect(alarms.event('high', 0.1)).toBe(true);
    alarms.began('high', 0.1, 3);
    expect(alarms.event('medium', 1)).toBe(false);
    expect(alarms.event('medium', 4)).toBe(true);
  });

  it('of the same kind are heard once in a while', () => {
    const alarms = new Alarms();
    expect([0, 1, 2, 5, 7].map((t) => alarms.event('low', t))).toEqual([true, false, false, false, true]);
  });
});
