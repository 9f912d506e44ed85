// SPDX-License-Identifier: GPL-3.0-or-later
// A perforator's tension against its law, and what clips do to it.
#include "plugins/perforator/perforator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "core/testing/example.h"
#include "plugins/clip/clip.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/perforator/example.xml";

/// The example with one piece of its text replaced.
struct Field {
  std::unique_ptr<Simulation> s;
  Perforator* vessel = nullptr;
  Clip* clip = nullptr;
  explicit Field(const std::string& old = "", const std::string& now = "") {
    std::ifstream in(example);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!old.empty()) text.replace(text.find(old), old.size(), now);
    s = test::load_text(text, example);
    if (!s) return;
    vessel = s->scene().find_as<Perforator>("perforator");
    clip = s->scene().find_as<Clip>("clip");
  }
  int steps(int n, const std::string& kind = "") {
    int events = 0;
    for (int k = 0; k < n; ++k) {
      s->step();
      for (const Event& e : s->events()) events += e.kind == kind;
    }
    return events;
  }
  double length() const {
    const auto& line = vessel->course.data();
    const auto at = [&](std::size_t k) { return Vec3(line[4 * k], line[4 * k + 1], line[4 * k + 2]); };
    return (at(0) - at(Perforator::points - 1)).norm();
  }
};

TEST(Perforator, ATautOnePullsAsItsLawSays) {
  Field f(R"(slack="0.98")", R"(slack="0.8")");
  ASSERT_TRUE(f.s);
  const double rest = 0.8 * f.length();
  f.steps(200);
  const double stretch = f.length() - rest;
  ASSERT_GT(stretch, 1e-5);
  EXPECT_NEAR(f.vessel->tension(), 50 * stretch, 1e-6);  // the course is drawn with single precision
  EXPECT_NEAR(f.vessel->law().energy, 25 * stretch * stretch, 1e-9);
}

TEST(Perforator, ASlackOneDoesNotPull) {
  Field f(R"(slack="0.98")", R"(slack="1.3")");
  ASSERT_TRUE(f.s);
  f.steps(20);
  EXPECT_EQ(f.vessel->tension(), 0);
}

TEST(Perforator, BladesThatCloseOnItStopItsFlow) {
  Field f;
  ASSERT_TRUE(f.s);
  f.steps(1);
  EXPECT_EQ(f.vessel->flow_share(), 1) << "the blades are open";
  EXPECT_EQ(f.steps(60, "perforator_shut"), 1);
  EXPECT_EQ(f.vessel->flow_share(), 0);
}

TEST(Perforator, ItsFlowFollowsPoiseuilleInTheSlit) {
  Field f;
  ASSERT_TRUE(f.s);
  f.steps(1);
  int between = 0;
  for (int k = 0; k < 60; ++k) {
    f.steps(1);
    const double gap = f.clip->clip_state().gap, open = (gap - f.vessel->occluded_slit()) / f.vessel->diameter();
    EXPECT_NEAR(f.vessel->flow_share(), std::pow(std::clamp(open, 0.0, 1.0), 4), 1e-12) << gap;
    between += open > 0 && open < 1;
  }
  EXPECT_GT(between, 0) << "the blades pass the opening in which flow falls";
}

TEST(Perforator, BladesCarryItToTheirMiddle) {
  Field f(R"(start="0 0 0 mm" end="0 0 2 mm" bulge="0.3 0 0 mm")",
          R"(start="0 0 0 mm" end="0 0 2 mm" bulge="0 1 0 mm")");
  ASSERT_TRUE(f.s);
  f.steps(60);
  EXPECT_LT(f.vessel->flow_share(), 0.1);
  const auto& line = f.vessel->course.data();
  EXPECT_LT(std::abs(line[4 * (Perforator::points / 2) + 1]), 0.5e-3) << "its middle lay 1 mm to the side";
}

TEST(Perforator, BesideTheBladesItStaysOpen) {
  Field beyond_tip(R"(home="-2.5 0 1 mm")", R"(home="1 0 1 mm")");
  ASSERT_TRUE(beyond_tip.s);
  EXPECT_EQ(beyond_tip.steps(60, "perforator_shut"), 0);
  EXPECT_EQ(beyond_tip.vessel->flow_share(), 1);
  // Outside the opening, which is 2.8 mm wide, when the blades begin to close.
  Field outside(R"(home="-2.5 0 1 mm")", R"(home="-2.5 2.5 1 mm")");
  ASSERT_TRUE(outside.s);
  EXPECT_EQ(outside.steps(60, "perforator_shut"), 0);
  EXPECT_EQ(outside.vessel->flow_share(), 1);
}

TEST(Perforator, FlowReturnsWhenTheClipOpens) {
  Field f;
  ASSERT_TRUE(f.s);
  f.steps(60);
  ASSERT_LT(f.vessel->flow_share(), 0.1);
  const Pose closed = f.clip->pose();
  f.clip->place(closed, 0.2);
  f.steps(1);
  EXPECT_EQ(f.vessel->flow_share(), 1);
}

TEST(Perforator, TearsBeyondItsStrength) {
  Field f(R"(slack="0.98")", R"(slack="0.8" strength="2 mN")");
  ASSERT_TRUE(f.s);
  EXPECT_EQ(f.steps(50, "perforator_torn"), 1);
  EXPECT_TRUE(f.vessel->torn());
  EXPECT_EQ(f.vessel->flow_share(), 0);
  EXPECT_EQ(f.vessel->tension(), 0);
  EXPECT_LT(f.vessel->course.data()[3], 0);
  f.s->reset();
  EXPECT_FALSE(f.vessel->torn());
}

}  // namespace
}  // namespace insula
