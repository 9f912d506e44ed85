// SPDX-License-Identifier: GPL-3.0-or-later
// Where recorded sessions come from: the gateway of this machine, or a file that a person chooses.
import { list, text } from '../hud/state';
import { finite } from '../json_values';
import { answered, type ByteSource, RemoteSource } from './byte_source';

export interface Note {
  timeS: number;
  text: string;
}

export interface ListedSession {
  name: string;
  bytes: number;
}

const at = (name: string, what = '') => new URL(`sessions/${encodeURIComponent(name)}${what}`, location.href).href;

/** Newest first. */
export async function listSessions(): Promise<ListedSession[]> {
  const response = await answered(fetch(new URL('sessions', location.href), { cache: 'no-store' }));
  return list(await response.json()).map((s) => ({ name: text(s.name), bytes: finite(s.bytes) ?? 0 }));
}

/** A recording of the gateway, which is read as far as it is needed. */
export const sessionOf = (name: string): Promise<ByteSource> => RemoteSource.open(at(name));

export function parseNotes(json: unknown): Note[] {
  return list(json)
    .map((n) => ({ timeS: finite(n.time_s) ?? NaN, text: text(n.text) }))
    .filter((n) => Number.isFinite(n.timeS) && n.text !== '')
    .sort((a, b) => a.timeS - b.timeS);
}

export const notesJson = (notes: readonly Note[]): string =>
  JSON.stringify(
    notes.map((n) => ({ time_s: Number(n.timeS.toFixed(3)), text: n.text })),
    null,
    1,
  );

/** Notes beside a session of the gateway. */
export async function fetchNotes(name: string): Promise<Note[]> {
  return parseNotes(await (await answered(fetch(at(name, '/notes'), { cache: 'no-store' }))).json());
}

export async function storeNotes(name: string, notes: readonly Note[]): Promise<void> {
  const headers = { 'content-type': 'application/json' };
  await answered(fetch(at(name, '/notes'), { method: 'PUT', headers, body: notesJson(notes) }));
}

/** Gives a file to the person. */
export function download(name: string, data: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(data);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
