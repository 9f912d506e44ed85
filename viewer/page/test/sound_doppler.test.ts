// SPDX-License-Identifier: GPL-3.0-or-later
// The sound of a Doppler probe: pitch, volume and side, and from which channels it comes.
import { describe, expect, it } from 'vitest';
import { Desk } from '../src/sound/desk';
import { freshReport } from '../src/sound/meter';
import { dopplers } from '../src/sound/table';
import { sideOf, timbreOf } from '../src/sound/voices/doppler';
import { parseChannels } from '../src/step_data/declarations';
import { FakeAudio } from './fake_audio';

describe('the Doppler probe', () => {
  const flow = (shiftHz: number, depthM: number | null = 0, mixed = false) => ({ shiftHz, depthM, mixed });

  it('has a spectrum up to twice the shift, and is silent below its wall filter', () => {
    expect(timbreOf(flow(2000))!.hz).toBe(4000);
    expect(timbreOf(flow(-2000))).toEqual(timbreOf(flow(2000)));
    expect(timbreOf(flow(40))).toBeNull();
    expect(timbreOf(flow(0))).toBeNull();
    expect(timbreOf(flow(60))!.level).toBeLessThan(0.5 * timbreOf(flow(200))!.level);
  });

  it('is softer by 2 dB for each millimetre, and of faster blood is spread, not louder', () => {
    const loss = timbreOf(flow(2000, 0.003))!.level / timbreOf(flow(2000, 0.001))!.level;
    expect(20 * Math.log10(loss)).toBeCloseTo(-4);
    const [slow, fast] = [timbreOf(flow(1000))!, timbreOf(flow(4000))!];
    expect((fast.level ** 2 * fast.hz) / (slow.level ** 2 * slow.hz)).toBeCloseTo(1, 1);
  });

  it('tells by the side which way the blood goes', () => {
    expect(sideOf(flow(2000))).toBeGreaterThan(0.5);
    expect(sideOf(flow(-2000))).toBeLessThan(-0.5);
    expect(sideOf(flow(2000, 0, true))).toBe(0);
  });

  it('is found by the channels that its component declares', () => {
    const channels = parseChannels([
      { id: 'a.doppler_shift', unit: 'Hz', size: 1, offset: 0, component: 'a' },
      { id: 'a.doppler_depth', unit: 'm', size: 1, offset: 1, component: 'a' },
      { id: 'b.doppler_depth', unit: 'm', size: 1, offset: 2, component: 'b' },
      { id: 'c.doppler_shift', unit: 'm/s', size: 1, offset: 3, component: 'c' },
    ]);
    const found = dopplers(channels);
    expect(found.map((d) => [d.shift.id, d.depth?.id, d.mixed])).toEqual([
      ['a.doppler_shift', 'a.doppler_depth', null],
    ]);
  });

  it('is one sound that begins at once, lasts while blood is heard and ends with it', () => {
    const audio = new FakeAudio();
    const report = freshReport();
    const desk = new Desk(audio as unknown as AudioContext, report);
    for (let k = 0; k < 120; k++) {
      audio.currentTime = k / 60;
      desk.insonate(flow(1500 + 500 * Math.sin(k / 10), 0.002), performance.now());
    }
    // The noise and its unevenness.
    expect(audio.starts).toEqual([0, 0]);
    expect(report.by_voice.doppler).toBe(1);
    desk.insonate(null, 0);
    expect(audio.ends).toBe(2);
  });
});
