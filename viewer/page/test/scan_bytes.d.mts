// SPDX-License-Identifier: GPL-3.0-or-later
export function dicomImages(
  size: [number, number, number],
  spacing: [number, number, number],
  value: (x: number, y: number, z: number) => number,
  tags: { uid: string; description: string; person: string },
): Uint8Array[];
