// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set: KERNEL_NAME, KERNEL_WIDTH (doubles a vector), KERNEL_NV x KERNEL_NR the register tile.
#include <cmath>
#include <cstring>

#include "core/linalg/kernels.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_WIDTH;
constexpr int NV = KERNEL_NV;  // vectors of rows in a tile
constexpr int NR = KERNEL_NR;  // columns in a tile
typedef double V __attribute__((vector_size(W * 8), aligned(8)));

inline V load(const double* p) { return *reinterpret_cast<const V*>(p); }
inline void store(double* p, V v) { *reinterpret_cast<V*>(p) = v; }

// One register tile: nv vectors of rows times NR columns; `cols` of them are stored. B may be read NR wide.
template <int nv, bool add>
inline __attribute__((always_inline)) void tile(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int cols, int k) {
  V acc[nv][NR];
  for (int v = 0; v < nv; ++v)
    for (int j = 0; j < NR; ++j) acc[v][j] = V{};
  for (int p = 0; p < k; ++p) {
    const double* ap = a + long(p) * lda;
    const double* bp = b + long(p) * ldb;
    V av[nv];
#pragma GCC unroll 8
    for (int v = 0; v < nv; ++v) av[v] = load(ap + v * W);
#pragma GCC unroll 8
    for (int j = 0; j < NR; ++j)
#pragma GCC unroll 8
      for (int v = 0; v < nv; ++v) acc[v][j] += av[v] * bp[j];
  }
  if (cols == NR) {
#pragma GCC unroll 8
    for (int j = 0; j < NR; ++j)
#pragma GCC unroll 8
      for (int v = 0; v < nv; ++v) {
        double* p = c + long(j) * ldc + v * W;
        store(p, add ? load(p) + acc[v][j] : load(p) - acc[v][j]);
      }
  } else {
    for (int j = 0; j < cols; ++j)
      for (int v = 0; v < nv; ++v) {
        double* p = c + long(j) * ldc + v * W;
        store(p, add ? load(p) + acc[v][j] : load(p) - acc[v][j]);
      }
  }
}

template <bool add>
void gemm(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m, int n, int k, bool lower) {
  for (int j = 0; j < n; j += NR) {
    const int cols = n - j < NR ? n - j : NR;
    int i = lower ? j / W * W : 0;
    double* cj = c + long(j) * ldc;
    for (; i + (NV - 1) * W < m; i += NV * W) tile<NV, add>(cj + i, ldc, a + i, lda, b + j, ldb, cols, k);
    const int left = m > i ? (m - i + W - 1) / W : 0;
    if constexpr (NV > 2)
      if (left == 2) tile<2, add>(cj + i, ldc, a + i, lda, b + j, ldb, cols, k);
    if (left == 1) tile<1, add>(cj + i, ldc, a + i, lda, b + j, ldb, cols, k);
  }
}

void gemm_sub(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m, int n, int k) {
  gemm<false>(c, ldc, a, lda, b, ldb, m, n, k, false);
}
void syrk_add(double* c, int ldc, const double* a, int lda, int m, int k) { gemm<true>(c, ldc, a, lda, a, lda, m, m, k, true); }
void syrk_sub(double* c, int ldc, const double* a, int lda, int m, int k) { gemm<false>(c, ldc, a, lda, a, lda, m, m, k, true); }

template <int nv>
inline __attribute__((always_inline)) void row_tile(double* y, long ldy, const int* index, int rows, const double* l, int ldl, const double* x, long ldx, int k) {
  V acc[NR][nv];
  for (int r = 0; r < NR; ++r)
    for (int v = 0; v < nv; ++v) acc[r][v] = V{};
  for (int p = 0; p < k; ++p) {
    const double* lp = l + long(p) * ldl;
    const double* xp = x + p * ldx;
    V xv[nv];
#pragma GCC unroll 8
    for (int v = 0; v < nv; ++v) xv[v] = load(xp + v * W);
#pragma GCC unroll 8
    for (int r = 0; r < NR; ++r)
#pragma GCC unroll 8
      for (int v = 0; v < nv; ++v) acc[r][v] += xv[v] * lp[r];
  }
  if (rows == NR) {
#pragma GCC unroll 8
    for (int r = 0; r < NR; ++r) {
      double* yr = y + index[r] * ldy;
#pragma GCC unroll 8
      for (int v = 0; v < nv; ++v) store(yr + v * W, load(yr + v * W) - acc[r][v]);
    }
  } else {
    for (int r = 0; r < rows; ++r) {
      double* yr = y + index[r] * ldy;
      for (int v = 0; v < nv; ++v) store(yr + v * W, load(yr + v * W) - acc[r][v]);
    }
  }
}

void rows_sub(double* y, long ldy, const int* index, int rows, const double* l, int ldl, const double* x, long ldx, int k, int m) {
  for (int r = 0; r < rows; r += NR) {
    const int left = rows - r < NR ? rows - r : NR;
    int c = 0;
    for (; c + NV * W <= m; c += NV * W) row_tile<NV>(y + c, ldy, index + r, left, l + r, ldl, x + c, ldx, k);
    for (; c < m; c += W) row_tile<1>(y + c, ldy, index + r, left, l + r, ldl, x + c, ldx, k);
  }
}

int cholesky_panel(double* a, int lda, int rows, int cols, double floor) {
  for (int j = 0; j < cols; j += NR) {
    const int w = cols - j < NR ? cols - j : NR;
    double* d = a + j + long(j) * lda;  // diagonal block
    if (j > 0) gemm<false>(d, lda, a + j, lda, a + j, lda, rows - j, w, j, false);
    double inv[NR];
    for (int c = 0; c < w; ++c) {  // diagonal block, small: column by column
      double p = d[c + long(c) * lda];
      for (int k = 0; k < c; ++k) p -= d[c + long(k) * lda] * d[c + long(k) * lda];
      if (!(p > floor)) return j + c;
      p = std::sqrt(p);
      inv[c] = 1.0 / p;
      d[c + long(c) * lda] = p;
      for (int r = c + 1; r < w; ++r) {
        double s = d[r + long(c) * lda];
        for (int k = 0; k < c; ++k) s -= d[r + long(k) * lda] * d[c + long(k) * lda];
        d[r + long(c) * lda] = s * inv[c];
      }
    }
    // Rows below the diagonal block, W at a time.
    int i = w;
    const int n = rows - j;
    for (; i + W <= n; i += W) {
      V x[NR];
      for (int c = 0; c < w; ++c) {
        V s = load(d + i + long(c) * lda);
        for (int k = 0; k < c; ++k) s -= x[k] * d[c + long(k) * lda];
        x[c] = s * inv[c];
        store(d + i + long(c) * lda, x[c]);
      }
    }
    for (; i < n; ++i)
      for (int c = 0; c < w; ++c) {
        double s = d[i + long(c) * lda];
        for (int k = 0; k < c; ++k) s -= d[i + long(k) * lda] * d[c + long(k) * lda];
        d[i + long(c) * lda] = s * inv[c];
      }
  }
  return -1;
}

void lower_solve_rows(const double* l, int ldl, int cols, double* x, long ldx, int m) {
  static const int identity[64] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21,
                                   22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43,
                                   44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63};
  for (int j = 0; j < cols; j += NR) {
    const int w = cols - j < NR ? cols - j : NR;
    const double* d = l + j + long(j) * ldl;
    if (j > 0) rows_sub(x + j * ldx, ldx, identity, w, l + j, ldl, x, ldx, j, m);
    double inv[NR];
    for (int c = 0; c < w; ++c) inv[c] = 1.0 / d[c + long(c) * ldl];
    for (int i = 0; i < m; i += W) {
      V xv[NR];
      for (int c = 0; c < w; ++c) {
        V s = load(x + (j + c) * ldx + i);
        for (int k = 0; k < c; ++k) s -= xv[k] * d[c + long(k) * ldl];
        xv[c] = s * inv[c];
        store(x + (j + c) * ldx + i, xv[c]);
      }
    }
  }
}

void axpy3(double* d, const double* w0, const double* w1, const double* w2, double c0, double c1, double c2, int n) {
  int i = 0;
  for (; i + W <= n; i += W) store(d + i, load(d + i) + load(w0 + i) * c0 + load(w1 + i) * c1 + load(w2 + i) * c2);
  for (; i < n; ++i) d[i] += c0 * w0[i] + c1 * w1[i] + c2 * w2[i];
}

void axpy(double* d, const double* w, double c, int n) {
  int i = 0;
  for (; i + W <= n; i += W) store(d + i, load(d + i) + load(w + i) * c);
  for (; i < n; ++i) d[i] += c * w[i];
}

}  // namespace

#define KERNEL_STRING2(x) #x
#define KERNEL_STRING(x) KERNEL_STRING2(x)
extern const Kernels table;
const Kernels table = {KERNEL_STRING(KERNEL_NAME), W, gemm_sub, syrk_add, syrk_sub, rows_sub, cholesky_panel, lower_solve_rows, axpy3, axpy};

}  // namespace insula::KERNEL_NAME
