// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in the page: renders each voice through the mixer at full volume, without a sound card, and measures it.
import { makeRandom } from '../src/random';
import { Mixer } from '../src/sound/mixer';
import { AlarmVoice } from '../src/sound/voices/alarm';
import { BleedingVoice } from '../src/sound/voices/bleeding';
import { click } from '../src/sound/voices/clip';
import { hit } from '../src/sound/voices/contact';
import { DopplerVoice } from '../src/sound/voices/doppler';
import { drip } from '../src/sound/voices/drop';
import { beep } from '../src/sound/voices/heart';
import { hint } from '../src/sound/voices/hint';
import { part } from '../src/sound/voices/strand';
import { SuctionVoice } from '../src/sound/voices/suction';
import * as measures from './sound_measures.mjs';

const { centroid, lastLoud, onsets, peak, rms, spectrum, strongest } = measures;

// The same noise in each run, so that the measures are the same.
Math.random = makeRandom(11);

const rate = 48000;
const mmHg = 133.322;
const on = { monitor: true, instruments: true, doppler: true, alarms: true, hints: true };

async function render(seconds, play, groups = on) {
  const context = new OfflineAudioContext(1, seconds * rate, rate);
  const mixer = new Mixer(context);
  mixer.set(1, groups);
  play((group) => mixer.place(group), context);
  return (await context.startRendering()).getChannelData(0);
}

/** From when it began, s, to its end. */
function measure(x, fromS, windowS, { more = [], window = measures.hann } = {}) {
  const begin = Math.floor(fromS * rate);
  const heard = x.subarray(begin, begin + Math.round(windowS * rate));
  let n = 1024;
  while (2 * n <= heard.length) n *= 2;
  const power = spectrum(heard, n, window);
  // Noise differs each time, so its spectrum is the mean of some.
  for (const other of more) spectrum(other.subarray(begin), n, window).forEach((p, k) => (power[k] += p));
  const levels = [x, ...more].map((y) => measures.envelope(y.subarray(begin), rate));
  const mean = levels[0].map((_, k) => Math.sqrt(levels.reduce((s, l) => s + l[k] ** 2, 0) / levels.length));
  const [attack, decay] = measures.attackAndDecay(mean);
  const band = measures.band(power, rate);
  return {
    ...{ attack_ms: attack, decay_ms: decay, band_hz: band, densest_hz: measures.densest(power, rate) },
    ...{ level_db: measures.level([x, ...more], rate), offset: measures.offset(x), edges: measures.edges(x) },
    peak: peak(x),
    rms: rms(heard),
    centroid_hz: centroid(power, rate),
    strongest_hz: strongest(power, rate),
    onsets: onsets(x, rate).map((t) => t - fromS),
    last_s: lastLoud(x, rate) - fromS,
    before: peak(x.subarray(0, begin)),
    after: peak(x.subarray(x.length - Math.round(0.15 * rate))),
  };
}

/** Gains glide at first; so every sound begins a little later. */
const at = 0.2;

/** Some renderings of what lasts, from a tenth of a second after its begin; the noise begins elsewhere each time. */
const hold = (group, play) => async () => {
  const once = () => render(2, (place) => play(place(group)));
  const more = [];
  for (let k = 0; k < 11; k++) more.push(await once());
  return measure(await once(), at + 0.1, 0.35, { more });
};

const suck = (drawn) => hold('instruments', (p) => new SuctionVoice(p).play(drawn, at));

const insonate = (shiftHz, depthM = 0.002) =>
  hold('doppler', (p) => new DopplerVoice(p).play({ shiftHz, depthM, mixed: false }, at));

/** Of the left and the right side, how loud it is. */
const sides = (shiftHz, mixed) => async () => {
  const context = new OfflineAudioContext(2, rate, rate);
  const mixer = new Mixer(context);
  mixer.set(1, on);
  new DopplerVoice(mixer.place('doppler')).play({ shiftHz, depthM: 0, mixed }, at);
  const both = await context.startRendering();
  return [0, 1].map((side) => rms(both.getChannelData(side).subarray(0.3 * rate, 0.6 * rate)));
};

/** What is no single voice. */
export const placed = { away: sides(-2000, false), nearer: sides(2000, false), both: sides(2000, true) };

const strike = (group, windowS, play) => async () => {
  const once = () => render(1.5, (place) => play(place(group)));
  const more = [];
  for (let k = 0; k < 11; k++) more.push(await once());
  return measure(await once(), at, windowS, { more, window: measures.whole });
};

const alarm = (priority) => async () => {
  const x = await render(4, (place) => void new AlarmVoice(place('alarms')).sound(priority, at));
  return measure(x, at, 0.14);
};

export const cases = {
  cut: strike('instruments', 0.25, (p) => part(p, at, { what: 'strand', by: 'cut' }, 0)),
  torn: strike('instruments', 0.25, (p) => part(p, at, { what: 'strand', by: 'torn' }, 0)),
  vein_cut: strike('instruments', 0.4, (p) => part(p, at, { what: 'vein', by: 'cut' }, 0)),
  vein_torn: strike('instruments', 0.4, (p) => part(p, at, { what: 'vein', by: 'torn' }, 0)),
  artery_cut: strike('instruments', 0.4, (p) => part(p, at, { what: 'artery', by: 'cut' }, 0)),
  artery_torn: strike('instruments', 0.4, (p) => part(p, at, { what: 'artery', by: 'torn' }, 0)),
  doppler_slow: insonate(500),
  doppler_fast: insonate(-3896),
  doppler_deep: insonate(-3896, 0.005),
  shut: strike('instruments', 0.15, (p) => click(p, at, 'shut')),
  released: strike('instruments', 0.15, (p) => click(p, at, 'released')),
  taken: strike('instruments', 0.15, (p) => click(p, at, 'taken')),
  loaded: strike('instruments', 0.15, (p) => click(p, at, 'loaded')),
  bone: strike('instruments', 0.1, (p) => hit(p, at, 'bone', 1, 0)),
  bone_gently: strike('instruments', 0.1, (p) => hit(p, at, 'bone', 0.2, 0)),
  metal: strike('instruments', 0.1, (p) => hit(p, at, 'metal', 1, 0)),
  polymer: strike('instruments', 0.1, (p) => hit(p, at, 'polymer', 1, 0)),
  soft: strike('instruments', 0.1, (p) => hit(p, at, 'soft', 1, 0)),
  hint: strike('hints', 0.35, (p) => hint(p, at)),
  heart_60: strike('monitor', 0.12, (p) => beep(p, at, 60 * mmHg)),
  heart_90: strike('monitor', 0.12, (p) => beep(p, at, 90 * mmHg)),
  heart_120: strike('monitor', 0.12, (p) => beep(p, at, 120 * mmHg)),
  small_drop: strike('instruments', 0.05, (p) => drip(p, at, 0, 0.04)),
  large_drop: strike('instruments', 0.05, (p) => drip(p, at, 1, 0.04)),
  air: suck('air'),
  fluid: suck('fluid'),
  tissue: suck('tissue'),
  bleeding: hold('instruments', (p) => new BleedingVoice(p).play(1e-6, at)),
  low: alarm('low'),
  medium: alarm('medium'),
  high: alarm('high'),
  /** Far more at once than the limits of the voices let through. */
  everything: async () => {
    const x = await render(2, (place) => {
      for (let k = 0; k < 30; k++) {
        part(place('instruments'), at, { what: 'strand', by: 'torn' }, 0);
        hit(place('instruments'), at, 'bone', 1, 0);
        beep(place('monitor'), at, null);
      }
      new AlarmVoice(place('alarms')).sound('high', at);
    });
    return measure(x, at, 0.2);
  },
  group_off: async () => {
    const x = await render(
      1,
      (place) => {
        beep(place('monitor'), at, null);
        part(place('instruments'), at, { what: 'strand', by: 'torn' }, 0);
      },
      { ...on, monitor: false, instruments: false },
    );
    return measure(x, at, 0.2);
  },
  stopped: async () => {
    const x = await render(1.5, (place) => {
      const voice = new SuctionVoice(place('instruments'));
      voice.play('air', at);
      voice.stop(at + 0.3);
    });
    return measure(x, at, 0.3);
  },
};
