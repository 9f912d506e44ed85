// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels made from real surfaces, simulated: they bear the pressure of their image in its shape, and they pulse.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/mechanics/shell_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "import_parts.h"
#include "plugins/pressure/pressure.h"

namespace insula::artery {
namespace {

class RealVessel : public testing::TestWithParam<const char*> {
 protected:
  test::SceneFolder folder;
  Vessel vessel;
  double size = 0;  ///< across, m

  void SetUp() override {
    const auto file = std::filesystem::path(INSULA_SOURCE_DIR) / "../shared/anatomy" / GetParam();
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no anatomy here";
    vessel = import_surface(read_surface(file, 1.0), {});
    write_vessel(vessel, folder.path() / "meshes");
    Vec3 low = Vec3::Constant(1e9), high = -low;
    const WallModel read = read_wall(folder.path() / "meshes" / "vessel.json");
    for (const Vec3& x : read.wall.vertices) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    size = (high - low).norm();
  }
  std::unique_ptr<Simulation> scene(double systolic, double diastolic) const {
    std::string walls, tethered;
    for (const std::string& region : vessel.regions) {
      const bool sac = region == "sac" || region == "bleb";
      walls += fmt::format(R"(<membrane regions="{}" thickness="{} mm" young="1.2 MPa" added_mass="1 kg/m2"/>)", region,
                           sac ? 0.2 : 0.3);
      if (!sac && region != "neck") tethered += (tethered.empty() ? "" : " ") + region;
    }
    return test::load_text(
        fmt::format(R"(<scene time_step="16.6667 ms"><shell_body id="artery" wall="meshes/vessel.json">{}
<anchor_springs regions="{}" stiffness="1 kPa/mm"/></shell_body>
<pressure id="heart" on="artery" systolic="{} mmHg" diastolic="{} mmHg"/></scene>)",
                    walls, tethered, systolic, diastolic),
        folder.path() / "scene.xml");
  }
  static double moved(Simulation& s) {
    const auto* shell = s.scene().find_as<ShellBody>("artery");
    double most = 0;
    for (int i = 0; i < shell->nodes(); ++i)
      most = std::max(most, (shell->q().segment<3>(3 * i) - shell->rest_nodes()[std::size_t(i)]).norm());
    return most;
  }
};

TEST_P(RealVessel, HoldsTheImagedShapeAtMeanPressure) {
  auto s = scene(93, 93);
  ASSERT_TRUE(s);
  EXPECT_GT(size, 5e-3);
  for (int i = 0; i < 60; ++i) {
    s->step();
    ASSERT_TRUE(s->report().finite) << i;
  }
  EXPECT_LT(moved(*s), 1e-3 * size);
  EXPECT_NEAR(s->scene().find_as<BloodPressure>("heart")->pressure(0), 93 * 133.322387415, 1.0);
  RecordProperty("moved_nm", int(1e9 * moved(*s)));
}

TEST_P(RealVessel, Pulses) {
  auto s = scene(120, 80);
  ASSERT_TRUE(s);
  const auto* heart = s->scene().find_as<BloodPressure>("heart");
  const int sac = heart->chambers().find("sac");
  ASSERT_GE(sac, 0);
  double least = 1e300, most = 0;
  for (int i = 0; i < 60; ++i) {  // a beat is 51 steps
    s->step();
    ASSERT_TRUE(s->report().finite) << i;
    least = std::min(least, heart->volume(sac));
    most = std::max(most, heart->volume(sac));
  }
  const double change = (most - least) / heart->rest_volume(sac);
  EXPECT_GT(change, 0.01);
  EXPECT_LT(change, 0.2);
  EXPECT_LT(least, heart->rest_volume(sac)) << "below the mean pressure it is smaller than in its image";
  EXPECT_GT(most, heart->rest_volume(sac));
  EXPECT_LT(moved(*s), 0.1 * size);
  RecordProperty("sac_permille", int(1e3 * change));
}

INSTANTIATE_TEST_SUITE_P(Anatomy, RealVessel, testing::Values("dolfin_aneurysm_closed.stl", "aneumo_aneux4_closed.stl"),
                         [](const auto& p) { return std::string(p.param).substr(0, std::string(p.param).find('_')); });

}  // namespace
}  // namespace insula::artery
