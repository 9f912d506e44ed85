// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parsed JSON from outside, whose types must be asked for.

export type Json = Record<string, unknown>;

export const isObject = (v: unknown): v is Json => typeof v === 'object' && v !== null && !Array.isArray(v);
export const word = (v: unknown, otherwise = ''): string => (typeof v === 'string' ? v : otherwise);
export const finite = (v: unknown): number | null => (typeof v === 'number' && Number.isFinite(v) ? v : null);
