// SPDX-License-Identifier: GPL-3.0-or-later
// Scans for the browser checks: a forked vessel with a sac as grey values with noise, in a NIfTI file. Millimetres.

const bytesOfHead = 352;

/** A NIfTI-1 file of 16-bit values; value(x, y, z) at millimetres from the middle, right, forward and up. */
export function niftiBytes(size, spacing, value) {
  const [nx, ny, nz] = size;
  const out = Buffer.alloc(bytesOfHead + 2 * nx * ny * nz);
  out.writeInt32LE(348, 0);
  [3, nx, ny, nz, 1, 1, 1, 1].forEach((n, k) => out.writeInt16LE(n, 40 + 2 * k));
  out.writeInt16LE(4, 70); // of 16 bits with a sign
  out.writeInt16LE(16, 72);
  [1, ...spacing, 1, 1, 1, 1].forEach((mm, k) => out.writeFloatLE(mm, 76 + 4 * k));
  out.writeFloatLE(bytesOfHead, 108);
  out.writeFloatLE(1, 112);
  out[123] = 2; // millimetres
  out.writeInt16LE(1, 252);
  out.writeInt16LE(1, 254);
  const first = size.map((n, k) => (-(n - 1) / 2) * spacing[k]);
  for (let r = 0; r < 3; r++) {
    out.writeFloatLE(spacing[r], 280 + 20 * r);
    out.writeFloatLE(first[r], 280 + 16 * r + 12);
    out.writeFloatLE(first[r], 268 + 4 * r);
  }
  out.write('n+1\0', 344, 'latin1');
  const voxels = new Int16Array(out.buffer, out.byteOffset + bytesOfHead, nx * ny * nz);
  let n = 0;
  for (let k = 0; k < nz; k++)
    for (let j = 0; j < ny; j++)
      for (let i = 0; i < nx; i++)
        voxels[n++] = value(first[0] + i * spacing[0], first[1] + j * spacing[1], first[2] + k * spacing[2]);
  return out;
}

const numbers = (values, write, bytes) => {
  const out = Buffer.alloc(bytes * values.length);
  values.forEach((v, k) => out[write](v, bytes * k));
  return out;
};
const ofTag = {
  UI: (v) => Buffer.from(v.length % 2 ? `${v}\0` : v, 'latin1'),
  US: (v) => numbers([v].flat(), 'writeUInt16LE', 2),
  UL: (v) => numbers([v].flat(), 'writeUInt32LE', 4),
};

/** Elements [group, element, representation, value] in explicit little endian (PS3.5, chapter 7.1.2). */
function elements(all) {
  return Buffer.concat(
    all.flatMap(([group, element, kind, value]) => {
      const text = (v) => Buffer.from(v.length % 2 ? `${v} ` : v, 'latin1');
      const bytes = Buffer.isBuffer(value) ? value : (ofTag[kind] ?? text)(value);
      const long = kind === 'OW' || kind === 'OB';
      const head = Buffer.alloc(long ? 12 : 8);
      head.writeUInt16LE(group, 0);
      head.writeUInt16LE(element, 2);
      head.write(kind, 4, 'latin1');
      if (long) head.writeUInt32LE(bytes.length, 8);
      else head.writeUInt16LE(bytes.length, 6);
      return [head, bytes];
    }),
  );
}

/** The images of a series as DICOM files: value(x, y, z) as for niftiBytes. uid: of the series. */
export function dicomImages(size, spacing, value, { uid, description, person }) {
  const [nx, ny, nz] = size;
  const first = size.map((n, k) => (-(n - 1) / 2) * spacing[k]);
  const image = '1.2.840.10008.5.1.4.1.1.2'; // CT
  return Array.from({ length: nz }, (_, k) => {
    const z = first[2] + k * spacing[2];
    const pixels = Buffer.alloc(2 * nx * ny);
    // To the left and backwards, as patients are scanned.
    for (let j = 0; j < ny; j++)
      for (let i = 0; i < nx; i++) {
        const at = value(-(first[0] + i * spacing[0]), -(first[1] + j * spacing[1]), z);
        pixels.writeInt16LE(Math.round(at), 2 * (j * nx + i));
      }
    const meta = elements([
      [2, 2, 'UI', image],
      [2, 3, 'UI', `${uid}.${k + 1}`],
      [2, 0x10, 'UI', '1.2.840.10008.1.2.1'],
    ]);
    const set = elements([
      [8, 0x16, 'UI', image],
      [8, 0x18, 'UI', `${uid}.${k + 1}`],
      [8, 0x60, 'CS', 'CT'],
      [8, 0x103e, 'LO', description],
      [0x10, 0x10, 'PN', person],
      [0x20, 0xd, 'UI', '1.2.3.4'],
      [0x20, 0xe, 'UI', uid],
      [0x20, 0x11, 'IS', uid.split('.').at(-1)],
      [0x20, 0x13, 'IS', String(k + 1)],
      [0x20, 0x32, 'DS', [first[0], first[1], z].map((x) => x.toFixed(4)).join('\\')],
      [0x20, 0x37, 'DS', '1\\0\\0\\0\\1\\0'],
      [0x28, 2, 'US', 1],
      [0x28, 4, 'CS', 'MONOCHROME2'],
      [0x28, 0x10, 'US', ny],
      [0x28, 0x11, 'US', nx],
      [0x28, 0x30, 'DS', `${spacing[1]}\\${spacing[0]}`],
      [0x28, 0x100, 'US', 16],
      [0x28, 0x101, 'US', 16],
      [0x28, 0x102, 'US', 15],
      [0x28, 0x103, 'US', 1],
      [0x7fe0, 0x10, 'OW', pixels],
    ]);
    const length = elements([[2, 0, 'UL', meta.length]]);
    return Buffer.concat([Buffer.alloc(128), Buffer.from('DICM'), length, meta, set]);
  });
}

/** The same numbers each time, -1 to 1. */
function noise() {
  let state = 1;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return state / 2147483648;
  };
}

const within = (x, least, most) => x > least && x < most;

/** A parent along x that forks in front of a sac: to its right a branch goes forward. */
export function isVessel(x, y, z) {
  const parent = within(x, -14, 14) && Math.hypot(y, z) < 1.6;
  const branch = within(y, 0, 14) && Math.hypot(x - 3, z) < 1.3;
  const sac = Math.hypot(x, y, z - 4) < 3;
  return parent || branch || sac;
}

/** An angiogram: vessel 350, tissue 40, a speck of calcium of 600 aside, noise of 25 at most. */
function angiogram() {
  const more = noise();
  return (x, y, z) => {
    const speck = Math.hypot(x + 12, y + 12, z + 8) < 1.2;
    return (speck ? 600 : isVessel(x, y, z) ? 350 : 40) + 25 * more();
  };
}
const forkSize = [96, 96, 72];
const forkSpacing = [0.4, 0.4, 0.4];
export const forkScan = () => niftiBytes(forkSize, forkSpacing, angiogram());
/** The same as a series, with the tag of a person. */
export const forkSeries = (person) =>
  dicomImages(forkSize, forkSpacing, angiogram(), { uid: '1.2.3.5', description: 'CTA thin', person });
/** Two images of another series, which hold nothing. */
export const scout = (person) =>
  dicomImages([16, 16, 2], [10, 10, 10], () => 0, { uid: '1.2.3.4', description: 'Scout', person });

/** The same in a head: bone of 900 around tissue, air outside. */
export function headScan(size = [512, 512, 300], spacing = [0.4, 0.4, 0.5]) {
  const more = noise();
  return niftiBytes(size, spacing, (x, y, z) => {
    const r = Math.hypot(x, y, z);
    const tissue = r > 90 ? -1000 : within(r, 78, 86) ? 900 : 40;
    return (isVessel(x, y, z) ? 350 : tissue) + 25 * more();
  });
}
