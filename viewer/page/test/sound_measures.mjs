// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of rendered sound: level, pitch, brightness, and how often it begins.

export const peak = (x) => x.reduce((m, v) => Math.max(m, Math.abs(v)), 0);

export const rms = (x) => Math.sqrt(x.reduce((s, v) => s + v * v, 0) / Math.max(1, x.length));

/** Power at n/2 frequencies of the first n samples (a power of two), by the radix-2 transform, with Hann's window. */
export function spectrum(x, n) {
  const re = Float64Array.from({ length: n }, (_, i) => (x[i] ?? 0) * (0.5 - 0.5 * Math.cos((2 * Math.PI * i) / n)));
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
