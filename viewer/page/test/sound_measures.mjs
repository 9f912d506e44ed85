// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of rendered sound: level, pitch, brightness, and how often it begins.

export const peak = (x) => x.reduce((m, v) => Math.max(m, Math.abs(v)), 0);

export const rms = (x) => Math.sqrt(x.reduce((s, v) => s + v * v, 0) / Math.max(1, x.length));

/** Hann's window, for what lasts. What is struck and dies away in n samples needs none: its begin would be lost. */
export const hann = (i, n) => 0.5 - 0.5 * Math.cos((2 * Math.PI * i) / n);
export const whole = () => 1;

/** Power at n/2 frequencies of the first n samples (a power of two), by the radix-2 transform. */
export function spectrum(x, n, window = hann) {
  const re = Float64Array.from({ length: n }, (_, i) => (x[i] ?? 0) * window(i, n));
  const im = new Float64Array(n);
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) [re[i], re[j]] = [re[j], re[i]];
  }
  for (let size = 2; size <= n; size *= 2)
    for (let from = 0; from < n; from += size)
      for (let k = 0; k < size / 2; k++) {
        const angle = (-2 * Math.PI * k) / size;
        const [a, b] = [from + k, from + k + size / 2];
        const tr = re[b] * Math.cos(angle) - im[b] * Math.sin(angle);
        const ti = re[b] * Math.sin(angle) + im[b] * Math.cos(angle);
        [re[b], im[b]] = [re[a] - tr, im[a] - ti];
        [re[a], im[a]] = [re[a] + tr, im[a] + ti];
      }
  return Float64Array.from({ length: n / 2 }, (_, k) => re[k] ** 2 + im[k] ** 2);
}

/** Mean frequency, weighted by power, Hz. */
export function centroid(power, rate) {
  const hz = rate / (2 * power.length);
  let sum = 0;
  let all = 0;
  power.forEach((p, k) => {
    sum += p * k * hz;
    all += p;
  });
  return sum / all;
}

/** Frequency of the strongest line, Hz: between bins by a parabola through the logarithms. */
export function strongest(power, rate) {
  let k = 1;
  for (let i = 2; i < power.length - 1; i++) if (power[i] > power[k]) k = i;
  const [a, b, c] = [k - 1, k, k + 1].map((i) => Math.log(power[i] + 1e-300));
  return ((k + (a - c) / (2 * (a - 2 * b + c))) * rate) / (2 * power.length);
}

/** Seconds at which it begins anew: louder than a share of its peak after 30 ms of less. */
export function onsets(x, rate, share = 0.12) {
  const limit = share * peak(x);
  const found = [];
  let quietFor = Infinity;
  for (let i = 0; i < x.length; i++) {
    if (Math.abs(x[i]) < limit) {
      quietFor++;
      continue;
    }
    if (quietFor > 0.03 * rate) found.push(i / rate);
    quietFor = 0;
  }
  return found;
}

/** Seconds of the last sample above a share of its peak. */
export function lastLoud(x, rate, share = 0.05) {
  const limit = share * peak(x);
  for (let i = x.length - 1; i >= 0; i--) if (Math.abs(x[i]) >= limit) return i / rate;
  return 0;
}

/** Frequencies between which all but `left` of the power lies, half of it on either side, Hz. */
export function band(power, rate, left = 0.2) {
  const hz = rate / (2 * power.length);
  const all = power.reduce((s, p) => s + p, 0);
  const at = (share) => {
    let sum = 0;
    return power.findIndex((p) => (sum += p) >= share * all) * hz;
  };
  return [at(left / 2), at(1 - left / 2)];
}

/** Where the power is densest, Hz: the mean over a third of an octave. */
export function densest(power, rate) {
  const hz = rate / (2 * power.length);
  const sums = new Float64Array(power.length + 1);
  power.forEach((p, k) => (sums[k + 1] = sums[k] + p));
  let best = [0, 0];
  for (let k = Math.ceil(40 / hz); k < power.length / 1.13; k++) {
    const [from, to] = [Math.floor(k / 1.122), Math.ceil(k * 1.122) + 1];
    const density = (sums[to] - sums[from]) / (to - from);
    if (density > best[0]) best = [density, k * hz];
  }
  return best[1];
}

/** Level of each millisecond, root of the mean square. */
export function envelope(x, rate) {
  const n = Math.round(rate / 1000);
  return Float64Array.from({ length: Math.floor(x.length / n) }, (_, k) => rms(x.subarray(k * n, (k + 1) * n)));
}

/** ms from a tenth of the largest level to nine tenths of it, and from there until it stays 20 dB below. */
export function attackAndDecay(levels) {
  const most = peak(levels);
  const first = levels.findIndex((v) => v >= 0.1 * most);
  const full = levels.findIndex((v) => v >= 0.9 * most);
  return [full - first, levels.findLastIndex((v) => v >= 0.1 * most) - full + 1];
}

/** The loudest twentieth of a second of some renderings, in the mean, dB of full scale. */
export function level(all, rate) {
  const n = Math.round(rate / 20);
  let most = 0;
  for (let i = 0; i < all[0].length; i += n / 2)
    most = Math.max(most, all.reduce((s, x) => s + rms(x.subarray(i, i + n)) ** 2, 0) / all.length);
  return 10 * Math.log10(most);
}

/** Mean of the samples, over their root mean square: the share that is no sound. */
export const offset = (x) => Math.abs(x.reduce((s, v) => s + v, 0) / x.length) / rms(x);

/** How abruptly it begins and ends: the first and the last sample that is not silent, over the peak. */
export function edges(x) {
  const most = peak(x);
  const audible = (v) => Math.abs(v) > 1e-5;
  const [first, last] = [x.findIndex(audible), x.findLastIndex(audible)];
  return [Math.abs(x[first]) / most, Math.abs(x[last]) / most];
}
