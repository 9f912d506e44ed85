// SPDX-License-Identifier: GPL-3.0-or-later
import { afterAll, beforeEach, expect, it, vi } from 'vitest';
import type { OwnMessage } from '../src/room/messages';

vi.stubGlobal('window', { addEventListener: () => undefined, setTimeout: () => 0, clearTimeout: () => undefined });
const talk = await import('../src/room/voice');

const sent: OwnMessage[] = [];
const ring: OwnMessage = { kind: 'voice', step: 'ring' };

beforeEach(() => {
  const track = { enabled: true, stop: () => undefined };
  const microphone = { getAudioTracks: () => [track], getTracks: () => [track] };
  vi.stubGlobal('Audio', class {});
  vi.stubGlobal('navigator', { mediaDevices: { getUserMedia: () => Promise.resolve(microphone) } });
  sent.length = 0;
});
afterAll(() => vi.unstubAllGlobals());

async function calling() {
  const voice = new talk.Voice('trainee', (m) => sent.push(m));
  await voice.call();
  expect(sent).toEqual([ring]);
  return voice;
}

it('rings again when the way to the gateway was lost, and only while it calls', async () => {
  const voice = await calling();
  voice.reconnected();
  expect(sent).toEqual([ring, ring]);
  voice.hangUp();
  voice.reconnected();
  expect(sent).toEqual([ring, ring, { kind: 'voice', step: 'end' }]);
});

it('is declined by the other side, not by a page of its own side that leaves', async () => {
  const voice = await calling();
  voice.hear({ kind: 'voice', step: 'end', from: 'trainee', page: 4 });
  expect(voice.state).toBe('calling');
  voice.hear({ kind: 'voice', step: 'end', from: 'instructor', page: 5 });
  expect([voice.state, voice.ended]).toEqual(['off', 'declined']);
});
