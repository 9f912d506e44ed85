// SPDX-License-Identifier: GPL-3.0-or-later
// What a device knows of one front. This file is read by C++ and by the compiler of OpenCL C, so that both agree on it.
// Offsets and lengths count scalars, not nodes.
#ifdef __OPENCL_VERSION__
typedef long record_long;
#else
#pragma once
#include <cstdint>
namespace insula::opencl {
using record_long = std::int64_t;
#endif

typedef struct {
  record_long panel;    ///< columns of L, column-major with leading dimension lda
  record_long update;   ///< what it subtracts from its ancestors, column-major with ldu, among those of its level
  record_long inverse;  ///< inverses of the diagonal blocks of L, one square of TILE x TILE after the other
  int first;            ///< first own column, permuted order
  int own, rows;        ///< own columns; all rows
  int lda, ldu;
  int map;                           ///< places of the rows below in the parent's rows, one number a node
  int index;                         ///< all rows in permuted order, one number a node
  int carried;                       ///< of the rows below, among the rows below of its level
  int children_begin, children_end;  ///< in the list of children
} FrontRecord;

/// What a row of constraints has at one node. A front's entries are one range.
typedef struct {
  double x, y, z;
  int column;  ///< of Y
  int scalar;  ///< first of the node's three, permuted order
} EntryRecord;

/// A front that rows reach: its columns of Y are [begin, end), its entries [entries_begin, entries_end).
typedef struct {
  int begin, end;
  int entries_begin, entries_end;
} ReachRecord;

#ifndef __OPENCL_VERSION__
}  // namespace insula::opencl
#endif
