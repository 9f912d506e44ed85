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
export function forkScan(size = [96, 96, 72], spacing = [0.4, 0.4, 0.4]) {
  const more = noise();
  return niftiBytes(size, spacing, (x, y, z) => {
    const speck = Math.hypot(x + 12, y + 12, z + 8) < 1.2;
    return (speck ? 600 : isVessel(x, y, z) ? 350 : 40) + 25 * more();
  });
}

/** The same in a head: bone of 900 around tissue, air outside. */
export function headScan(size = [512, 512, 300], spacing = [0.4, 0.4, 0.5]) {
  const more = noise();
  return niftiBytes(size, spacing, (x, y, z) => {
    const r = Math.hypot(x, y, z);
    const tissue = r > 90 ? -1000 : within(r, 78, 86) ? 900 : 40;
    return (isVessel(x, y, z) ? 350 : tissue) + 25 * more();
  });
}
