// SPDX-License-Identifier: GPL-3.0-or-later
// The innermost test of the search between surfaces, compiled once per instruction set and chosen at run time. It only
// excludes candidates, so the result does not depend on the set.
#pragma once
#include <array>
#include <cstdint>

namespace insula {

/// Boxes beside each other, scene frame, m.
struct BoxPack {
  static constexpr int size = 16;
  using Row = std::array<float, std::size_t(size)>;
  alignas(64) std::array<Row, 3> low, high;
};

struct SearchKernels {
  /// Bit k: point x, known to within `margin` (m) a coordinate, may be no farther than the square root of limit2 (m2)
  /// from box k.
  std::uint32_t (*boxes_near)(const BoxPack& pack, const std::array<float, 3>& x, float margin, float limit2);
};

const SearchKernels& search_kernels();

}  // namespace insula
