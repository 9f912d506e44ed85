// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a recording from a server.
import { afterEach, describe, expect, it, vi } from 'vitest';
import { RemoteSource } from '../src/replay/byte_source';

describe('remote source', () => {
  /** A server that gives at most seven bytes at once. */
  function serve(bytes: Uint8Array): void {
    vi.stubGlobal('fetch', (_: string, { headers }: { headers: { range: string } }) => {
      const [from, to] = /bytes=(\d+)-(\d+)/.exec(headers.range)!.slice(1).map(Number);
      const part = bytes.slice(from, Math.min(to! + 1, from! + 7));
      const status = from! < bytes.length ? 206 : 416;
      const range =
        status === 206 ? `bytes ${from}-${from! + part.length - 1}/${bytes.length}` : `bytes */${bytes.length}`;
      return Promise.resolve(new Response(part, { status, headers: { 'content-range': range } }));
    });
  }
  afterEach(() => vi.unstubAllGlobals());

  it('reads parts of a file, in as many answers as the server gives', async () => {
    serve(Uint8Array.from({ length: 100 }, (_, k) => k));
    const s = await RemoteSource.open('x');
    expect(s.size).toBe(100);
    expect([...(await s.read(20, 20))]).toEqual(Array.from({ length: 20 }, (_, k) => 20 + k));
    expect(await s.read(100, 0)).toHaveLength(0);
    await expect(s.read(90, 11)).rejects.toThrow(RangeError);
  });
  it('knows an empty file', async () => {
    serve(new Uint8Array(0));
    expect((await RemoteSource.open('x')).size).toBe(0);
  });
  it('says what the server says, and refuses one that gives no parts', async () => {
    vi.stubGlobal('fetch', () => Promise.resolve(new Response('there is no such session here', { status: 404 })));
    await expect(RemoteSource.open('x')).rejects.toThrow('there is no such session here');
    vi.stubGlobal('fetch', () => Promise.resolve(new Response('all of it')));
    await expect(RemoteSource.open('x')).rejects.toThrow(/no parts/);
  });
});
