// SPDX-License-Identifier: GPL-3.0-or-later
// Talk, strokes, the overview of stations, and where a login leads to.
import { describe, expect, it } from 'vitest';
import { nextPage } from '../src/login/next';
import { longestText, parseRoomMessage, type RoomMessage, sayable } from '../src/room/messages';
import { standingOf, stationsOf } from '../src/room/overview';
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
