// SPDX-License-Identifier: GPL-3.0-or-later
// Small readers for the mock server: PLY (binary), gmsh .msh (2.2 and 4.1 ASCII), OBJ. Lengths stay in the file's unit.
import { readFileSync } from 'node:fs';

export function readPly(path) {
  const data = readFileSync(path);
  const end = data.indexOf('end_header\n') + 11;
  const head = data.toString('latin1', 0, end).split('\n');
  if (!head.some((l) => l.startsWith('format binary_little_endian')))
    throw new Error(`${path}: only binary little-endian PLY`);
  const count = (name) => Number(head.find((l) => l.startsWith(`element ${name}`)).split(' ')[2]);
  const vertexAt = head.findIndex((l) => l.startsWith('element vertex'));
  let stride = 0;
  for (let i = vertexAt + 1; head[i].startsWith('property'); i++)
    stride += { float: 4, double: 8, uchar: 1, int: 4 }[head[i].split(' ')[1]];
  const wide = head[vertexAt + 1].includes('double');
  const nv = count('vertex');
  const nt = count('face');
  const positions = new Float32Array(nv * 3);
  for (let v = 0; v < nv; v++)
    for (let k = 0; k < 3; k++)
      positions[v * 3 + k] = wide
        ? data.readDoubleLE(end + v * stride + 8 * k)
        : data.readFloatLE(end + v * stride + 4 * k);
  const indices = new Uint32Array(nt * 3);
  for (let t = 0, o = end + nv * stride; t < nt; t++, o += 13)
    for (let k = 0; k < 3; k++) indices[t * 3 + k] = data.readUInt32LE(o + 1 + 4 * k);
  return { positions, indices };
}

export function readMsh(path) {
  const lines = readFileSync(path, 'latin1').split('\n');
  const at = (name) => lines.findIndex((l) => l.trim() === name) + 1;
  const numbers = (i) => lines[i].trim().split(/\s+/).map(Number);
  const version = numbers(at('$MeshFormat'))[0];
  const positions = [];
  const tets = [];
  const tag = new Map();
  if (version < 4) {
    let i = at('$Nodes');
    const n = numbers(i++)[0];
    for (let k = 0; k < n; k++) {
      const [t, x, y, z] = numbers(i++);
      tag.set(t, positions.length / 3);
      positions.push(x, y, z);
    }
    i = at('$Elements');
    const m = numbers(i++)[0];
    for (let k = 0; k < m; k++) {
      const e = numbers(i++);
      if (e[1] === 4) tets.push(...e.slice(3 + e[2]).map((t) => tag.get(t)));
    }
  } else {
    let i = at('$Nodes');
    const [blocks] = numbers(i++);
    for (let b = 0; b < blocks; b++) {
      const n = numbers(i++)[3];
      const tags = Array.from({ length: n }, () => numbers(i++)[0]);
      for (const t of tags) {
        tag.set(t, positions.length / 3);
        positions.push(...numbers(i++).slice(0, 3));
      }
    }
    i = at('$Elements');
    const [elementBlocks] = numbers(i++);
    for (let b = 0; b < elementBlocks; b++) {
      const [, , type, n] = numbers(i++);
      for (let k = 0; k < n; k++) {
        const e = numbers(i++);
        if (type === 4) tets.push(...e.slice(1, 5).map((t) => tag.get(t)));
      }
    }
  }
  return { positions: Float32Array.from(positions), tets: Uint32Array.from(tets) };
}

export function readObj(path) {
  const v = [];
  const idx = [];
  for (const line of readFileSync(path, 'latin1').split('\n')) {
    const w = line.trim().split(/\s+/);
    if (w[0] === 'v') v.push(+w[1], +w[2], +w[3]);
    else if (w[0] === 'f') {
      const f = w.slice(1).map((x) => parseInt(x, 10) - 1);
      for (let k = 2; k < f.length; k++) idx.push(f[0], f[k - 1], f[k]);
    }
  }
  return { positions: Float32Array.from(v), indices: Uint32Array.from(idx) };
}

/** Nodes and weights that embed points in tetrahedra: the containing one, or the one least outside. */
export function embed(points, nodes, tets) {
  const n = points.length / 3;
  const outNodes = new Uint32Array(n * 4);
  const outWeights = new Float32Array(n * 4);
  const m = tets.length / 4;
  const inverse = new Float64Array(m * 9);
  const centre = new Float64Array(m * 3);
  const radius = new Float64Array(m);
  for (let t = 0; t < m; t++) {
    const p = [0, 1, 2, 3].map((k) => [0, 1, 2].map((j) => nodes[tets[t * 4 + k] * 3 + j]));
    const e = [1, 2, 3].map((k) => [0, 1, 2].map((j) => p[k][j] - p[0][j]));
    const c = [cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1])];
    const det = e[0][0] * c[0][0] + e[0][1] * c[0][1] + e[0][2] * c[0][2];
    for (let k = 0; k < 3; k++) for (let j = 0; j < 3; j++) inverse[t * 9 + k * 3 + j] = c[k][j] / det;
    for (let j = 0; j < 3; j++) centre[t * 3 + j] = (p[0][j] + p[1][j] + p[2][j] + p[3][j]) / 4;
    radius[t] = Math.max(...p.map((q) => Math.hypot(...[0, 1, 2].map((j) => q[j] - centre[t * 3 + j]))));
  }
  for (let v = 0; v < n; v++) {
    const x = points[v * 3];
    const y = points[v * 3 + 1];
    const z = points[v * 3 + 2];
    let best = -Infinity;
    let bestT = 0;
    let bestW = [1, 0, 0, 0];
    for (let t = 0; t < m; t++) {
      const d = Math.hypot(x - centre[t * 3], y - centre[t * 3 + 1], z - centre[t * 3 + 2]);
      if (d > radius[t] * 1.6) continue;
      const o = tets[t * 4] * 3;
      const dx = x - nodes[o];
      const dy = y - nodes[o + 1];
      const dz = z - nodes[o + 2];
      const w = [0, 1, 2].map(
        (k) => inverse[t * 9 + k * 3] * dx + inverse[t * 9 + k * 3 + 1] * dy + inverse[t * 9 + k * 3 + 2] * dz,
      );
      const w0 = 1 - w[0] - w[1] - w[2];
      const least = Math.min(w0, ...w);
      if (least > best) {
        best = least;
        bestT = t;
        bestW = [w0, ...w];
        if (least >= 0) break;
      }
    }
    for (let k = 0; k < 4; k++) {
      outNodes[v * 4 + k] = tets[bestT * 4 + k];
      outWeights[v * 4 + k] = bestW[k];
    }
  }
  return { nodes: outNodes, weights: outWeights };
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
