// SPDX-License-Identifier: GPL-3.0-or-later
// Each voice of the page as it is rendered without a sound card: its spectrum, envelope and level against what the
// manual says (sound_expected.mjs), and how the voices differ.
import assert from 'node:assert/strict';
import { check, launch } from './browser.mjs';
import { renderingScript } from './sound_bundle.mjs';
import { apart, expected } from './sound_expected.mjs';

/** A first sample of this share of the peak would click; and what is left when it ends. */
const mostEdges = [0.03, 0.01];
/** Of the level: more is no sound, and moves the loudspeaker's rest. */
const mostOffset = 0.01;

async function render(browser) {
  const page = await browser.newPage();
  await page.goto('about:blank');
  await page.addScriptTag({ content: await renderingScript() });
  const measured = await page.evaluate(async () => {
    const of = async (cases) => {
      const out = {};
      for (const [name, play] of Object.entries(cases)) out[name] = await play();
      return out;
    };
    return { m: await of(window.rendering.cases), placed: await of(window.rendering.placed) };
  });
  await page.close();
  return measured;
}

/** Nothing clicks, clips, stays or hums at 0 Hz. */
function clean(m) {
  const { group_off: off, everything, ...single } = m;
  for (const [name, v] of Object.entries(single)) {
    assert.ok(v.peak > 0.01 && v.peak < 0.4, `${name}: peak ${v.peak}`);
    assert.ok(v.after < 1e-4, `${name}: ${v.after} is left after its end`);
    assert.ok(v.offset < mostOffset, `${name}: offset ${v.offset}`);
    v.edges.forEach((e, k) => assert.ok(e < mostEdges[k], `${name}: ${k ? 'ends' : 'begins'} with ${e} of its peak`));
  }
  check(`each of ${Object.keys(single).length} sounds peaks between 0.01 and 0.4 and leaves silence`);
  check('none of them clicks when it begins or ends, or has an offset');
  assert.ok(everything.peak <= 0.951, `peak ${everything.peak}`);
  assert.equal(off.peak, 0);
  check(`ninety sounds and an alarm at once peak at ${everything.peak.toFixed(3)}; groups that are off are silent`);
}

/** Spectrum, envelope and level of each voice. */
function asTheManualSays(m) {
  let numbers = 0;
  const within = (name, what, value, [from, to]) => {
    numbers++;
    assert.ok(value >= from && value <= to, `${name}: ${what} is ${value}, not ${from} to ${to}`);
  };
  for (const [name, want] of Object.entries(expected)) {
    const v = m[name];
    const measured = {
      ...{ tone_hz: v.strongest_hz, noise_hz: v.densest_hz, octaves: Math.log2(v.band_hz[1] / v.band_hz[0]) },
      ...{ attack_ms: v.attack_ms, decay_ms: v.decay_ms, level_db: v.level_db },
    };
    for (const [what, range] of Object.entries(want)) within(name, what, measured[what], range);
  }
  for (const [low, high, factor] of apart)
    within(high, `above ${low}`, m[high].centroid_hz / m[low].centroid_hz, [factor, 99]);
  check(`${numbers} numbers of ${Object.keys(expected).length} sounds are as the manual says`);
}

function strands(m) {
  const louder = 20 * Math.log10(m.torn.rms / m.cut.rms);
  assert.ok(louder > 6, `torn is ${louder} dB louder`);
  assert.ok(m.cut.centroid_hz > 4000 && m.torn.centroid_hz < 2000 && m.torn.last_s > 4 * m.cut.last_s);
  check(
    `a cut strand is a snip at ${m.cut.centroid_hz.toFixed(0)} Hz, a torn one rips at ` +
      `${m.torn.centroid_hz.toFixed(0)} Hz and is ${louder.toFixed(1)} dB louder`,
  );
}

/** What vessels sound like when they part, and what a probe hears in them. */
function vesselsAndDoppler(m, placed) {
  const hz = (name) => `${m[name].centroid_hz.toFixed(0)} Hz`;
  assert.ok(m.vein_torn.centroid_hz < 1000 && m.vein_cut.centroid_hz > 1.5 * m.vein_torn.centroid_hz);
  assert.ok(m.artery_cut.centroid_hz > 2000 && m.artery_torn.centroid_hz > 2 * m.torn.centroid_hz);
  assert.ok(m.vein_torn.rms > 1.4 * m.vein_cut.rms && m.artery_torn.last_s > m.artery_cut.last_s);
  check(
    `a vein is cut at ${hz('vein_cut')} and torn at ${hz('vein_torn')}, an artery cut at ${hz('artery_cut')} and ` +
      `torn at ${hz('artery_torn')}, a strand torn at ${hz('torn')}`,
  );
  const shifts = { doppler_slow: 500, doppler_fast: 3896 };
  for (const [name, hz] of Object.entries(shifts))
    assert.ok(Math.abs(m[name].centroid_hz / hz - 1) < 0.15, `${name}: ${m[name].centroid_hz} Hz, not about ${hz}`);
  const deeper = 20 * Math.log10(m.doppler_deep.rms / m.doppler_fast.rms);
  assert.ok(Math.abs(deeper + 6) < 0.5, `3 mm deeper is ${deeper} dB`);
  assert.ok(placed.nearer[1] > 2 * placed.nearer[0] && placed.away[0] > 2 * placed.away[1]);
  assert.ok(Math.abs(placed.both[1] / placed.both[0] - 1) < 0.02);
  check(
    `a Doppler probe sounds about its shift: ${m.doppler_slow.centroid_hz.toFixed(0)} Hz at 500 Hz, ` +
      `${m.doppler_fast.centroid_hz.toFixed(0)} Hz at 3896 Hz; ${deeper.toFixed(1)} dB 3 mm deeper; ` +
      'each way has its side',
  );
}

function others(m) {
  assert.ok(m.air.centroid_hz > 2 * m.fluid.centroid_hz && m.fluid.centroid_hz > 2 * m.tissue.centroid_hz);
  const drawn = ['air', 'fluid', 'tissue'].map((d) => `${d} ${m[d].centroid_hz.toFixed(0)} Hz`);
  check(`suction by what it draws: ${drawn.join(', ')}`);
  const hits = ['soft', 'bone', 'polymer', 'metal'].map((name) => m[name].centroid_hz);
  hits.slice(1).forEach((hz, k) => assert.ok(hz > 1.25 * hits[k], `${hits.join(' ')} Hz`));
  assert.ok(m.bone.rms > 3 * m.bone_gently.rms && m.bone.rms > 2 * m.soft.rms);
  check(
    `hits on tissue, bone, polymer and metal lie at ${hits.map((hz) => hz.toFixed(0)).join(', ')} Hz; ` +
      'a hard one is louder than a gentle one',
  );
  assert.deepEqual(
    ['shut', 'released', 'taken', 'loaded'].map((name) => m[name].onsets.length),
    [1, 1, 2, 2],
  );
  assert.ok(m.released.last_s > 3 * m.shut.last_s && m.taken.rms > 1.4 * m.loaded.rms);
  check('the four clicks of a clip differ in number, ring and level');
  assert.deepEqual(
    ['low', 'medium', 'high'].map((p) => m[p].onsets.length),
    [2, 3, 10],
  );
  assert.ok(m.high.rms > m.medium.rms && m.medium.rms > m.low.rms);
  check('alarms of low, medium and high priority have 2, 3 and 10 pulses, each louder than the one before');
  assert.ok(m.small_drop.strongest_hz > 1.7 * m.large_drop.strongest_hz);
  check('small drops sound higher than large ones');
}

const browser = await launch();
try {
  const { m, placed } = await render(browser);
  clean(m);
  asTheManualSays(m);
  strands(m);
  vesselsAndDoppler(m, placed);
  others(m);
} finally {
  await browser.close();
}
