// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set: KERNEL_NAME, KERNEL_BYTES (of a vector), KERNEL_NV x KERNEL_NR the register tile.
// Contains every kernel for double and float. Only the number of lanes differs.
#include <cmath>
#include <cstring>

#include "core/linalg/kernels.h"

namespace insula::KERNEL_NAME {
namespace {

template <class T>
constexpr int W = KERNEL_BYTES / int(sizeof(T));  // numbers a vector
constexpr int NV = KERNEL_NV;                     // vectors of rows in a tile
constexpr int NR = KERNEL_NR;                     // columns in a tile

template <class T>
struct Vector;
template <>
struct Vector<double> {
  typedef double type __attribute__((vector_size(KERNEL_BYTES), aligned(8), may_alias));
};
template <>
struct Vector<float> {
  typedef float type __attribute__((vector_size(KERNEL_BYTES), aligned(4), may_alias));
};
template <class T>
using V = typename Vector<T>::type;

template <class T>
inline V<T> load(const T* p) {
  return *reinterpret_cast<const V<T>*>(p);
}
template <class T>
inline void store(T* p, V<T> v) {
  *reinterpret_cast<V<T>*>(p) = v;
}

// One register tile: nv vectors of rows times NR columns; `cols` of them are stored. B may be read NR wide.
template <int nv, bool add, class T>
inline __attribute__((always_inline)) void tile(T* c, int ldc, const T* a, int lda, const T* b, int ldb, int cols,
                                                int k) {
  V<T> acc[nv][NR];
  for (int v = 0; v < nv; ++v)
    for (int j = 0; j < NR; ++j) acc[v][j] = V<T>{};
  for (int p = 0; p < k; ++p) {
    const T* ap = a + long(p) * lda;
    const T* bp = b + long(p) * ldb;
    V<T> av[nv];
#pragma GCC unroll 8
    for (int v = 0; v < nv; ++v) av[v] = load(ap + v * W<T>);
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
        T* p = c + long(j) * ldc + v * W<T>;
        store(p, add ? load(p) + acc[v][j] : load(p) - acc[v][j]);
      }
  } else {
    for (int j = 0; j < cols; ++j)
      for (int v = 0; v < nv; ++v) {
        T* p = c + long(j) * ldc + v * W<T>;
        store(p, add ? load(p) + acc[v][j] : load(p) - acc[v][j]);
      }
  }
}

template <bool add, class T>
void gemm(T* c, int ldc, const T* a, int lda, const T* b, int ldb, int m, int n, int k, bool lower) {
  for (int j = 0; j < n; j += NR) {
    const int cols = n - j < NR ? n - j : NR;
    int i = lower ? j / W<T> * W<T> : 0;
    T* cj = c + long(j) * ldc;
    for (; i + (NV - 1) * W<T> < m; i += NV * W<T>) tile<NV, add>(cj + i, ldc, a + i, lda, b + j, ldb, cols, k);
    const int left = m > i ? (m - i + W<T> - 1) / W<T> : 0;
    if constexpr (NV > 2)
      if (left == 2) tile<2, add>(cj + i, ldc, a + i, lda, b + j, ldb, cols, k);
    if (left == 1) tile<1, add>(cj + i, ldc, a + i, lda, b + j, ldb, cols, k);
  }
}

template <class T>
void gemm_sub(T* c, int ldc, const T* a, int lda, const T* b, int ldb, int m, int n, int k) {
  gemm<false>(c, ldc, a, lda, b, ldb, m, n, k, false);
}
template <class T>
void gemm_add(T* c, int ldc, const T* a, int lda, const T* b, int ldb, int m, int n, int k) {
  gemm<true>(c, ldc, a, lda, b, ldb, m, n, k, false);
}
template <class T>
void syrk_add(T* c, int ldc, const T* a, int lda, int m, int k) {
  gemm<true>(c, ldc, a, lda, a, lda, m, m, k, true);
}
template <class T>
void syrk_sub(T* c, int ldc, const T* a, int lda, int m, int k) {
  gemm<false>(c, ldc, a, lda, a, lda, m, m, k, true);
}

template <int nv, class T>
inline __attribute__((always_inline)) void row_tile(T* y, long ldy, const int* index, int rows, const T* l, int ldl,
                                                    const T* x, long ldx, int k) {
  V<T> acc[NR][nv];
  for (int r = 0; r < NR; ++r)
    for (int v = 0; v < nv; ++v) acc[r][v] = V<T>{};
  for (int p = 0; p < k; ++p) {
    const T* lp = l + long(p) * ldl;
    const T* xp = x + p * ldx;
    V<T> xv[nv];
#pragma GCC unroll 8
    for (int v = 0; v < nv; ++v) xv[v] = load(xp + v * W<T>);
#pragma GCC unroll 8
    for (int r = 0; r < NR; ++r)
#pragma GCC unroll 8
      for (int v = 0; v < nv; ++v) acc[r][v] += xv[v] * lp[r];
  }
  if (rows == NR) {
#pragma GCC unroll 8
    for (int r = 0; r < NR; ++r) {
      T* yr = y + index[r] * ldy;
#pragma GCC unroll 8
      for (int v = 0; v < nv; ++v) store(yr + v * W<T>, load(yr + v * W<T>) - acc[r][v]);
    }
  } else {
    for (int r = 0; r < rows; ++r) {
      T* yr = y + index[r] * ldy;
      for (int v = 0; v < nv; ++v) store(yr + v * W<T>, load(yr + v * W<T>) - acc[r][v]);
    }
  }
}

template <class T>
void rows_sub(T* y, long ldy, const int* index, int rows, const T* l, int ldl, const T* x, long ldx, int k, int m) {
  for (int r = 0; r < rows; r += NR) {
    const int left = rows - r < NR ? rows - r : NR;
    int c = 0;
    for (; c + NV * W<T> <= m; c += NV * W<T>) row_tile<NV>(y + c, ldy, index + r, left, l + r, ldl, x + c, ldx, k);
    for (; c < m; c += W<T>) row_tile<1>(y + c, ldy, index + r, left, l + r, ldl, x + c, ldx, k);
  }
}

// The rows of a panel below its diagonal block d of w columns, one vector at a time. Only the part of the last vector
// that belongs to the panel is stored, since the next column follows.
template <int fixed, class T>
inline __attribute__((always_inline)) void solve_below(T* d, int lda, int n, const T* inv, int width = 0) {
  const int w = fixed > 0 ? fixed : width;
  for (int i = w; i < n; i += W<T>) {
    V<T> x[NR];
#pragma GCC unroll 8
    for (int c = 0; c < w; ++c) {
      V<T> s = load(d + i + long(c) * lda);
#pragma GCC unroll 8
      for (int k = 0; k < c; ++k) s -= x[k] * d[c + long(k) * lda];
      x[c] = s * inv[c];
      if (i + W<T> <= n) store(d + i + long(c) * lda, x[c]);
      else __builtin_memcpy(d + i + long(c) * lda, &x[c], sizeof(T) * std::size_t(n - i));
    }
  }
}

template <class T>
int cholesky_panel(T* a, int lda, int rows, int cols, T* inverse) {
  for (int j = 0; j < cols; j += NR) {
    const int w = cols - j < NR ? cols - j : NR;
    T* d = a + j + long(j) * lda;  // diagonal block
    if (j > 0) gemm<false>(d, lda, a + j, lda, a + j, lda, rows - j, w, j, false);
    T* inv = inverse + j;
    for (int c = 0; c < w; ++c) {  // diagonal block, small, so column by column
      T p = d[c + long(c) * lda];
      for (int k = 0; k < c; ++k) p -= d[c + long(k) * lda] * d[c + long(k) * lda];
      if (!(p > 0)) return j + c;
      p = std::sqrt(p);
      inv[c] = 1 / p;
      d[c + long(c) * lda] = p;
      for (int r = c + 1; r < w; ++r) {
        T s = d[r + long(c) * lda];
        for (int k = 0; k < c; ++k) s -= d[r + long(k) * lda] * d[c + long(k) * lda];
        d[r + long(c) * lda] = s * inv[c];
      }
    }
    if (w == NR) solve_below<NR>(d, lda, rows - j, inv);
    else if (w == 3) solve_below<3>(d, lda, rows - j, inv);
    else if (w == 1) solve_below<1>(d, lda, rows - j, inv);
    else if (w == 2) solve_below<2>(d, lda, rows - j, inv);
    else solve_below<0>(d, lda, rows - j, inv, w);
  }
  return -1;
}

template <class T>
void lower_solve_rows(const T* l, int ldl, const T* inverse, int cols, T* x, long ldx, int m) {
  static const int identity[64] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15,
                                   16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31,
                                   32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47,
                                   48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63};
  for (int j = 0; j < cols; j += NR) {
    const int w = cols - j < NR ? cols - j : NR;
    const T* d = l + j + long(j) * ldl;
    if (j > 0) rows_sub(x + j * ldx, ldx, identity, w, l + j, ldl, x, ldx, j, m);
    const T* inv = inverse + j;
    for (int i = 0; i < m; i += W<T>) {
      V<T> xv[NR];
      for (int c = 0; c < w; ++c) {
        V<T> s = load(x + (j + c) * ldx + i);
        for (int k = 0; k < c; ++k) s -= xv[k] * d[c + long(k) * ldl];
        xv[c] = s * inv[c];
        store(x + (j + c) * ldx + i, xv[c]);
      }
    }
  }
}

// The sum of a vector's n numbers: the upper half is added to the lower one repeatedly.
template <class T, int n, class Vec>
inline __attribute__((always_inline)) T total(Vec v) {
  if constexpr (n == 1) {
    return v[0];
  } else if constexpr (n == 2) {
    return v[0] + v[1];
  } else {
    typedef T Half __attribute__((vector_size(n / 2 * sizeof(T))));
    Half lower, upper;
    __builtin_memcpy(&lower, &v, sizeof lower);
    __builtin_memcpy(&upper, reinterpret_cast<const char*>(&v) + sizeof lower, sizeof upper);
    return total<T, n / 2>(Half(lower + upper));
  }
}

template <int n, class T>
inline __attribute__((always_inline)) void take_columns(T* y, const T* a, long lda, const T* x, int m) {
  T factor[n];
  for (int c = 0; c < n; ++c) factor[c] = x[c];
  for (int r = 0; r < m; r += W<T>) {
    V<T> s = load(a + r) * factor[0];
#pragma GCC unroll 8
    for (int c = 1; c < n; ++c) s += load(a + c * lda + r) * factor[c];
    store(y + r, load(y + r) - s);
  }
}

template <int n, class T>
inline __attribute__((always_inline)) void dot_columns(T* out, const T* a, long lda, const T* x, int m) {
  V<T> s[n];
  for (int c = 0; c < n; ++c) s[c] = V<T>{};
  for (int r = 0; r < m; r += W<T>) {
    const V<T> xr = load(x + r);
#pragma GCC unroll 8
    for (int c = 0; c < n; ++c) s[c] += load(a + c * lda + r) * xr;
  }
  for (int c = 0; c < n; ++c) {
    out[c] = total<T, W<T>>(s[c]);
  }
}

template <class T>
void columns_dot(T* out, const T* a, long lda, const T* x, int m, int n) {
  int c = 0;
  for (; c + 6 <= n; c += 6) dot_columns<6>(out + c, a + c * lda, lda, x, m);
  for (; c + 3 <= n; c += 3) dot_columns<3>(out + c, a + c * lda, lda, x, m);
  for (; c < n; ++c) dot_columns<1>(out + c, a + c * lda, lda, x, m);
}

template <class T>
void columns_sub(T* y, const T* a, long lda, const T* x, int m, int n) {
  int c = 0;
  for (; c + 6 <= n; c += 6) take_columns<6>(y, a + c * lda, lda, x + c, m);
  for (; c + 3 <= n; c += 3) take_columns<3>(y, a + c * lda, lda, x + c, m);
  for (; c < n; ++c) take_columns<1>(y, a + c * lda, lda, x + c, m);
}

// Substitution with n columns of a front from column `first` on. The effect of each result is subtracted at once, so
// that the next one waits for one product instead of a sum.
template <int n, class T>
inline __attribute__((always_inline)) void forward_columns(const T* l, long lda, const T* inverse, T* t, int rows) {
  T x[n];
  for (int c = 0; c < n; ++c) x[c] = t[c];
#pragma GCC unroll 8
  for (int c = 0; c < n; ++c) {
    x[c] *= inverse[c];
#pragma GCC unroll 8
    for (int r = c + 1; r < n; ++r) x[r] -= l[c * lda + r] * x[c];
  }
  for (int c = 0; c < n; ++c) t[c] = x[c];
  take_columns<n>(t + n, l + n, lda, x, rows - n);
}
template <int n, class T>
inline __attribute__((always_inline)) void backward_columns(const T* l, long lda, const T* inverse, T* t, int rows) {
  T x[n];
  dot_columns<n>(x, l + n, lda, t + n, rows - n);
  for (int c = 0; c < n; ++c) x[c] = t[c] - x[c];
#pragma GCC unroll 8
  for (int c = n - 1; c >= 0; --c) {
    x[c] *= inverse[c];
#pragma GCC unroll 8
    for (int r = 0; r < c; ++r) x[r] -= l[r * lda + c] * x[c];
  }
  for (int c = 0; c < n; ++c) t[c] = x[c];
}

// Columns come in threes, one for each scalar of a node.
template <class T>
void front_forward(const T* l, int lda, const T* inverse, T* t, int own, int rows) {
  int c = 0;
  for (; c + 6 <= own; c += 6) forward_columns<6>(l + c + long(c) * lda, lda, inverse + c, t + c, rows - c);
  if (c < own) forward_columns<3>(l + c + long(c) * lda, lda, inverse + c, t + c, rows - c);
}
template <class T>
void front_backward(const T* l, int lda, const T* inverse, T* t, int own, int rows) {
  int c = own;
  if (c % 6 != 0) c -= 3, backward_columns<3>(l + c + long(c) * lda, lda, inverse + c, t + c, rows - c);
  while (c > 0) c -= 6, backward_columns<6>(l + c + long(c) * lda, lda, inverse + c, t + c, rows - c);
}

template <class T>
T multiply_add(long n) {
  constexpr int chains = NV * NR;  // as many as the registers of every set hold
  V<T> acc[chains], a = V<T>{} + T(0.999), b = V<T>{} + T(1e-3);
  for (int q = 0; q < chains; ++q) acc[q] = V<T>{} + T(q);
  for (long i = 0; i < n * 24 / chains; ++i)
#pragma GCC unroll 24
    for (int q = 0; q < chains; ++q) acc[q] = acc[q] * a + b;
  T sum = 0;
  for (int q = 0; q < chains; ++q) sum += acc[q][0];
  return sum;
}

// One number at a time, since three numbers are not a vector, and memory bandwidth is the bound.
void block_product(int nodes, const int* start, const int* row, const double* block, const double* x, double* y) {
  for (int j = 0; j < nodes; ++j) {
    const double x0 = x[3L * j], x1 = x[3L * j + 1], x2 = x[3L * j + 2];
    const double* d = block + 9L * start[j];  // the diagonal's
    double y0 = d[0] * x0 + d[3] * x1 + d[6] * x2, y1 = d[1] * x0 + d[4] * x1 + d[7] * x2,
           y2 = d[2] * x0 + d[5] * x1 + d[8] * x2;
    for (int s = start[j] + 1; s < start[j + 1]; ++s) {
      const double* b = block + 9L * s;
      const double* xi = x + 3L * row[s];
      double* yi = y + 3L * row[s];
      yi[0] += b[0] * x0 + b[3] * x1 + b[6] * x2;
      yi[1] += b[1] * x0 + b[4] * x1 + b[7] * x2;
      yi[2] += b[2] * x0 + b[5] * x1 + b[8] * x2;
      y0 += b[0] * xi[0] + b[1] * xi[1] + b[2] * xi[2];
      y1 += b[3] * xi[0] + b[4] * xi[1] + b[5] * xi[2];
      y2 += b[6] * xi[0] + b[7] * xi[1] + b[8] * xi[2];
    }
    y[3L * j] += y0;
    y[3L * j + 1] += y1;
    y[3L * j + 2] += y2;
  }
}

}  // namespace

#define KERNEL_STRING2(x) #x
#define KERNEL_STRING(x) KERNEL_STRING2(x)
template <class T>
constexpr KernelsOf<T> table_of = {KERNEL_STRING(KERNEL_NAME),
                                   W<T>,
                                   gemm_sub<T>,
                                   gemm_add<T>,
                                   syrk_add<T>,
                                   syrk_sub<T>,
                                   rows_sub<T>,
                                   cholesky_panel<T>,
                                   lower_solve_rows<T>,
                                   columns_dot<T>,
                                   columns_sub<T>,
                                   front_forward<T>,
                                   front_backward<T>,
                                   multiply_add<T>};
extern const KernelSet table;
const KernelSet table = {table_of<double>, table_of<float>, block_product};

}  // namespace insula::KERNEL_NAME
