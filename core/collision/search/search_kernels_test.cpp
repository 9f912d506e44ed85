// SPDX-License-Identifier: GPL-3.0-or-later
// The look at packs of boxes, of every instruction set, against exact distances: none that is near is missed, and few
// others are taken for near.
#include "core/collision/search/search_kernels.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/collision/search/aabb_tree.h"
#include "core/collision/shapes/shapes_for_test.h"
#include "core/linalg/instruction_set.h"

namespace insula {
INSULA_TABLES(SearchKernels, search_table)
namespace {

TEST(SearchKernels, MissNoBoxThatIsNear) {
  for (const InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!processor_has(set)) continue;
    const SearchKernels& kernels = *every_search_table().table[std::size_t(set)];
    shapes::Random r(5);
    long near = 0, taken = 0;
    for (int round = 0; round < 2000; ++round) {
      const Vec3 about = r.in_box(0.1), x = about + r.in_box(0.005);
      BoxPack pack{};
      std::array<OuterBox, BoxPack::size> box;
      for (std::size_t i = 0; i < box.size(); ++i) {
        Aabb b;
        b.add(Vec3(about + r.in_box(0.005)));
        b.inflate(r.between(0, 0.001));
        box[i] = OuterBox::around(b);
        for (std::size_t k = 0; k < 3; ++k) pack.low[k][i] = box[i].low[k], pack.high[k][i] = box[i].high[k];
      }
      const double limit = r.between(0, 0.003), margin = x.cwiseAbs().maxCoeff() * 1.2e-7;
      const std::uint32_t found = kernels.boxes_near(pack, {float(x[0]), float(x[1]), float(x[2])}, float(margin),
                                                     float(limit * limit) * 1.000001f);
      for (std::size_t i = 0; i < box.size(); ++i) {
        const double d = std::sqrt(box[i].distance2(x));
        const bool said = (found >> i & 1) != 0;
        ASSERT_TRUE(said || d > limit) << d << " of " << limit;
        ASSERT_FALSE(said && d > limit + 4 * margin + 1e-5 * limit) << d << " of " << limit;
        near += d <= limit;
      }
      taken += std::popcount(found);
    }
    EXPECT_GT(near, 1000);
    EXPECT_LT(double(taken - near), 0.01 * double(near));
  }
}

}  // namespace
}  // namespace insula
