// SPDX-License-Identifier: GPL-3.0-or-later
import { unzipSync } from 'fflate';
import { expect, test } from 'vitest';
import { dicomSeries } from '../src/studio/folder/dicom_series';
import { zipped } from '../src/studio/folder/series_zip';
import { dicomImages } from './scan_bytes.mjs';

const { signal } = new AbortController();
const quiet = () => undefined;
const images = (uid: string, count: number): Uint8Array[] =>
  dicomImages([4, 4, count], [1, 1, 1], (x) => x, { uid, description: `series ${uid}`, person: 'Doe^Jane' });
const utf8 = (words: string) => new TextEncoder().encode(words);
const file = (bytes: Uint8Array, name: string) => new File([new Uint8Array(bytes)], name);

test('the series of a folder are told apart, that with the most images first', async () => {
  const files = [
    ...images('1.2.7', 2).map((b, k) => file(b, `a${k}`)),
    ...images('1.2.8', 3).map((b, k) => file(b, `b${k}`)),
    file(utf8('a text'), 'README'),
    file(new Uint8Array([...new Uint8Array(128), ...utf8('DICM\x02')]), 'cut short'),
    file(images('1.2.9', 1)[0]!.subarray(0, 300), 'ends within a tag'),
  ];
  const found = await dicomSeries(files, signal, quiet);
  expect(found.map((s) => [s.uid, s.files.length, s.modality, s.description, s.number])).toEqual([
    ['1.2.8', 3, 'CT', 'series 1.2.8', '8'],
    ['1.2.7', 2, 'CT', 'series 1.2.7', '7'],
  ]);
});

test('images are packed with their bytes and without their names', async () => {
  const all = images('1.2.8', 3);
  const shares: number[] = [];
  const zip = await zipped(
    all.map((b, k) => file(b, `Doe Jane ${k}`)),
    'head.zip',
    signal,
    (done) => shares.push(done),
  );
  const bytes = new Uint8Array(await zip.arrayBuffer());
  expect(zip.name).toBe('head.zip');
  expect(new TextDecoder('latin1').decode(bytes)).not.toContain('Doe Jane');
  const out = unzipSync(bytes);
  expect(Object.keys(out)).toEqual(['image_00001.dcm', 'image_00002.dcm', 'image_00003.dcm']);
  Object.values(out).forEach((image, k) => expect([...image]).toEqual([...all[k]!]));
  expect(shares).toEqual([0, 1 / 3, 2 / 3]);
});

test('a cancelled search and a cancelled packing end', async () => {
  const cancelled = AbortSignal.abort();
  const files = images('1.2.8', 3).map((b, k) => file(b, String(k)));
  await expect(dicomSeries(files, cancelled, quiet)).rejects.toThrow();
  await expect(zipped(files, 'a.zip', cancelled, quiet)).rejects.toThrow();
});
