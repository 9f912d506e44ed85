// SPDX-License-Identifier: GPL-3.0-or-later
// Which DICOM series a folder holds. Only the beginning of each file is read, and only these tags of it.
import { type DataSet, parseDicom } from 'dicom-parser';

/** As dicom-parser writes tags (PS3.6). */
const tags = { modality: 'x00080060', description: 'x0008103e', uid: 'x0020000e', number: 'x00200011' };
const lastTag = tags.number;
const headBytes = 128 * 1024;
const markAt = 128;

export interface Series {
  uid: string;
  description: string;
  modality: string;
  number: string;
  files: File[];
  bytes: number;
}

/** The tags that were read before the file's beginning ended. */
function tagsOf(bytes: Uint8Array): DataSet | null {
  try {
    return parseDicom(bytes, { untilTag: lastTag });
  } catch (e) {
    return (e as { dataSet?: DataSet }).dataSet ?? null;
  }
}

/** Null: no DICOM image. */
async function seriesOf(file: File): Promise<Omit<Series, 'files' | 'bytes'> | null> {
  const bytes = new Uint8Array(await file.slice(0, headBytes).arrayBuffer());
  if (new TextDecoder('latin1').decode(bytes.subarray(markAt, markAt + 4)) !== 'DICM') return null;
  const set = tagsOf(bytes);
  const value = (tag: string) => (set?.elements[tag] ? (set.string(tag) ?? '') : '');
  const uid = value(tags.uid); // a DICOMDIR has none
  if (uid === '') return null;
  return { uid, description: value(tags.description), modality: value(tags.modality), number: value(tags.number) };
}

/** That with the most images first. */
export async function dicomSeries(
  files: readonly File[],
  signal: AbortSignal,
  share: (done: number) => void,
): Promise<Series[]> {
  const found = new Map<string, Series>();
  for (const [k, file] of files.entries()) {
    signal.throwIfAborted();
    share(k / files.length);
    const series = await seriesOf(file);
    if (!series) continue;
    const known = found.get(series.uid) ?? { ...series, files: [], bytes: 0 };
    known.files.push(file);
    known.bytes += file.size;
    found.set(series.uid, known);
  }
  return [...found.values()].sort((a, b) => b.files.length - a.files.length);
}
