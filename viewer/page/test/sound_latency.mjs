// SPDX-License-Identifier: GPL-3.0-or-later
// How late sounds are, from what sound_tap.mjs has noted: from the engine's clock to the message's arrival, from there
// to the audio, and to the block in which the audio's thread begins the sound. Times are ms.
import { hrtime } from 'node:process';

/** What to add to the engine's clock (monotonic, ms) for that of the page, from the quickest of some questions. */
export async function engineToPage(page) {
  let best = { took: Infinity, offset: 0 };
  for (let k = 0; k < 20; k++) {
    const before = Number(hrtime.bigint()) / 1e6;
    const now = await page.evaluate(() => performance.now());
    const after = Number(hrtime.bigint()) / 1e6;
    if (after - before < best.took) best = { took: after - before, offset: now - (before + after) / 2 };
  }
  return best;
}

export const readTap = (page) =>
  page.evaluate(() => {
    const { starts, events, sounds, blocks } = window.__tap;
    return { starts, events, sounds, blocks, originMs: performance.timeOrigin };
  });

/** When the audio's thread rendered this time of its clock, by its own Date.now(), on the page's clock. */
function renderedMs({ blocks, originMs }, at) {
  const block = blocks.findLast((b) => b.at <= at + 1e-6);
  return block ? block.wall - originMs : NaN;
}

/** Each message that began a sound at once, with the steps of its way. offset: of engineToPage; none of the mock. */
export function ways(tap, offset = NaN) {
  const ofMessage = new Map();
  for (const s of tap.starts) if (s.at <= s.now + 1e-6) ofMessage.set(s.arrivedMs, s);
  return [...ofMessage.values()]
    .map(({ channel, sentUs, arrivedMs, handedMs, at }) => ({
      channel,
      travelled: arrivedMs - (sentUs / 1000 + offset),
      handed: handedMs - arrivedMs,
      begun: renderedMs(tap, at) - arrivedMs,
    }))
    .filter((w) => Number.isFinite(w.begun));
}

export const share = (values, q) => [...values].sort((a, b) => a - b)[Math.floor(q * (values.length - 1))];

/** "median 3.1, 90 % 7.2, most 12.0 ms" */
export const told = (values) =>
  `median ${share(values, 0.5).toFixed(1)}, 90 % ${share(values, 0.9).toFixed(1)}, ` +
  `most ${Math.max(...values).toFixed(1)} ms`;
