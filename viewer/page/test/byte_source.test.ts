// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a recording from a server.
import { afterEach, describe, expect, it, vi } from 'vitest';
import { BlobSource, BlockSource, RemoteSource } from '../src/replay/byte_source';

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

describe('block source', () => {
  it('reads small parts that lie side by side with one request, and across blocks', async () => {
    const bytes = Uint8Array.from({ length: 700_000 }, (_, k) => (k * 7) % 251);
    const inner = new BlobSource(new Blob([bytes]));
    let requests = 0;
    const source = new BlockSource({
      size: inner.size,
      read: (at, length) => {
        requests++;
        return inner.read(at, length);
      },
    });
    for (const at of [0, 5, 1000, 200_000]) expect(await source.read(at, 9)).toEqual(bytes.slice(at, at + 9));
    expect(requests).toBe(1);
    expect(await source.read(262_100, 100)).toEqual(bytes.slice(262_100, 262_200));
    expect(await source.read(699_990, 10)).toEqual(bytes.slice(699_990));
    expect(await source.read(10, 600_000)).toEqual(bytes.slice(10, 600_010));
    await expect(source.read(699_991, 10)).rejects.toThrow(RangeError);
  });
  it('asks again for what could not be read', async () => {
    let works = false;
    const source = new BlockSource({
      size: 10,
      read: (_, length) => (works ? Promise.resolve(new Uint8Array(length)) : Promise.reject(new Error('gone'))),
    });
    await expect(source.read(0, 5)).rejects.toThrow('gone');
    works = true;
    expect(await source.read(0, 5)).toHaveLength(5);
  });
});
