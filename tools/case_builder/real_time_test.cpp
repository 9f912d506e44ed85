// SPDX-License-Identifier: GPL-3.0-or-later
// A wall is made coarser where the counted work of a step asks for it, and only there.
#include "tools/case_builder/real_time.h"

#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

/// A wall of 1,650 nodes, a lobe, and a clip, whose rows lie on the wall. `heavier`: times the usual factors.
SceneWork work_with(double heavier_wall, double heavier_lobe) {
  SceneWork w;
  w.h = 1.0 / 60;
  w.expected_rows = 260, w.max_rows = 415;
  w.expected_sweeps = 21, w.newton = true;
  w.surface_vertices = 13000, w.surface_triangles = 8000, w.wall_vertices = 1650;
  const auto body = [&](const char* id, int nodes, int elements, bool wall, int rows, double flops, double entries,
                        double of_rows) {
    w.bodies.push_back(
        {id, nodes, elements, wall, true, false, w.h, rows, {std::int64_t(entries), flops, 0, 0}, of_rows});
  };
  body("artery", 1650, 3300, true, 200, 1.06e8 * heavier_wall, 7e5 * heavier_wall, 2e8 * heavier_wall);
  body("lobe", 500, 2000, false, 60, 1.3e7 * heavier_lobe, 2e5 * heavier_lobe, 3e7 * heavier_lobe);
  return w;
}

TEST(RealTime, AUsualWallStaysAsItIs) { EXPECT_FALSE(coarser_wall(work_with(1, 1), 1650, usual_pace())); }

TEST(RealTime, AWallThatTakesTooLongGetsTheMostVerticesThatDoNot) {
  const SceneWork work = work_with(2, 1);
  ASSERT_FALSE(keeps_pace(work, usual_pace()));
  const std::optional<int> fewer = coarser_wall(work, 1650, usual_pace());
  ASSERT_TRUE(fewer);
  EXPECT_GE(*fewer, 900);
  EXPECT_LT(*fewer, 1650);
  EXPECT_TRUE(keeps_pace(with_coarser_walls(work, *fewer / 1650.0), usual_pace()));
  EXPECT_FALSE(keeps_pace(with_coarser_walls(work, (*fewer + 50) / 1650.0), usual_pace()));
}

TEST(RealTime, AWallThatIsNotAtFaultStaysAsItIs) {
  ASSERT_FALSE(keeps_pace(work_with(1, 60), usual_pace()));
  EXPECT_FALSE(coarser_wall(work_with(1, 60), 1650, usual_pace()));
}

/// A case up to its place.
class PlacedCase : public testing::Test {
 protected:
  PlacedCase() {
    folder_.write("vessel.stl", test::stl_text(test::tube_with_sac()));
    options_.keep_spin = true;  // a quick search
    run_intake(made_, folder_.path() / "vessel.stl", options_, quiet_);
    run_wall(made_, options_, quiet_);
    run_place(made_, project_, options_, quiet_);
  }
  int vertices() const { return int(read_wall(made_.artery()).wall.mesh.vertices.size()); }
  bool told() const { return read_json(made_.wall() / "notes.json").dump().find("made coarser") != std::string::npos; }

  insula::test::SceneFolder folder_;
  CaseFolder made_{folder_.path() / "case", "case"};
  fs::path project_ = find_project(INSULA_SOURCE_DIR);
  Options options_;
  Progress quiet_;
};

TEST_F(PlacedCase, IsMadeCoarserForASlowerMachineUnlessItsVerticesAreTheAuthorsOwn) {
  const int usual = vertices();
  EXPECT_NEAR(usual, 1650, 150);
  EXPECT_FALSE(keep_real_time(made_, project_, options_, usual_pace(), quiet_));
  EXPECT_EQ(vertices(), usual);

  const SceneWork work = work_of_clipping(made_, project_, options_, quiet_);
  Pace slower = usual_pace();
  slower.of_step = 0.88 * estimate(work, slower.rates, slower.cores).step_ms / (1000 * work.h);
  options_.keep_vertices = true;
  EXPECT_FALSE(keep_real_time(made_, project_, options_, slower, quiet_));
  EXPECT_EQ(vertices(), usual);
  EXPECT_FALSE(told());

  options_.keep_vertices = false;
  EXPECT_TRUE(keep_real_time(made_, project_, options_, slower, quiet_));
  ASSERT_TRUE(options_.coarser);
  EXPECT_NEAR(vertices(), *options_.coarser, 0.1 * *options_.coarser);
  EXPECT_LT(vertices(), 0.95 * usual);
  EXPECT_TRUE(told());
  EXPECT_TRUE(keeps_pace(work_of_clipping(made_, project_, options_, quiet_), slower));
  // The stage wall again gives the same wall.
  const Options read = options_from_json(to_json(options_));
  EXPECT_EQ(read.wall_vertices(), *options_.coarser);
}

TEST(RealTime, VerticesOfAnOlderCaseAreTheAuthorsOwnIfTheyAreNotTheUsualOnes) {
  EXPECT_FALSE(options_from_json({{"vertices", 1650}}).keep_vertices);
  EXPECT_TRUE(options_from_json({{"vertices", 1200}}).keep_vertices);
  const Options own = options_from_json({{"vertices", 1650}, {"keep_vertices", true}, {"coarser_vertices", 1000}});
  EXPECT_EQ(own.wall_vertices(), 1650);
}

}  // namespace
}  // namespace insula::case_builder
