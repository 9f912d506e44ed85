// SPDX-License-Identifier: GPL-3.0-or-later
// What the gateway says of the stations of a room, checked before use (viewer/gateway/room.h).

/** A station that announces itself in the network and is not listed. */
export interface FoundStation {
  name: string;
  url: string;
}

export interface RoomView {
  stations: StationView[];
  found: FoundStation[];
  /** Why none are looked for in the network; '': they are. */
  searchError: string;
}

export interface StationView {
  /** Of the gateway, for requests. */
  number: number;
  /** It stays in the list. */
  given: boolean;
  name: string;
  url: string;
  /** Why it does not answer; '': it does. */
  error: string;
  /** Number of its picture; 0: there is none. */
  picture: number;
  person: string;
  title: string;
  /** As in lcm_types/scene_info.lcm; '': nothing runs. */
  state: string;
  timeS: number;
  /** Since the engine's last frame, ms; -1: there was none. */
  frameAgeMs: number;
  alarms: { kind: string; text: string; timeS: number }[];
}

type Json = Record<string, unknown>;
const object = (v: unknown): Json => (typeof v === 'object' && v !== null ? (v as Json) : {});
const text = (v: unknown): string => (typeof v === 'string' ? v : '');
const number = (v: unknown, otherwise = 0): number => (typeof v === 'number' && Number.isFinite(v) ? v : otherwise);

const list = (v: unknown): unknown[] => (Array.isArray(v) ? (v as unknown[]) : []);

/** An address of a page is opened at a click, so nothing but a page's address is taken. */
const isPage = (url: string): boolean => /^https?:\/\/[^/\s]+\/$/.test(url);

export function roomOf(json: unknown): RoomView {
  const said = object(json);
  const found = list(said.found).map((each) => ({ name: text(object(each).name), url: text(object(each).url) }));
  return {
    stations: stationsOf(said.stations),
    found: found.filter((f) => f.name !== '' && isPage(f.url)),
    searchError: text(said.search_error),
  };
}

export function stationsOf(json: unknown): StationView[] {
  return list(json).map((each) => {
    const entry = object(each);
    const said = object(entry.station);
    return {
      number: number(entry.number, -1),
      given: entry.given === true,
      name: text(entry.name),
      url: text(entry.url),
      error: text(entry.error),
      picture: number(entry.picture),
      person: text(said.person),
      title: text(said.title),
      state: text(said.state),
      timeS: number(said.time_s),
      frameAgeMs: number(said.frame_age_ms, -1),
      alarms: list(said.alarms).map((a) => ({
        kind: text(object(a).kind),
        text: text(object(a).text),
        timeS: number(object(a).time_s),
      })),
    };
  });
}

/** An engine that is silent for longer has stopped or hangs. */
export const silentAfterMs = 3000;

export type Standing = 'away' | 'idle' | 'silent' | 'alarm' | 'fine';

export function standingOf(s: StationView): Standing {
  if (s.error !== '') return 'away';
  if (s.state === '' || s.frameAgeMs < 0) return 'idle';
  if (s.frameAgeMs > silentAfterMs) return 'silent';
  return s.alarms.length > 0 ? 'alarm' : 'fine';
}
