// SPDX-License-Identifier: GPL-3.0-or-later
// What persons at several pages write, draw and point at; JSON on the channel ROOM (viewer/gateway/room_message.h).

export type Point = [number, number, number];

/** How two pages agree to talk by voice (viewer/gateway/voice_message.h); page: who sent it. */
export type VoiceStep = { step: 'ring' | 'accept' | 'end' } | { step: 'offer' | 'answer'; sdp: string };
type FromPage = { kind: 'voice'; from: string; page: number };
export type VoiceMessage =
  (FromPage & { step: 'ring' | 'accept' | 'end' }) | (FromPage & { step: 'offer' | 'answer'; sdp: string });

export type RoomMessage =
  | { kind: 'say'; from: string; text: string }
  | { kind: 'stroke'; id: number; points: Point[] }
  | { kind: 'point'; at: Point }
  | { kind: 'clear' }
  | VoiceMessage
  | { kind: 'pages'; instructors: number; trainees: number }
  | { kind: 'picture' };

/** What a page sends; the gateway adds who it is from. */
export type OwnMessage = { kind: 'say'; text: string } | ({ kind: 'voice'; to?: number } & VoiceStep) | Drawing;

/** What goes over the picture. */
export type Drawing = Extract<RoomMessage, { kind: 'stroke' | 'point' | 'clear' }>;

/** The gateway takes no more bytes of a text, and no more points at once. */
export const longestText = 380;
export const mostPoints = 128;

const isPoint = (v: unknown): v is Point => Array.isArray(v) && v.length === 3 && v.every((x) => Number.isFinite(x));

const isCount = (v: unknown): v is number => Number.isSafeInteger(v) && (v as number) >= 0;

function parseVoice(m: Record<string, unknown>): VoiceMessage | null {
  if (typeof m.from !== 'string' || !isCount(m.page)) return null;
  const head = { kind: 'voice' as const, from: m.from, page: m.page };
  if (m.step === 'ring' || m.step === 'accept' || m.step === 'end') return { ...head, step: m.step };
  if ((m.step === 'offer' || m.step === 'answer') && typeof m.sdp === 'string')
    return { ...head, step: m.step, sdp: m.sdp };
  return null;
}

/** Null when it is none. */
export function parseRoomMessage(payload: Uint8Array): RoomMessage | null {
  const m = JSON.parse(new TextDecoder().decode(payload)) as Record<string, unknown> | null;
  if (typeof m !== 'object' || m === null) return null;
  if (m.kind === 'say' && typeof m.text === 'string' && typeof m.from === 'string')
    return { kind: 'say', from: m.from, text: m.text };
  if (m.kind === 'stroke' && Number.isSafeInteger(m.id) && Array.isArray(m.points) && m.points.every(isPoint))
    return { kind: 'stroke', id: m.id as number, points: m.points };
  if (m.kind === 'point' && isPoint(m.at)) return { kind: 'point', at: m.at };
  if (m.kind === 'pages' && isCount(m.instructors) && isCount(m.trainees))
    return { kind: 'pages', instructors: m.instructors, trainees: m.trainees };
  if (m.kind === 'voice') return parseVoice(m);
  return m.kind === 'clear' || m.kind === 'picture' ? { kind: m.kind } : null;
}

/** A text as it may be sent, cut at a character's border; '' if there is nothing to say. */
export function sayable(text: string): string {
  let out = text.trim();
  while (new TextEncoder().encode(out).length > longestText) out = [...out].slice(0, -1).join('');
  return out;
}
