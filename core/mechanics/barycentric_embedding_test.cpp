// SPDX-License-Identifier: GPL-3.0-or-later
// Weights that single precision holds. What BarycentricEmbedding places is held against Body::position() by the
// contract of every scene.
#include "core/mechanics/barycentric_embedding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace insula {
namespace {

TEST(BarycentricEmbedding, WeightsAreFloatsOfSumOne) {
  Random random(2);
  for (int k = 0; k < 10000; ++k) {
    std::array<double, 4> w;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      sum += w[i] = k % 3 == 0 ? random.uniform(0, 1.0 / 3) : random.uniform(-0.3, 0.9);
    w[3] = 1 - sum;
    const auto out = embedding_weights(w);
    float single = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(double(float(out[i])), out[i]);
      EXPECT_NEAR(out[i], w[i], 4.0 / (1 << 22));
      single += float(out[i]);
    }
    EXPECT_EQ(single, 1.0f);
    EXPECT_EQ(out[0] + out[1] + out[2] + out[3], 1.0);
  }
  EXPECT_EQ(embedding_weights({1, 0, 0, 0}), (std::array<double, 4>{1, 0, 0, 0}));
}

}  // namespace
}  // namespace insula
