// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured at once in single precision is what the exact distance is, from fat triangles to slivers and points.
#include "core/collision/shapes/four_triangles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/collision/shapes/closest.h"
#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

struct Corners {
  std::array<std::array<Vec3, 3>, 4> corner;  // of each lane
  FourTriangles packed() const {
    FourTriangles t;
    for (std::size_t lane = 0; lane < 4; ++lane)
      for (std::size_t k = 0; k < 3; ++k) {
        t.a[k][lane] = float(corner[lane][0][int(k)]);
        t.b[k][lane] = float(corner[lane][1][int(k)]);
        t.c[k][lane] = float(corner[lane][2][int(k)]);
      }
    return t;
  }
};

double exact2(const std::array<Vec3, 3>& t, const Vec3& p) { return point_triangle(p, t[0], t[1], t[2]).distance2; }

TEST(FourTriangles, MissNoneThatIsWithin) {
  shapes::Random r(5);
  int near = 0, spared = 0;
  for (int trial = 0; trial < 50000; ++trial) {
    Corners c;
    const Vec3 middle = r.between(0, 1e-2) * r.direction();
    for (auto& t : c.corner) {
      const double size = std::pow(10, -r.between(2.5, 4.5)), thin = std::pow(10, -r.between(0, 7)),
                   along = r.between(-0.5, 1.5);
      const Vec3 e = size * r.direction(), f = along * e + thin * size * r.direction();
      const Vec3 at = middle + r.between(0, 2e-3) * r.direction();
      t = {at, at + e, trial % 50 == 0 ? at : Vec3(at + f)};
    }
    const Vec3 p = middle + r.between(0, 2e-3) * r.direction();
    const Float4 found = c.packed().distance2(float(p[0]), float(p[1]), float(p[2]));
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double d2 = exact2(c.corner[lane], p), d = std::sqrt(d2);
      ASSERT_TRUE(FourTriangles::may_be_within(found[lane], d2)) << trial << ": " << d << " m";
      near += d < 1e-4;
      // What is clearly farther is spared the look.
      const double limit = 0.99 * d - 1e-6;
      if (limit > 0) spared += FourTriangles::may_be_within(found[lane], limit * limit) ? -1000 : 1;
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(spared, 190000) << "or it lets too much through";
}

TEST(FourTriangles, InsideOverTheEdgesAndAtTheCorners) {
  Corners c;
  c.corner.fill({Vec3(0, 0, 0), Vec3(2e-3, 0, 0), Vec3(0, 1e-3, 0)});
  for (const auto& [p, distance] : {std::pair{Vec3(0.5e-3, 0.3e-3, -0.7e-3), 0.7e-3},
                                    {Vec3(1e-3, -0.4e-3, 0.3e-3), 0.5e-3},
                                    {Vec3(2.3e-3, -0.4e-3, 0), 0.5e-3},
                                    {Vec3(-0.3e-3, 0.5e-3, 0.4e-3), 0.5e-3}}) {
    const Float4 d2 = c.packed().distance2(float(p[0]), float(p[1]), float(p[2]));
    for (std::size_t lane = 0; lane < 4; ++lane) EXPECT_NEAR(std::sqrt(double(d2[lane])), distance, 1e-9);
  }
}

}  // namespace
}  // namespace insula
