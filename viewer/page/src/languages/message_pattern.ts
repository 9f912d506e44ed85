// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the numbers and names in a message that a program has made of a key of the catalogues.

/**
 * The pattern of a message of the catalogues, and the names of its arguments. {0}, {1}, {after} and {before} are
 * numbers, all others are names or lists of them.
 */
export function patternOf(key: string): { pattern: string; names: string[] } {
  const names: string[] = [];
  const pattern = key
    .split(/(\{\w+\})/)
    .map((piece) => {
      if (!/^\{\w+\}$/.test(piece)) return piece.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
      const name = piece.slice(1, -1);
      names.push(name);
      return /^(\d+|after|before)$/.test(name) ? '(-?\\d+(?:\\.\\d+)?)' : '([^:;]+?)';
    })
    .join('');
  return { pattern, names };
}
