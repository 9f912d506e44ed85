// SPDX-License-Identifier: GPL-3.0-or-later
// What persons at several pages write, draw and point at; JSON on the channel ROOM (viewer/gateway/room_message.h).

export type Point = [number, number, number];

export type RoomMessage =
  | { kind: 'say'; from: string; text: string }
  | { kind: 'stroke'; id: number; points: Point[] }
  | { kind: 'point'; at: Point }
  | { kind: 'clear' };

/** What a page sends; the gateway adds who it is from. */
export type OwnMessage = { kind: 'say'; text: string } | Exclude<RoomMessage, { kind: 'say' }>;

/** The gateway takes no more bytes of a text, and no more points at once. */
export const longestText = 380;
export const mostPoints = 128;

const isPoint = (v: unknown): v is Point => Array.isArray(v) && v.length === 3 && v.every((x) => Number.isFinite(x));

/** Null when it is none. */
export function parseRoomMessage(payload: Uint8Array): RoomMessage | null {
  const m = JSON.parse(new TextDecoder().decode(payload)) as Record<string, unknown> | null;
  if (typeof m !== 'object' || m === null) return null;
  if (m.kind === 'say' && typeof m.text === 'string' && typeof m.from === 'string')
    return { kind: 'say', from: m.from, text: m.text };
  if (m.kind === 'stroke' && Number.isSafeInteger(m.id) && Array.isArray(m.points) && m.points.every(isPoint))
    return { kind: 'stroke', id: m.id as number, points: m.points };
  if (m.kind === 'point' && isPoint(m.at)) return { kind: 'point', at: m.at };
  return m.kind === 'clear' ? { kind: 'clear' } : null;
}

/** A text as it may be sent, cut at a character's border; '' if there is nothing to say. */
export function sayable(text: string): string {
  let out = text.trim();
  while (new TextEncoder().encode(out).length > longestText) out = [...out].slice(0, -1).join('');
  return out;
}
