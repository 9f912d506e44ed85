// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set: KERNEL_NAME, KERNEL_BYTES (of a vector).
#include "core/collision/search/search_kernels.h"
#include "core/linalg/lane_bits.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_BYTES / 4;  // floats a vector
typedef float V __attribute__((vector_size(KERNEL_BYTES)));

inline V most(V a, V b) { return a > b ? a : b; }

std::uint32_t boxes_near(const BoxPack& pack, const std::array<float, 3>& x, float margin, float limit2) {
  std::uint32_t out = 0;
  for (int first = 0; first < BoxPack::size; first += W) {
    V d2{};
    for (std::size_t k = 0; k < 3; ++k) {
      const V low = *reinterpret_cast<const V*>(pack.low[k].data() + first),
              high = *reinterpret_cast<const V*>(pack.high[k].data() + first);
      const V beyond = most(most(low - x[k], x[k] - high) - margin, V{});
      d2 += beyond * beyond;
    }
    out |= lane_bits(d2 * 0.999999f <= V{} + limit2) << first;
  }
  return out;
}

}  // namespace

extern const SearchKernels search_table;
const SearchKernels search_table = {boxes_near};

}  // namespace insula::KERNEL_NAME
