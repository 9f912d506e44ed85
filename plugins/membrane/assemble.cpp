// SPDX-License-Identifier: GPL-3.0-or-later
// B^T B of a patch.
#include "plugins/membrane/assemble.h"

#include <cstddef>
#include <cstring>

// Dispatch by the dynamic linker. It does not work under sanitizers, which are not set up yet when it runs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define INSULA_ANY_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define INSULA_ANY_VECTORS
#endif

namespace insula {

INSULA_ANY_VECTORS
void add_patch(PatchRows& rows, int nodes, const int* slot, double* values) {
  using Four = double __attribute__((vector_size(32), may_alias));
  using FourAnywhere = double __attribute__((vector_size(32), aligned(8), may_alias));
  for (int i = 0; i < nodes; ++i)
    for (int m = 0; m < 3; ++m) {
      const double b0 = rows.row[i][m][0], b1 = rows.row[i][m][1], b2 = rows.row[i][m][2];
      const double t[8] = {b0, b1, b2, b0, b1, b2, b0, b1}, s[8] = {b0, b0, b0, b1, b1, b1, b2, b2};
      std::memcpy(rows.tiled[i][m], t, sizeof t);
      std::memcpy(rows.spread[i][m], s, sizeof s);
    }
  for (int i = 0; i < nodes; ++i) {
    const Four* t = reinterpret_cast<const Four*>(rows.tiled[i][0]);
    const Four t00 = t[0], t01 = t[1], t10 = t[2], t11 = t[3], t20 = t[4], t21 = t[5];
    const double l0 = rows.row[i][0][2], l1 = rows.row[i][1][2], l2 = rows.row[i][2][2];
    for (int j = 0; j <= i; ++j, ++slot) {
      if (*slot < 0) continue;
      const Four* s = reinterpret_cast<const Four*>(rows.spread[j][0]);
      double* out = values + 9 * std::size_t(*slot);
      auto* a = reinterpret_cast<FourAnywhere*>(out);
      auto* b = reinterpret_cast<FourAnywhere*>(out + 4);
      *a += t00 * s[0] + t10 * s[2] + t20 * s[4];
      *b += t01 * s[1] + t11 * s[3] + t21 * s[5];
      out[8] += l0 * rows.row[j][0][2] + l1 * rows.row[j][1][2] + l2 * rows.row[j][2][2];
    }
  }
}

}  // namespace insula
