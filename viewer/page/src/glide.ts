// SPDX-License-Identifier: GPL-3.0-or-later
// What follows a value with a delay.

/** A value on its way; passed: time over the time constant since the last one. Infinity: it has arrived. */
export const glide = (from: number, to: number, passed: number): number => from + (to - from) * (1 - Math.exp(-passed));
