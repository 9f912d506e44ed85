// SPDX-License-Identifier: GPL-3.0-or-later
// Framing on /ws: one byte length of the channel name, the name in ASCII, then the LCM message.

export interface Packet {
  channel: string;
  payload: Uint8Array;
}

export function pack(channel: string, payload: Uint8Array): Uint8Array<ArrayBuffer> {
  if (channel.length === 0 || channel.length > 255 || !/^[\x21-\x7e]+$/.test(channel))
    throw new RangeError('bad channel name');
  const out = new Uint8Array(1 + channel.length + payload.length);
  out[0] = channel.length;
  for (let i = 0; i < channel.length; i++) out[1 + i] = channel.charCodeAt(i);
  out.set(payload, 1 + channel.length);
  return out;
}

/** Null when the bytes are no packet. The payload is a view, not a copy. */
export function unpack(bytes: Uint8Array): Packet | null {
  const n = bytes[0] ?? 0;
  if (n === 0 || bytes.length < 1 + n) return null;
  let channel = '';
  for (let i = 1; i <= n; i++) {
    const c = bytes[i]!;
    if (c < 0x21 || c > 0x7e) return null;
    channel += String.fromCharCode(c);
  }
  return { channel, payload: bytes.subarray(1 + n) };
}
