// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set: KERNEL_NAME, KERNEL_BYTES (of a vector).
#include "plugins/membrane/hinge_formula.h"
#include "plugins/membrane/stretch_formula.h"
#include "plugins/membrane/wall_batch.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_BYTES / 8;  // doubles a vector
typedef double V __attribute__((vector_size(W * 8)));

inline V load(const double* p) { return *reinterpret_cast<const V*>(p); }

/// Coordinates of a node of each lane.
inline void gather(const double* x, const int* node, V* out) {
  for (int c = 0; c < 3; ++c) {
    V v{};
    for (int i = 0; i < W; ++i) v[i] = x[3 * node[i] + c];
    out[c] = v;
  }
}

void hinges(const HingeBatch& batch, const double* x, double* angle, double* gradient) {
  for (int l = 0; l < batch.count; l += W) {
    const int count = batch.count - l < W ? batch.count - l : W;
    V at[12], before{};
    for (int k = 0; k < 4; ++k) gather(x, batch.node[k] + l, at + 3 * k);
    for (int i = 0; i < count; ++i) before[i] = angle[l + i];
    const HingeShape<V> s = hinge_shape(at, load(batch.least[0] + l), load(batch.least[1] + l));
    const V now = unwrapped(angle_of(s), before);
    for (int i = 0; i < count; ++i) angle[l + i] = now[i];
    if (!gradient) continue;
    V g[12];
    gradient_of(s, g);
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c) gradient[16 * (l + i) + 4 * k + c] = g[3 * k + c][i];
  }
}

void stretch(const TriangleBatch& batch, const double* x, double* force) {
  for (int l = 0; l < batch.count; l += W) {
    V at[3][3], b[3][2], pre[3], u[3], v[3];
    for (int k = 0; k < 3; ++k) {
      gather(x, batch.node[k] + l, at[k]);
      pre[k] = load(batch.pre[k] + l);
      for (int c = 0; c < 2; ++c) b[k][c] = load(batch.b[k][c] + l);
    }
    for (int c = 0; c < 3; ++c) u[c] = at[1][c] - at[0][c], v[c] = at[2][c] - at[0][c];
    const StretchOf<V> s = stretch_of(u, v, b);
    const StressOf<V> t = stress_of(s, load(batch.mu + l), load(batch.lambda + l), pre);
    const int count = batch.count - l < W ? batch.count - l : W;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) {
        const V f = t.p0[c] * b[k][0] + t.p1[c] * b[k][1];
        for (int i = 0; i < count; ++i) force[3 * batch.node[k][l + i] + c] -= f[i];
      }
  }
}

}  // namespace

extern const WallKernels wall_table;
const WallKernels wall_table = {hinges, stretch};

}  // namespace insula::KERNEL_NAME
