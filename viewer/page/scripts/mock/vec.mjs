// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors as arrays of three; scale turns millimetres into metres.

export const scale = (a) => a.map((x) => x / 1000);
export const sub = (a, b) => a.map((x, i) => x - b[i]);
export const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => {
  const l = Math.hypot(...a) || 1;
  return a.map((x) => x / l);
};
export const ramp = (t, a, b) => {
  const s = Math.max(0, Math.min(1, (t - a) / (b - a)));
  return s * s * (3 - 2 * s);
};
