// SPDX-License-Identifier: GPL-3.0-or-later
// The symbolic half of the direct solver, once per pattern. CHOLMOD gives a fill-reducing ordering and supernodes. The
// fronts of the elimination tree follow from them, with the position of their numbers in memory and the target of each
// block of A. It contains no number of A.
#pragma once
#include <cstdint>
#include <vector>

#include "core/linalg/block_matrix.h"

namespace insula {

/// One supernode: a dense trapezoid of L (`panel`) and the update that its elimination subtracts from its ancestors
/// (`update`).
struct Front {
  int first = 0;      ///< first own node, permuted order
  int own = 0;        ///< own nodes (columns)
  int rows = 0;       ///< nodes in all (own + below)
  int row_begin = 0;  ///< into Elimination::row_node
  int lda = 0;        ///< of the panel, in scalars
  long panel = 0;     ///< offset among all panels, scalars
  long update = -1;   ///< offset in the arena of update matrices, of the below x below matrix
  int ldu = 0;
  int parent = -1;
  int map_begin = 0;  ///< into Elimination::map: below nodes as positions in the parent's rows
  int scatter_begin = 0, scatter_end = 0;
  std::vector<int> children;
};

struct Elimination {
  struct Scatter {
    int slot;     ///< block of A
    long offset;  ///< of the block's first entry in the panels
    bool transpose;
  };
  int nodes = 0;
  std::vector<Front> front;  ///< in postorder
  std::vector<int> row_node, map;
  std::vector<int> row_scalar;          ///< row_node with three scalars for each node
  std::vector<int> permuted, natural;   ///< natural node -> permuted node, and the inverse
  std::vector<int> front_of;            ///< permuted node -> front
  std::vector<Scatter> scatter;         ///< front by front
  long panel_size = 0, arena_size = 0;  ///< scalars
  std::int64_t entries = 0;             ///< of L, padding not counted
  double flops = 0;                     ///< of one factorisation

  /// Leading dimensions become multiples of `lanes` scalars, a power of two.
  void analyse(const BlockMatrix& a, int lanes);

  /// Reorder 3 * nodes values: natural order to permuted order, and back.
  template <class Real>
  void permute(const double* natural_order, Real* permuted_order) const {
    for (int p = 0; p < nodes; ++p)
      for (int k = 0; k < 3; ++k) permuted_order[3 * p + k] = Real(natural_order[3 * natural[std::size_t(p)] + k]);
  }
  template <class Real>
  void restore(const Real* permuted_order, double* natural_order) const {
    for (int p = 0; p < nodes; ++p)
      for (int k = 0; k < 3; ++k) natural_order[3 * natural[std::size_t(p)] + k] = double(permuted_order[3 * p + k]);
  }
};

}  // namespace insula
