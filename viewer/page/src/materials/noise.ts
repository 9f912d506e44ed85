// SPDX-License-Identifier: GPL-3.0-or-later
// Gradient noise as a tiling 3D texture: value in R, its gradient in GBA. One fetch serves colour and bump, and mip
// levels keep it from shimmering.
import * as THREE from 'three';
import { makeRandom } from '../random';

const size = 64;
const period = 8;
const cell = size / period;

let shared: THREE.Data3DTexture | null = null;

export function noiseTexture(): THREE.Data3DTexture {
  return (shared ??= make());
}

/** Perlin's gradient noise on the grid, -1..1, tiling. */
function values(): Float32Array {
  const random = makeRandom(7);
  const gradients = Array.from({ length: period ** 3 }, () => {
    const z = 2 * random() - 1;
    const a = 2 * Math.PI * random();
    const r = Math.sqrt(1 - z * z);
    return [r * Math.cos(a), r * Math.sin(a), z];
  });
  const at = (x: number, y: number, z: number) =>
    gradients[((x % period) * period + (y % period)) * period + (z % period)]!;
  const fade = (t: number) => t * t * t * (t * (t * 6 - 15) + 10);
  const value = new Float32Array(size ** 3);
  for (let z = 0; z < size; z++)
    for (let y = 0; y < size; y++)
      for (let x = 0; x < size; x++) {
        const gx = x / cell;
        const gy = y / cell;
        const gz = z / cell;
        const i = Math.floor(gx);
        const j = Math.floor(gy);
        const k = Math.floor(gz);
        const f = gx - i;
        const g = gy - j;
        const h = gz - k;
        const u = fade(f);
        const v = fade(g);
        const w = fade(h);
        let sum = 0;
        for (let c = 0; c < 8; c++) {
          const a = c & 1;
          const b = (c >> 1) & 1;
          const d = c >> 2;
          const q = at(i + a, j + b, k + d);
          sum +=
            (a ? u : 1 - u) * (b ? v : 1 - v) * (d ? w : 1 - w) * (q[0]! * (f - a) + q[1]! * (g - b) + q[2]! * (h - d));
        }
        value[(z * size + y) * size + x] = sum;
      }
  return value;
}

function make(): THREE.Data3DTexture {
  const value = values();
  const data = new Uint8Array(size ** 3 * 4);
  const v = (x: number, y: number, z: number) =>
    value[(((z + size) % size) * size + ((y + size) % size)) * size + ((x + size) % size)]!;
  const byte = (t: number) => Math.max(0, Math.min(255, Math.round(127.5 + 127.5 * t)));
  for (let z = 0, o = 0; z < size; z++)
    for (let y = 0; y < size; y++)
      for (let x = 0; x < size; x++, o += 4) {
        data[o] = byte(v(x, y, z) * 1.35);
        // Per cell, scaled into the byte range.
        data[o + 1] = byte((v(x + 1, y, z) - v(x - 1, y, z)) * cell * 0.25);
        data[o + 2] = byte((v(x, y + 1, z) - v(x, y - 1, z)) * cell * 0.25);
        data[o + 3] = byte((v(x, y, z + 1) - v(x, y, z - 1)) * cell * 0.25);
      }
  const t = new THREE.Data3DTexture(data, size, size, size);
  t.format = THREE.RGBAFormat;
  t.type = THREE.UnsignedByteType;
  t.wrapS = t.wrapT = t.wrapR = THREE.RepeatWrapping;
  t.magFilter = THREE.LinearFilter;
  t.minFilter = THREE.LinearMipmapLinearFilter;
  t.generateMipmaps = true;
  t.needsUpdate = true;
  return t;
}

/**
 * GLSL: noise(p) returns value in x (-1..1) and gradient in yzw, p in cells. bump() tilts a unit normal by a
 * view-space gradient.
 */
export const noiseGlsl = /* glsl */ `
uniform highp sampler3D noise_map;
vec4 noise(vec3 p) { return texture(noise_map, p * ${(1 / period).toFixed(4)}) * 2.0 - 1.0; }
vec3 bump(vec3 n, vec3 g) { return normalize(n - (g - dot(g, n) * n)); }
`;
