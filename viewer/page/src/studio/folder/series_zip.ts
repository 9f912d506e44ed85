// SPDX-License-Identifier: GPL-3.0-or-later
// The images of a series as one zip file, not compressed. The browser may keep its parts on the disk. Names of the
// files stay here: they may be those of a person.
import { Zip, ZipPassThrough } from 'fflate';

const partBytes = 16 * 1024 * 1024;

/** share: gets how much of it is packed, 0 to 1. */
export async function zipped(
  files: readonly File[],
  name: string,
  signal: AbortSignal,
  share: (done: number) => void,
): Promise<File> {
  const parts: Blob[] = [];
  let open: Uint8Array<ArrayBuffer>[] = [];
  let bytes = 0;
  const close = () => {
    parts.push(new Blob(open));
    open = [];
    bytes = 0;
  };
  let failure: Error | null = null;
  const zip = new Zip((error, chunk) => {
    if (error) failure = error;
    else open.push(chunk as Uint8Array<ArrayBuffer>);
    bytes += chunk.length;
    if (bytes > partBytes) close();
  });
  for (const [k, file] of files.entries()) {
    signal.throwIfAborted();
    share(k / files.length);
    const image = new ZipPassThrough(`image_${String(k + 1).padStart(5, '0')}.dcm`);
    zip.add(image);
    image.push(new Uint8Array(await file.arrayBuffer()), true);
    if (failure) throw failure as Error;
  }
  zip.end();
  close();
  return new File(parts, name, { type: 'application/zip' });
}
