// SPDX-License-Identifier: GPL-3.0-or-later
// Which fibres are neighbours: the pairs between which a membrane is spanned.

/** Lines further apart than this (at either end, m) carry no common membrane. */
export const spanM = 0.0042;

/**
 * Pairs of lines without a third one between them (Gabriel's graph over both ends). `ends`: six numbers a line, its
 * first and its last point; `whole`: lines that stand. Each pair once, the smaller index first.
 */
export function neighbours(ends: Float32Array, whole: (line: number) => boolean, count: number): [number, number][] {
  const lines = Array.from({ length: count }, (_, i) => i).filter(whole);
  const squared = (i: number, j: number, from: number): number =>
    (ends[i * 6 + from]! - ends[j * 6 + from]!) ** 2 +
    (ends[i * 6 + from + 1]! - ends[j * 6 + from + 1]!) ** 2 +
    (ends[i * 6 + from + 2]! - ends[j * 6 + from + 2]!) ** 2;
  const both = (i: number, j: number): number => squared(i, j, 0) + squared(i, j, 3);
  const near = new Map<number, number[]>();
  const inReach = (i: number, j: number) => Math.max(squared(i, j, 0), squared(i, j, 3)) < spanM * spanM;
  for (const i of lines)
    near.set(
      i,
      lines.filter((j) => j !== i && inReach(i, j)),
    );
  const pairs: [number, number][] = [];
  for (const i of lines)
    for (const j of near.get(i)!) {
      if (j < i) continue;
      const length = both(i, j);
      const between = near.get(i)!.some((k) => k !== j && both(i, k) + both(k, j) < length);
      if (!between) pairs.push([i, j]);
    }
  return pairs;
}
