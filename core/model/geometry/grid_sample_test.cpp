// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/model/geometry/grid_sample.h"

#include <gtest/gtest.h>

#include <limits>

namespace insula {
namespace {

TEST(GridSample, IsExactForATrilinearFunctionAndSaysWhatLiesOutside) {
  constexpr int n[3] = {3, 4, 5};
  const auto f = [](const Vec3& p) {
    return 1 + 2 * p.x() - 3 * p.y() + 0.5 * p.z() + 4 * p.x() * p.y() - p.y() * p.z() + 0.25 * p.x() * p.y() * p.z();
  };
  std::vector<float> values;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) values.push_back(float(f(Vec3(i, j, k))));
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1.25, 2.5, 3.75), Vec3(0.1, 2.9, 0.6), Vec3(1.999, 2.999, 3.999)})
    EXPECT_NEAR(grid_sample(values, n, p, 99), f(p), 1e-12) << p.transpose();
  for (int a = 0; a < 3; ++a)
    for (const double off : {-1e-9, n[a] - 1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      Vec3 p(0.5, 0.5, 0.5);
      p[a] = off;
      EXPECT_EQ(grid_sample(values, n, p, 99), 99) << p.transpose();
    }
}

}  // namespace
}  // namespace insula
