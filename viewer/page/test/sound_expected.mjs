// SPDX-License-Identifier: GPL-3.0-or-later
// What each sound is to be, from what the manual and its voice say (docs/trainee.md, src/sound/voices/). Pairs are
// from and to.
//
//   tone_hz     its strongest line
//   noise_hz    where its power is densest
//   octaves     between the ends of the middle four fifths of its power: how wide it is
//   attack_ms   from a tenth of its level to nine tenths
//   decay_ms    from there until it stays 20 dB below
//   level_db    its loudest twentieth of a second at full volume, of full scale

const near = (hz, by = 0.02) => [hz * (1 - by), hz * (1 + by)];
const noise = (hz) => near(hz, 0.3);
/** Begins at once. */
const struck = [0, 4];
const narrow = [0, 0.2];
const wide = [0.8, 3.5];

export const expected = {
  // A short bright snip, and longer, lower and louder rips; vessels are unlike both, and cut unlike torn.
  cut: { noise_hz: noise(5000), octaves: wide, attack_ms: struck, decay_ms: [5, 25], level_db: [-42, -34] },
  torn: { octaves: [2, 4.5], attack_ms: [0, 8], decay_ms: [90, 170], level_db: [-30, -22] },
  vein_cut: { octaves: [2, 5], attack_ms: struck, decay_ms: [20, 280], level_db: [-36, -28] },
  vein_torn: {
    noise_hz: noise(300),
    octaves: [0.5, 3],
    attack_ms: [0, 130],
    decay_ms: [20, 360],
    level_db: [-30, -22],
  },
  artery_cut: { noise_hz: [2000, 4000], octaves: wide, attack_ms: struck, decay_ms: [40, 130], level_db: [-30, -22] },
  artery_torn: {
    noise_hz: [1500, 3600],
    octaves: wide,
    attack_ms: [0, 130],
    decay_ms: [40, 240],
    level_db: [-30, -22],
  },
  // Clicks: short, and one that rings.
  shut: { tone_hz: near(1350), attack_ms: struck, decay_ms: [8, 30], level_db: [-36, -28] },
  released: { tone_hz: near(2100), attack_ms: struck, decay_ms: [50, 110], level_db: [-32, -24] },
  taken: { tone_hz: [1300, 2100], attack_ms: [0, 95], decay_ms: [8, 120], level_db: [-38, -30] },
  loaded: { tone_hz: [850, 1050], attack_ms: [0, 80], decay_ms: [5, 100], level_db: [-44, -36] },
  // A dull tock, a light tink that rings, a clack between them, and a pat that is hardly heard.
  bone: { tone_hz: near(390), attack_ms: struck, decay_ms: [8, 30], level_db: [-34, -26] },
  metal: { tone_hz: near(2650), attack_ms: struck, decay_ms: [30, 80], level_db: [-38, -30] },
  polymer: { tone_hz: near(1150), attack_ms: struck, decay_ms: [5, 20], level_db: [-40, -32] },
  soft: { noise_hz: noise(180), octaves: wide, attack_ms: struck, decay_ms: [10, 40], level_db: [-50, -40] },
  // An octave for 60 mmHg about 620 Hz at 90 mmHg.
  heart_60: { tone_hz: near(438), octaves: narrow, attack_ms: [3, 12], decay_ms: [30, 80], level_db: [-36, -28] },
  heart_90: { tone_hz: near(620), octaves: narrow, attack_ms: [3, 12], decay_ms: [30, 80], level_db: [-36, -28] },
  heart_120: { tone_hz: near(877), octaves: narrow, attack_ms: [3, 12], decay_ms: [30, 80], level_db: [-36, -28] },
  // Bubbles of 2.2 and 4.5 mm: 3 / r Hz, and rising.
  small_drop: { tone_hz: [1364, 1700], attack_ms: struck, decay_ms: [8, 40], level_db: [-45, -37] },
  large_drop: { tone_hz: [667, 830], attack_ms: struck, decay_ms: [20, 80], level_db: [-42, -34] },
  // A hiss in air, a gurgle in fluid, a dull hum when it is closed; a stream.
  air: { noise_hz: noise(1700), octaves: [1.5, 3.5], level_db: [-42, -34] },
  fluid: { noise_hz: noise(600), octaves: [1, 3.5], level_db: [-36, -27] },
  tissue: { noise_hz: noise(240), octaves: [1, 3.5], level_db: [-42, -34] },
  bleeding: { noise_hz: noise(950), octaves: [1.5, 3.5], level_db: [-42, -34] },
  doppler_fast: { octaves: [2, 4], level_db: [-42, -34] },
  doppler_slow: { octaves: [1.5, 4], level_db: [-42, -34] },
  // Pulses that rise within a tenth of their length, each priority louder; two soft notes.
  low: { tone_hz: near(440), attack_ms: [8, 25], level_db: [-36, -29] },
  medium: { tone_hz: near(440), attack_ms: [8, 25], level_db: [-29, -24] },
  high: { tone_hz: near(440), attack_ms: [8, 20], level_db: [-24, -20] },
  hint: { tone_hz: [580, 790], octaves: [0, 0.8], attack_ms: [5, 130], level_db: [-36, -28] },
};

/** How far apart the mean frequencies of two sounds are, at least, as a factor: the second one is higher. */
export const apart = [
  ['bone', 'polymer', 1.5],
  ['polymer', 'metal', 1.5],
  ['vein_torn', 'vein_cut', 1.5],
  ['vein_torn', 'artery_torn', 2.5],
  ['vein_cut', 'artery_cut', 1.5],
  ['tissue', 'fluid', 1.8],
  ['fluid', 'air', 1.8],
];
