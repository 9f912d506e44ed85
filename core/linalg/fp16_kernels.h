// SPDX-License-Identifier: GPL-3.0-or-later
// Solves with one front of a factor whose numbers are 16-bit floats, compiled once per instruction set. The trapezoid
// of a front, without its unit diagonal, is one stream in the order in which both solves read it, or the reverse. It is
// cut into groups of at most half_columns columns, always a multiple of three. A group holds its strict triangle,
// column by column and filled up to half_lanes numbers. The rows below follow, half_lanes rows of one column after
// another.
#pragma once
#include <cstdint>

namespace insula {

using Half = std::uint16_t;  ///< bits of an IEEE binary16

inline constexpr int half_columns = 6;
inline constexpr int half_lanes = 16;

/// Number of columns that the stream combines from column c on, of `own` columns.
constexpr int half_columns_from(int c, int own) { return c + half_columns <= own ? half_columns : 3; }

/// Number of stream entries of `columns` columns from `first` on, for a front with that many rows.
constexpr long half_block_size(int rows, int first, int columns) {
  const int below = rows - first - columns;
  return half_lanes + long((below + half_lanes - 1) / half_lanes) * half_lanes * columns;
}

struct Fp16Kernels {
  /// The nearest 16-bit floats. Values that are too large become the largest one.
  void (*to_half)(Half* out, const float* in, long n);
  /// t[0..own) := L11^-1 t[0..own), t[own..rows) -= L21 t[0..own). Up to half_lanes numbers past the end of t are
  /// overwritten. Returns the stream's end.
  const Half* (*forward)(float* t, const Half* stream, int own, int rows);
  /// t[0..own) := L11^-T (t[0..own) - L21^T t[own..rows)), from the stream's end. The half_lanes numbers past the end
  /// of t must be zero. Returns the stream's begin.
  const Half* (*backward)(float* t, const Half* stream_end, int own, int rows);
};

const Fp16Kernels& fp16_kernels();

}  // namespace insula
