// SPDX-License-Identifier: GPL-3.0-or-later
// Talk, strokes, the overview of stations, and where a login leads to.
import { describe, expect, it } from 'vitest';
import { nextPage } from '../src/login/next';
import { longestText, parseRoomMessage, type RoomMessage, sayable } from '../src/room/messages';
import { alarmLines } from '../src/room/cards';
import { roomOf, standingOf, stationsOf } from '../src/room/overview';
import { addressOf, fingerprintOf } from '../src/room/station_form';
import { opacity, pointLastsMs, strokeLastsMs, Strokes } from '../src/room/strokes';

const parse = (json: unknown): RoomMessage | null => parseRoomMessage(new TextEncoder().encode(JSON.stringify(json)));

describe('messages of the room', () => {
  it('are checked before use', () => {
    expect(parse({ kind: 'say', from: 'trainee', text: 'here?' })).toEqual({
      kind: 'say',
      from: 'trainee',
      text: 'here?',
    });
    expect(parse({ kind: 'point', at: [0, 0.1, 0] })).not.toBeNull();
    for (const bad of [
      null,
      7,
      {},
      { kind: 'say', text: 'from whom?' },
      { kind: 'point', at: [0, 0] },
      { kind: 'point', at: [0, 0, '1'] },
      { kind: 'stroke', id: 0.5, points: [] },
      { kind: 'stroke', id: 1, points: [[0, 0, null]] },
    ])
      expect(parse(bad)).toBeNull();
  });

  it('have texts that fit in bytes', () => {
    expect(sayable('  hi ')).toBe('hi');
    const long = sayable('ä'.repeat(300));
    expect(new TextEncoder().encode(long).length).toBe(longestText);
    expect(sayable('🧠'.repeat(200))).toMatch(/^(🧠)+$/u);
  });
});

describe('messages about voice', () => {
  it('are checked before use', () => {
    const head = { kind: 'voice', from: 'instructor', page: 3 };
    expect(parse({ ...head, step: 'ring', sdp: 7 })).toEqual({ ...head, step: 'ring' });
    expect(parse({ ...head, step: 'offer', sdp: 'v=0' })).toEqual({ ...head, step: 'offer', sdp: 'v=0' });
    expect(parse({ kind: 'pages', instructors: 1, trainees: 0 })).not.toBeNull();
    expect(parse({ kind: 'picture' })).toEqual({ kind: 'picture' });
    for (const bad of [
      { ...head },
      { ...head, step: 'shout' },
      { ...head, step: 'offer' },
      { ...head, step: 'answer', sdp: 1 },
      { ...head, page: -1, step: 'ring' },
      { ...head, page: '3', step: 'ring' },
      { kind: 'voice', page: 3, step: 'ring' },
      { kind: 'pages', instructors: 1 },
      { kind: 'pages', instructors: -1, trainees: 0 },
    ])
      expect(parse(bad)).toBeNull();
  });
});

describe('a new station', () => {
  it('is read as persons write it', () => {
    expect(addressOf(' table3.local:8080 ')).toBe('http://table3.local:8080');
    expect(addressOf('https://b.local/')).toBe('https://b.local/');
    expect(addressOf('')).toBe('');
    const pairs = Array.from({ length: 32 }, () => 'AB').join(':');
    expect(fingerprintOf(` ${'ab'.repeat(32)} `)).toBe(pairs);
    expect(fingerprintOf(pairs.toLowerCase())).toBe(pairs);
    expect(fingerprintOf(' AB:CD ')).toBe('AB:CD');
  });
});

describe('stations that were found', () => {
  it('are shown only with an address of a page', () => {
    const found = (each: unknown) => roomOf({ stations: [], found: [each] }).found;
    expect(found({ name: 'a', url: 'https://192.0.2.1:8080/' })).toHaveLength(1);
    for (const bad of [null, {}, { name: 'a', url: 'javascript:alert(1)' }, { name: '', url: 'http://a/' }])
      expect(found(bad)).toEqual([]);
    expect(found({ name: 'a', url: 'http://a/path/' })).toEqual([]);
    expect(roomOf(null)).toEqual({ stations: [], found: [], searchError: '' });
  });
});

describe('strokes', () => {
  it('grow by their number, fade by themselves and are wiped', () => {
    const s = new Strokes();
    s.take({ kind: 'stroke', id: 4, points: [[0, 0, 0]] }, 0);
    s.take({ kind: 'stroke', id: 4, points: [[1, 0, 0]] }, 1000);
    s.take({ kind: 'stroke', id: 5, points: [[1, 0, 0]] }, 2000);
    expect(s.list.map((x) => x.points.length)).toEqual([2, 1]);
    expect(opacity(s.list[0]!, 1000)).toBe(1);
    expect(opacity(s.list[0]!, 1000 + strokeLastsMs)).toBe(0);
    expect(s.age(1001 + strokeLastsMs)).toBe(true);
    expect(s.list.map((x) => x.id)).toEqual([5]);
    s.take({ kind: 'clear' }, 0);
    expect(s.age(0)).toBe(false);
    s.take({ kind: 'point', at: [0, 0, 1] }, 0);
    expect(s.age(pointLastsMs - 1)).toBe(true);
    expect(s.age(pointLastsMs + 1)).toBe(false);
    expect(s.point).toBeNull();
  });

  it('are bounded, whatever comes', () => {
    const s = new Strokes();
    for (let id = 0; id < 500; id++) s.take({ kind: 'stroke', id, points: Array(128).fill([0, 0, 0]) }, 0);
    for (let k = 0; k < 100; k++) s.take({ kind: 'stroke', id: 499, points: Array(128).fill([0, 0, 0]) }, 0);
    expect(s.list.length).toBe(60);
    expect(s.list.at(-1)!.points.length).toBe(2000);
  });
});

describe('the overview', () => {
  it('shows an alarm that came again as one line', () => {
    const alarm = (what: string, timeS: number) => ({ kind: 'fault', text: what, timeS });
    const lines = alarmLines([alarm('torn', 2), alarm('bleeds', 3), alarm('torn', 4)]);
    expect(lines.map((l) => l.replace(/^\S+ /, ''))).toEqual(['bleeds', 'torn ×2']);
    expect(alarmLines([])).toEqual([]);
  });

  it('says how a station stands', () => {
    const at = (station: object, more: object = {}) =>
      standingOf(stationsOf([{ name: 'A', url: 'http://a/', error: '', picture: 1, station, ...more }])[0]!);
    expect(at({ state: 'running', frame_age_ms: 20, alarms: [] })).toBe('fine');
    expect(at({ state: 'running', frame_age_ms: 20, alarms: [{ kind: 'fault', text: 'torn' }] })).toBe('alarm');
    expect(at({ state: 'running', frame_age_ms: 9000 })).toBe('silent');
    expect(at({})).toBe('idle');
    expect(at({ state: 'running', frame_age_ms: 20 }, { error: 'timed out' })).toBe('away');
    expect(stationsOf('x')).toEqual([]);
    expect(stationsOf([null])[0]).toMatchObject({ name: '', alarms: [], frameAgeMs: -1 });
  });
});

describe('a login', () => {
  it('leads to pages of the same gateway only', () => {
    const base = new URL('https://trainer.local:8080/');
    expect(nextPage('/?role=instructor', base).href).toBe('https://trainer.local:8080/?role=instructor');
    expect(nextPage('/replay.html?session=a', base).pathname).toBe('/replay.html');
    for (const bad of ['', '//evil.example/', 'https://evil.example/', '/\\evil.example/', '/login.html', '/x/../a.js'])
      expect(nextPage(bad, base).href).toBe('https://trainer.local:8080/index.html');
  });
});
