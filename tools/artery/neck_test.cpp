// SPDX-License-Identifier: GPL-3.0-or-later
// The proposed neck of surfaces whose neck is known: arteries made from dimensions, read as if they were a patient's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/model/wall_model.h"
#include "import_parts.h"

namespace insula::artery {
namespace {

struct Known {
  TriMesh surface;  ///< mm
  Neck neck;
  std::vector<Vec3> of_vessels;  ///< vertices of the walls of parent and branches
};

Known known(const std::string& name, const Mat3& rotation) {
  const WallModel m = read_wall(std::filesystem::path(INSULA_SOURCE_DIR) / "meshes/arteries" / name / "vessel.json");
  Known out{m.wall, {1000 * rotation * m.neck_centre, rotation * m.neck_normal, 1000 * m.neck_diameter}, {}};
  for (Vec3& p : out.surface.vertices) p = 1000 * rotation * p;
  for (std::size_t i = 0; i < m.vertex_region.size(); ++i)
    if (const std::string& r = m.regions[std::size_t(m.vertex_region[i])];
        r == "parent" || r == "superior" || r == "inferior")
      out.of_vessels.push_back(out.surface.vertices[i]);
  return out;
}

class ProposedNeck : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(ProposedNeck, IsTheNarrowestSectionBelowTheDomeWithoutABranch) {
  const auto [name, turns] = GetParam();
  const Mat3 rotation = Eigen::AngleAxisd(0.9 * turns, Vec3(0.3, 0.5, 0.8).normalized()).toRotationMatrix();
  const Known truth = known(name, rotation);
  const Vessel v = import_surface(truth.surface, {});
  ASSERT_TRUE(v.neck);
  const double angle = std::acos(std::min(1.0, v.neck->normal.dot(truth.neck.normal))) * 180 / std::numbers::pi;
  const Vec3 apart = v.neck->centre - truth.neck.centre;
  const double up = apart.dot(truth.neck.normal), aside = (apart - up * truth.neck.normal).norm();
  EXPECT_LT(angle, 10);
  EXPECT_LT(aside, 0.4);
  // The table gives the width at a plane 0.35 mm above the parent's wall. The narrowest section lies a little deeper.
  EXPECT_GT(up, -1.1);
  EXPECT_LT(up, 0.3);
  EXPECT_LT(v.neck->diameter, truth.neck.diameter);
  double narrowest = 1e300;
  for (double h = -0.4; h < 1.5; h += 0.05) {
    const double d = section_diameter(v.wall.mesh, v.neck->centre + h * v.neck->normal, v.neck->normal, 1e300);
    if (d > 0) narrowest = std::min(narrowest, d);
  }
  EXPECT_NEAR(v.neck->diameter, narrowest, 0.04 * narrowest);

  int of_sac = 0, of_vessels = 0;
  for (std::size_t i = 0; i < v.region.size(); ++i) {
    if (v.regions[std::size_t(v.region[i])] != "sac") continue;
    ++of_sac;
    for (const Vec3& p : truth.of_vessels)
      if ((p - v.wall.mesh.vertices[i]).norm() < 0.3) {
        ++of_vessels;
        break;
      }
  }
  EXPECT_GT(of_sac, 100);
  EXPECT_LE(of_vessels, of_sac / 50);
}

INSTANTIATE_TEST_SUITE_P(Shipped, ProposedNeck,
                         testing::Combine(testing::Values("narrow_neck", "anterior_superior", "wide_neck"),
                                          testing::Range(0, 3)),
                         [](const auto& p) {
                           return fmt::format("{}_{}", std::get<0>(p.param), std::get<1>(p.param));
                         });

}  // namespace
}  // namespace insula::artery
