// SPDX-License-Identifier: GPL-3.0-or-later
// Batches of hinges and triangles, of every instruction set, against the formulas for a single one.
#include "plugins/membrane/wall_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/linalg/instruction_set.h"
#include "plugins/membrane/hinge.h"
#include "plugins/membrane/stretch_formula.h"

namespace insula {
INSULA_TABLES(WallKernels, wall_table)
namespace {

template <class Check>
void on_every_set(Check&& check) {
  for (const auto set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512})
    if (processor_has(set)) {
      SCOPED_TRACE("instruction set " + std::to_string(int(set)));
      check(*every_wall_table().table[std::size_t(set)]);
    }
}

TEST(WallBatch, HingesAreThoseOfASingleOne) {
  on_every_set([](const WallKernels& kernels) {
    Random random(9);
    for (int count = 1; count <= wall_lanes; ++count) {
      std::vector<double> x(3 * 4 * wall_lanes);
      for (double& c : x) c = 0.02 + random.uniform(-1e-3, 1e-3);
      HingeBatch batch{};
      batch.count = count;
      WallHinge hinge[wall_lanes];
      std::vector<double> angle(wall_lanes), before, gradient(16 * wall_lanes, 7.0);
      for (int l = 0; l < wall_lanes; ++l) {
        for (int k = 0; k < 4; ++k) batch.node[k][l] = hinge[l].node[k] = 4 * l + k;
        for (int s = 0; s < 2; ++s)
          batch.least[s][l] = hinge[l].least[s] = l % 3 == 0 ? 1e-10 : 1e-14;  // collapsed, and not
        angle[std::size_t(l)] = random.uniform(-20, 20);
      }
      before = angle;
      kernels.hinges(batch, x.data(), angle.data(), gradient.data());
      for (int l = 0; l < wall_lanes; ++l) {
        if (l >= count) {
          EXPECT_EQ(angle[std::size_t(l)], before[std::size_t(l)]) << "past the end";
          EXPECT_EQ(gradient[std::size_t(16 * l)], 7) << "past the end";
          continue;
        }
        double g[12];
        const double one = hinge_angle(x.data(), hinge[l], g),
                     turns = (angle[std::size_t(l)] - one) / (2 * std::numbers::pi);
        EXPECT_NEAR(turns, std::nearbyint(turns), 1e-12);
        EXPECT_LE(std::abs(angle[std::size_t(l)] - before[std::size_t(l)]), std::numbers::pi * (1 + 1e-12));
        double size = 0;
        for (double v : g) size = std::max(size, std::abs(v));
        for (int k = 0; k < 12; ++k)
          EXPECT_NEAR(gradient[std::size_t(16 * l + 4 * (k / 3) + k % 3)], g[k], 1e-11 * size);
      }
    }
  });
}

TEST(WallBatch, TrianglesAreThoseOfASingleOne) {
  on_every_set([](const WallKernels& kernels) {
    Random random(10);
    for (int count = 1; count <= wall_lanes; ++count) {
      std::vector<double> x(3 * 3 * wall_lanes), force(x.size(), 0.0), expected = force;
      for (double& c : x) c = 0.02 + random.uniform(-1e-3, 1e-3);
      TriangleBatch batch{};
      batch.count = count;
      for (int l = 0; l < wall_lanes; ++l) {
        double b[3][2], pre[3], u[3], v[3];
        for (int c = 0; c < 2; ++c) {
          for (int k = 1; k < 3; ++k) b[k][c] = random.uniform(-1500, 1500);
          b[0][c] = -b[1][c] - b[2][c];
        }
        for (int k = 0; k < 3; ++k) {
          batch.node[k][l] = 3 * l + k;
          pre[k] = batch.pre[k][l] = random.uniform(-0.1, 0.1);
          for (int c = 0; c < 2; ++c) batch.b[k][c][l] = b[k][c];
        }
        const double mu = batch.mu[l] = random.uniform(1e-4, 1e-3),
                     lambda = batch.lambda[l] = random.uniform(1e-4, 1e-3);
        if (l >= count) continue;
        const double* at = x.data() + 9 * l;
        for (int c = 0; c < 3; ++c) u[c] = at[3 + c] - at[c], v[c] = at[6 + c] - at[c];
        const auto stress = stress_of(stretch_of(u, v, b), mu, lambda, pre);
        for (int k = 0; k < 3; ++k)
          for (int c = 0; c < 3; ++c)
            expected[std::size_t(9 * l + 3 * k + c)] = -(stress.p0[c] * b[k][0] + stress.p1[c] * b[k][1]);
      }
      kernels.stretch(batch, x.data(), force.data());
      for (std::size_t i = 0; i < force.size(); ++i)
        EXPECT_NEAR(force[i], expected[i], 1e-12 * (1 + std::abs(expected[i]))) << i << " of " << count;
    }
  });
}

}  // namespace
}  // namespace insula
