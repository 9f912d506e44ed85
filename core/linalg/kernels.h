// SPDX-License-Identifier: GPL-3.0-or-later
// The dense inner loops of the solver, compiled once per instruction set and chosen at run time. The bits of a result
// depend on the instruction set, never on the build type or the number of threads.
#pragma once

namespace insula {

struct Kernels {
  const char* name;
  int width;  ///< doubles a vector; rows of operands may be read up to this far past their end

  /// C[i + j ldc] -= sum_k A[i + k lda] B[j + k ldb], i < m, j < n. Rows of C up to the next multiple of `width` may be
  /// overwritten with garbage; so C's leading dimension is padded.
  void (*gemm_sub)(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m, int n, int k);
  /// As gemm_sub with +=, and only blocks that touch j <= i.
  void (*syrk_add)(double* c, int ldc, const double* a, int lda, int m, int k);
  /// As gemm_sub with A = B, only blocks that touch j <= i.
  void (*syrk_sub)(double* c, int ldc, const double* a, int lda, int m, int k);
  /// Rows: y_r[0..m) -= sum_k L[r + k ldl] x[k ldx + 0..m), r < rows; y_r = y + index[r] ldy. m a multiple of width.
  void (*rows_sub)(double* y, long ldy, const int* index, int rows, const double* l, int ldl, const double* x, long ldx, int k, int m);
  /// Cholesky of a column-major panel: rows x cols, lower, in place, right below its triangle too (L21 = A21 L11^-T).
  /// Returns -1, or the column whose pivot was not above `floor`.
  int (*cholesky_panel)(double* a, int lda, int rows, int cols, double floor);
  /// Forward substitution with many right-hand sides: x (cols x m, row-major) = L11^-1 x.
  void (*lower_solve_rows)(const double* l, int ldl, int cols, double* x, long ldx, int m);
  /// d[0..n) += c0 w0 + c1 w1 + c2 w2.
  void (*axpy3)(double* d, const double* w0, const double* w1, const double* w2, double c0, double c1, double c2, int n);
  /// d[0..n) += c w.
  void (*axpy)(double* d, const double* w, double c, int n);
};

/// The best set this processor has (INSULA_KERNELS=sse2|avx2|avx512 in the environment asks for a lesser one).
const Kernels& kernels();

}  // namespace insula
