// SPDX-License-Identifier: GPL-3.0-or-later
// Fine surfaces that follow the nodes of a body. Positions: x = sum_i w_i x_i over four nodes. Normals: the cofactor
// matrix of the deformation gradient F of each tetrahedron, averaged to the nodes and interpolated like the
// positions, so that the shading stays smooth across tetrahedra: n' ~ sum_i w_i C_i n, with C = cof(F) = sum_k c_k
// (x) e_k / det(E), e_k the rest edges, c_k the cross products of the deformed edges (cof(D) columns). A triangle of
// a shell counts as a tetrahedron whose third edge is its normal. A vertex that is embedded beside its nodes keeps its
// offset: x = sum_i w_i x_i + (X - sum_i w_i X_i).

/** Texels per node in the node texture: position and the three columns of C. */
export const texelsPerNode = 4;
export const textureWidth = 256;

/** Node positions and normal transforms of one body in the layout of its float texture (RGBA per texel). */
export class NodeField {
  readonly rows: number;
  readonly texels: Float32Array<ArrayBuffer>;
  /** Four nodes each; the last is -1 in a triangle. */
  private readonly tets: Int32Array;
  private readonly restEdges: Float32Array;

  /**
   * `quads`: node quadruples of the tetrahedra that carry surface vertices, repeats allowed; `triangles`: of a shell,
   * by nodes.
   */
  constructor(
    readonly rest: Float32Array,
    quads: Uint32Array[],
    triangles: Uint32Array = new Uint32Array(0),
  ) {
    const nodes = rest.length / 3;
    this.rows = Math.max(1, Math.ceil((nodes * texelsPerNode) / textureWidth));
    this.texels = new Float32Array(this.rows * textureWidth * 4);
    this.tets = uniqueElements(rest, quads, triangles);
    this.restEdges = new Float32Array((this.tets.length / 4) * 9);
    const e = new Float64Array(9);
    for (let t = 0; t < this.tets.length / 4; t++) {
      edges(rest, this.tets, t, e);
      // Inverted numbering would flip the normals: the sign goes into the rest edges once.
      const sign = determinant(e) < 0 ? -1 : 1;
      for (let k = 0; k < 9; k++) this.restEdges[t * 9 + k] = e[k]! * sign;
    }
    this.update(rest);
  }

  /** x: node positions, 3 per node. */
  update(x: Float32Array): void {
    const nodes = this.rest.length / 3;
    const out = this.texels;
    for (let i = 0; i < nodes; i++) {
      const o = i * 16;
      out[o] = x[3 * i]!;
      out[o + 1] = x[3 * i + 1]!;
      out[o + 2] = x[3 * i + 2]!;
      out[o + 3] = 1;
      out.fill(0, o + 4, o + 16);
    }
    const d = new Float64Array(9);
    const c = new Float64Array(9);
    const rest = this.restEdges;
    for (let t = 0; t < this.tets.length / 4; t++) {
      edges(x, this.tets, t, d);
      cross(d, 3, 6, c, 0);
      cross(d, 6, 0, c, 3);
      cross(d, 0, 3, c, 6);
      for (let j = 0; j < 3; j++) {
        // Column j of the volume-weighted C.
        const ex = rest[t * 9 + j]!;
        const ey = rest[t * 9 + 3 + j]!;
        const ez = rest[t * 9 + 6 + j]!;
        const cx = c[0]! * ex + c[3]! * ey + c[6]! * ez;
        const cy = c[1]! * ex + c[4]! * ey + c[7]! * ez;
        const cz = c[2]! * ex + c[5]! * ey + c[8]! * ez;
        for (let k = 0; k < 4; k++) {
          if (this.tets[t * 4 + k]! < 0) continue;
          const o = this.tets[t * 4 + k]! * 16 + 4 + j * 4;
          out[o] = out[o]! + cx;
          out[o + 1] = out[o + 1]! + cy;
          out[o + 2] = out[o + 2]! + cz;
        }
      }
    }
    for (let i = 0; i < nodes; i++) {
      const o = i * 16 + 4;
      // Only directions matter later; one common scale a node keeps the interpolation well weighted.
      let s = 0;
      for (let k = 0; k < 12; k++) s += out[o + k]! * out[o + k]!;
      if (s > 0) {
        s = Math.sqrt(3 / s);
        for (let k = 0; k < 12; k++) out[o + k] = out[o + k]! * s;
      } else {
        out[o] = 1;
        out[o + 5] = 1;
        out[o + 10] = 1;
      }
    }
  }
}

/** The same law as the vertex shader, on the CPU; writes position and unit normal. */
export function skinVertex(
  field: NodeField,
  nodes: ArrayLike<number>,
  weights: ArrayLike<number>,
  v: number,
  normal: ArrayLike<number>,
  outPosition: number[],
  outNormal: number[],
  offsets: ArrayLike<number> | null = null,
): void {
  const m = new Float64Array(12);
  let p0 = 0;
  let p1 = 0;
  let p2 = 0;
  for (let k = 0; k < 4; k++) {
    const o = nodes[v * 4 + k]! * 16;
    const w = weights[v * 4 + k]!;
    p0 += w * field.texels[o]!;
    p1 += w * field.texels[o + 1]!;
    p2 += w * field.texels[o + 2]!;
    for (let j = 0; j < 12; j++) m[j] = m[j]! + w * field.texels[o + 4 + j]!;
  }
  if (offsets) {
    p0 += offsets[v * 3]!;
    p1 += offsets[v * 3 + 1]!;
    p2 += offsets[v * 3 + 2]!;
  }
  outPosition[0] = p0;
  outPosition[1] = p1;
  outPosition[2] = p2;
  const a = normal[0]!;
  const b = normal[1]!;
  const c = normal[2]!;
  const nx = m[0]! * a + m[4]! * b + m[8]! * c;
  const ny = m[1]! * a + m[5]! * b + m[9]! * c;
  const nz = m[2]! * a + m[6]! * b + m[10]! * c;
  const l = Math.hypot(nx, ny, nz) || 1;
  outNormal[0] = nx / l;
  outNormal[1] = ny / l;
  outNormal[2] = nz / l;
}

/** Weights of a point in a tetrahedron of rest nodes, extrapolated outside; null when the tetrahedron is flat. */
export function barycentric(
  rest: Float32Array,
  quad: ArrayLike<number>,
  at: number,
  p: ArrayLike<number>,
): [number, number, number, number] | null {
  const e = new Float64Array(9);
  const n0 = quad[at]! * 3;
  for (let k = 0; k < 3; k++)
    for (let j = 0; j < 3; j++) e[k * 3 + j] = rest[quad[at + k + 1]! * 3 + j]! - rest[n0 + j]!;
  const det = determinant(e);
  const size = Math.hypot(e[0]!, e[1]!, e[2]!) * Math.hypot(e[3]!, e[4]!, e[5]!) * Math.hypot(e[6]!, e[7]!, e[8]!);
  if (Math.abs(det) <= 1e-6 * size) return null;
  const d = [p[0]! - rest[n0]!, p[1]! - rest[n0 + 1]!, p[2]! - rest[n0 + 2]!];
  const c = new Float64Array(9);
  cross(e, 3, 6, c, 0);
  cross(e, 6, 0, c, 3);
  cross(e, 0, 3, c, 6);
  const w = [0, 1, 2].map((k) => (d[0]! * c[k * 3]! + d[1]! * c[k * 3 + 1]! + d[2]! * c[k * 3 + 2]!) / det) as [
    number,
    number,
    number,
  ];
  return [1 - w[0] - w[1] - w[2], w[0], w[1], w[2]];
}

function edges(x: Float32Array, tets: ArrayLike<number>, t: number, out: Float64Array): void {
  const a = tets[t * 4]! * 3;
  for (let k = 0; k < 3; k++) {
    const b = tets[t * 4 + 1 + k]! * 3;
    if (b < 0) continue;
    for (let j = 0; j < 3; j++) out[k * 3 + j] = x[b + j]! - x[a + j]!;
  }
  if (tets[t * 4 + 3]! >= 0) return;
  // The normal, as long as the triangle is wide.
  cross(out, 0, 3, out, 6);
  const s = 1 / Math.sqrt(Math.hypot(out[6]!, out[7]!, out[8]!) || 1);
  for (let j = 6; j < 9; j++) out[j] = out[j]! * s;
}

function determinant(e: Float64Array): number {
  return (
    e[0]! * (e[4]! * e[8]! - e[5]! * e[7]!) -
    e[1]! * (e[3]! * e[8]! - e[5]! * e[6]!) +
    e[2]! * (e[3]! * e[7]! - e[4]! * e[6]!)
  );
}

function cross(a: Float64Array, i: number, j: number, out: Float64Array, o: number): void {
  out[o] = a[i + 1]! * a[j + 2]! - a[i + 2]! * a[j + 1]!;
  out[o + 1] = a[i + 2]! * a[j]! - a[i]! * a[j + 2]!;
  out[o + 2] = a[i]! * a[j + 1]! - a[i + 1]! * a[j]!;
}

function uniqueElements(rest: Float32Array, quads: Uint32Array[], triangles: Uint32Array): Int32Array {
  const seen = new Map<string, number[]>();
  const e = new Float64Array(9);
  const take = (nodes: number[]) => {
    const key = nodes.join();
    if (seen.has(key)) return;
    edges(rest, nodes, 0, e);
    const size = Math.hypot(e[0]!, e[1]!, e[2]!) * Math.hypot(e[3]!, e[4]!, e[5]!) * Math.hypot(e[6]!, e[7]!, e[8]!);
    if (Math.abs(determinant(e)) > 1e-6 * size) seen.set(key, nodes);
  };
  for (const q of quads) for (let i = 0; i + 3 < q.length; i += 4) take([q[i]!, q[i + 1]!, q[i + 2]!, q[i + 3]!]);
  for (let i = 0; i + 2 < triangles.length; i += 3) take([triangles[i]!, triangles[i + 1]!, triangles[i + 2]!, -1]);
  return Int32Array.from([...seen.values()].flat());
}

/** What is left of a vertex' rest place when its nodes' share is taken off; it stays constant as the nodes move. */
export function skinOffsets(
  rest: Float32Array,
  positions: ArrayLike<number>,
  nodes: ArrayLike<number>,
  weights: ArrayLike<number>,
): Float32Array {
  const out = new Float32Array(positions.length);
  for (let v = 0; v < positions.length / 3; v++)
    for (let j = 0; j < 3; j++) {
      let x = positions[v * 3 + j]!;
      for (let k = 0; k < 4; k++) x -= weights[v * 4 + k]! * rest[nodes[v * 4 + k]! * 3 + j]!;
      out[v * 3 + j] = x;
    }
  return out;
}

/**
 * The triangles of a shell as its surfaces show them: those that carry picture vertices (three weighted nodes), and the
 * surface's own where each vertex is a node. Empty for a body of tetrahedra.
 */
export function shellTriangles(
  surfaces: { indices: Uint32Array; skinNodes: Uint32Array; skinWeights: Float32Array }[],
): Uint32Array {
  const seen = new Map<string, number[]>();
  const take = (a: number[]) => {
    if (new Set(a).size === 3) seen.set([...a].sort((x, y) => x - y).join(), a);
  };
  for (const s of surfaces) {
    const heavy = (v: number) => {
      const used = new Set<number>();
      for (let k = 0; k < 4; k++) if (Math.abs(s.skinWeights[v * 4 + k]!) > 1e-6) used.add(s.skinNodes[v * 4 + k]!);
      return [...used];
    };
    const of = Array.from({ length: s.skinNodes.length / 4 }, (_, v) => heavy(v));
    // A vertex in a tetrahedron has four: this is no shell.
    if (of.some((n) => n.length > 3)) return new Uint32Array(0);
    for (const n of of) if (n.length === 3) take(n);
    for (let t = 0; t + 2 < s.indices.length; t += 3) {
      const n = [0, 1, 2].map((k) => of[s.indices[t + k]!]!);
      if (n.every((x) => x.length === 1)) take(n.map((x) => x[0]!));
    }
  }
  return Uint32Array.from([...seen.values()].flat());
}
