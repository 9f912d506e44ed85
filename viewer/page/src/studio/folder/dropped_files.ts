// SPDX-License-Identifier: GPL-3.0-or-later
// What was dropped: files, or all files of a folder and of those in it.

/** A folder that holds more is none of a single patient. */
const mostEntries = 20_000;

export interface Given {
  /** Of the folder; '': single files. */
  folder: string;
  files: File[];
}

const entriesOf = (reader: FileSystemDirectoryReader): Promise<FileSystemEntry[]> =>
  new Promise((resolve, reject) => reader.readEntries(resolve, reject));

const fileOf = (entry: FileSystemFileEntry): Promise<File> =>
  new Promise((resolve, reject) => entry.file(resolve, reject));

async function filesBelow(folder: FileSystemDirectoryEntry, signal: AbortSignal): Promise<File[]> {
  const out: File[] = [];
  const folders = [folder];
  for (let next = folders.pop(); next; next = folders.pop()) {
    const reader = next.createReader();
    // A reader gives a part of its entries each time, and none at the end.
    for (let some = await entriesOf(reader); some.length > 0; some = await entriesOf(reader)) {
      signal.throwIfAborted();
      for (const entry of some)
        if (entry.isDirectory) folders.push(entry as FileSystemDirectoryEntry);
        else out.push(await fileOf(entry as FileSystemFileEntry));
      if (out.length > mostEntries) return out.slice(0, mostEntries);
    }
  }
  return out;
}

/** Must be called while the drop is handled: afterwards the browser forgets what was dropped. */
export function droppedFiles(data: DataTransfer, signal: AbortSignal): Promise<Given> {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry());
  const folder = entries.find((e): e is FileSystemDirectoryEntry => e?.isDirectory === true);
  const files = [...data.files];
  if (!folder) return Promise.resolve({ folder: '', files });
  return filesBelow(folder, signal).then((below) => ({ folder: folder.name, files: below }));
}

/** Of an input that chooses folders. */
export function chosenFolder(files: FileList): Given {
  const all = [...files].slice(0, mostEntries);
  return { folder: all[0]?.webkitRelativePath.split('/')[0] ?? '', files: all };
}
