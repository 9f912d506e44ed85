// SPDX-License-Identifier: GPL-3.0-or-later
// The dense inner loops of the solver, compiled once per instruction set and chosen at run time. The bits of a result
// depend on the instruction set, never on the build type or the number of threads.
#pragma once

namespace insula {

/// `Real` is double or float.
template <class Real>
struct KernelsOf {
  const char* name;
  int width;  ///< numbers in a vector; rows of operands may be read up to this far past their end

  /// C[i + j ldc] -= sum_k A[i + k lda] B[j + k ldb], i < m, j < n. Rows of C up to the next multiple of `width` may be
  /// overwritten, so C's leading dimension is padded.
  void (*gemm_sub)(Real* c, int ldc, const Real* a, int lda, const Real* b, int ldb, int m, int n, int k);
  void (*gemm_add)(Real* c, int ldc, const Real* a, int lda, const Real* b, int ldb, int m, int n, int k);
  /// As gemm_add with A = B, but only for blocks that touch j <= i.
  void (*syrk_add)(Real* c, int ldc, const Real* a, int lda, int m, int k);
  /// As gemm_sub with A = B, but only for blocks that touch j <= i.
  void (*syrk_sub)(Real* c, int ldc, const Real* a, int lda, int m, int k);
  /// Rows: y_r[0..m) -= sum_k L[r + k ldl] x[k ldx + 0..m), r < rows; y_r = y + index[r] ldy. m a multiple of width.
  void (*rows_sub)(Real* y, long ldy, const int* index, int rows, const Real* l, int ldl, const Real* x, long ldx,
                   int k, int m);
  /// Cholesky of a column-major panel: rows x cols, lower, in place, including the rows below its triangle (L21 = A21
  /// L11^-T). `inverse` gets the reciprocals of the diagonal. Returns -1, or the column whose pivot was not positive.
  int (*cholesky_panel)(Real* a, int lda, int rows, int cols, Real* inverse);
  /// Forward substitution with many right-hand sides: x (cols x m, row-major) = L11^-1 x.
  void (*lower_solve_rows)(const Real* l, int ldl, const Real* inverse, int cols, Real* x, long ldx, int m);
  /// out[c] = sum_r A[r + c lda] x[r], r < m, c < n. Up to `width` numbers past the end of x must be zero; those of A
  /// must be finite.
  void (*columns_dot)(Real* out, const Real* a, long lda, const Real* x, int m, int n);
  /// y[r] -= sum_c A[r + c lda] x[c], r < m, c < n. Up to `width` numbers past the end of y are overwritten.
  void (*columns_sub)(Real* y, const Real* a, long lda, const Real* x, int m, int n);
  /// One right-hand side and the panel of cholesky_panel(), with `own` columns (a multiple of three): t[0..own) :=
  /// L11^-1 t[0..own), then subtracts the update from t[own..rows). Up to `width` numbers past the end of t are
  /// overwritten.
  void (*front_forward)(const Real* panel, int lda, const Real* inverse, Real* t, int own, int rows);
  /// t[0..own) := L11^-T (t[0..own) - L21^T t[own..rows)). Up to `width` numbers past the end of t must be zero.
  void (*front_backward)(const Real* panel, int lda, const Real* inverse, Real* t, int own, int rows);
  /// Computes 24 `width` n multiplications and additions in registers, at the peak rate of a core. Returns their sum.
  Real (*multiply_add)(long n);
};
using Kernels = KernelsOf<double>;
/// y += A x for a symmetric A of 3x3 blocks. Columns hold their lower triangle with the diagonal first (BlockMatrix).
using BlockProduct = void (*)(int nodes, const int* start, const int* row, const double* block, const double* x,
                              double* y);
/// The tables that are compiled for one instruction set.
struct KernelSet {
  KernelsOf<double> f64;
  KernelsOf<float> f32;
  BlockProduct block_product;
};

/// Kernels for the chosen instruction set (core/linalg/instruction_set.h).
template <class Real>
const KernelsOf<Real>& kernels_of();
template <>
const KernelsOf<double>& kernels_of<double>();
template <>
const KernelsOf<float>& kernels_of<float>();
BlockProduct block_product();
inline const Kernels& kernels() { return kernels_of<double>(); }

}  // namespace insula
