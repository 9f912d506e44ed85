// SPDX-License-Identifier: GPL-3.0-or-later
// The cloth lies on its surface, follows it, spans a groove, and is refused where there is no surface.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/mechanics/soft_body.h"
#include "core/mechanics/surface.h"
#include "core/testing/example.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/cotton_patty/example.xml";

std::string text_with(const std::string& old = "", const std::string& now = "") {
  std::ifstream in(example);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!old.empty()) text.replace(text.find(old), old.size(), now);
  return text;
}

/// Points of the cloth as they were published, m.
std::vector<Vec3> cloth(const Simulation& s) {
  std::vector<Vec3> out;
  for (const auto& entry : s.drawables())
    if (entry.drawable->spec().name == "cloth") {
      const auto& data = entry.drawable->data();
      for (std::size_t i = 0; i + 3 < data.size(); i += 4) out.emplace_back(data[i], data[i + 1], data[i + 2]);
    }
  return out;
}

TEST(CottonPatty, LiesOnAFlatSurfaceAndIsAsLargeAsItSays) {
  const auto s = test::load_text(text_with(), example);
  ASSERT_TRUE(s);
  s->step();
  const auto points = cloth(*s);
  ASSERT_EQ(points.size(), 153u);
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  EXPECT_NEAR(high.x() - low.x(), 0.016, 1e-6);
  EXPECT_NEAR(high.y() - low.y(), 0.010, 1e-6);
  EXPECT_NEAR(low.z(), 0.1 * 0.0005, 1e-6) << "the rim lies on the tissue";
  EXPECT_NEAR(high.z(), 0.0005, 1e-6) << "the cloth is as thick as it says";
}

TEST(CottonPatty, FollowsTheTissueBelowIt) {
  const auto s = test::load_text(text_with(), example);
  ASSERT_TRUE(s);
  s->step();
  const auto before = cloth(*s);
  auto* block = s->scene().find_as<SoftBody>("block");
  ASSERT_TRUE(block);
  const Vec3 shift(0.001, -0.002, 0.003);
  for (int i = 0; i < block->nodes(); ++i) block->q().segment<3>(3 * i) += shift;
  block->v().setZero();
  for (Constraint* c : s->constraints()) c->publish();
  const auto after = cloth(*s);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LT((after[i] - before[i] - shift).norm(), 2e-8) << i;
}

TEST(CottonPatty, IsRefusedBesideTheSurface) {
  const auto why = [](const std::string& old, const std::string& now) {
    return load_simulation_text(text_with(old, now), example, test::builtin(), 1).diagnostics.format();
  };
  EXPECT_NE(why("centre=\"0 0 0 mm\"", "centre=\"0 0 40 mm\"").find("not within reach"), std::string::npos);
  EXPECT_NE(why("along=\"1 0 0\"", "along=\"0 0 2\"").find("parallel"), std::string::npos);
}

}  // namespace
}  // namespace insula
