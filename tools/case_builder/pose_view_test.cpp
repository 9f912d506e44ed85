// SPDX-License-Identifier: GPL-3.0-or-later
// A vessel is moved in the fissure: the same numbers as the stage that places it, the line of sight, and the command.
#include "tools/case_builder/pose_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "core/base/input_error.h"
#include "core/testing/block_mesh.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

TEST(Pose, IsAShiftAndARotationVector) {
  const Placement p = placement_of({1, 2, 3, 0, 0, 90});
  EXPECT_LT((p.apply(Vec3(1, 0, 0)) - Vec3(1, 3, 3)).norm(), 1e-12);
  const RigidMotion m{4, -5, 6, 20, -30, 40}, again = motion_of(placement_of(m));
  for (std::size_t k = 0; k < m.size(); ++k) EXPECT_NEAR(again[k], m[k], 1e-9) << k;
  EXPECT_EQ(motion_of(Placement()), (RigidMotion{}));
}

TriMesh square(double half, double z) {
  return {{Vec3(-half, -half, z), Vec3(half, -half, z), Vec3(half, half, z), Vec3(-half, half, z)},
          {{0, 1, 2}, {0, 2, 3}}};
}

TEST(Sight, ALineMeetsASurfaceWhereItCrossesIt) {
  EXPECT_NEAR(first_meeting(square(1, 3), Vec3(0.2, 0.1, 1), Vec3(0.2, 0.1, 9)), 0.25, 1e-15);
  EXPECT_NEAR(first_meeting(square(1, 3), Vec3(0, 0, 9), Vec3(0, 0.5, 1)), 0.75, 1e-15);
  EXPECT_EQ(first_meeting(square(1, 3), Vec3(0, 0, 1), Vec3(0, 0, 2.9)), 2) << "it ends before";
  EXPECT_EQ(first_meeting(square(1, 3), Vec3(1.5, 0, 1), Vec3(1.5, 0, 9)), 2) << "it passes beside";
}

/// The tube with its neck at the origin of a view along z, and a sheet over half of it.
TEST(Sight, ASheetOverHalfOfTheNeckHidesHalf) {
  Progress quiet;
  std::vector<Note> notes;
  Options o;
  o.vertices = 900, o.neck = Plane{0, 0, 2, 0, 0, 1};
  const artery::Vessel v = make_wall(mended(test::tube_with_sac(), "tube", o, {}).surface, o, notes, quiet);
  Fissure f;
  f.approach.floor = "insula";
  f.approach.clipping.view.eye = "0 -300 2 mm";
  Sight sight = sight_of_neck(v, f);
  EXPECT_NEAR(sight.seen, 1, 1e-12) << "from the side, nothing is before the neck";
  // A sheet before all places with x > 0, from the neck to far up and down.
  f.obstacles.push_back(
      {"window",
       {{Vec3(0, -50, -50), Vec3(99, -50, -50), Vec3(99, -50, 50), Vec3(0, -50, 50)}, {{0, 1, 2}, {0, 2, 3}}}});
  sight = sight_of_neck(v, f);
  ASSERT_EQ(sight.hidden.size(), 1u);
  EXPECT_EQ(sight.hidden[0].first, "window");
  EXPECT_NEAR(sight.hidden[0].second, 0.5, 0.1);
  EXPECT_NEAR(sight.seen + sight.hidden[0].second, 1, 1e-12);
  // From above, its own dome is before the neck.
  f.obstacles.clear();
  f.approach.clipping.view.eye = "0 -30 300 mm";
  sight = sight_of_neck(v, f);
  ASSERT_FALSE(sight.hidden.empty());
  EXPECT_EQ(sight.hidden[0].first, "vessel");
  EXPECT_GT(sight.hidden[0].second, 0.5);
}

/// A case up to its place.
class PlacedTube : public testing::Test {
 protected:
  PlacedTube() {
    std::vector<Note> notes;
    Options o;
    o.vertices = 900;
    artery::write_vessel(make_wall(mended(test::tube_with_sac(), "tube", o, {}).surface, o, notes, quiet_),
                         made_.wall());
  }
  Json place(const Options& o) {
    run_place(made_, project_, o, quiet_);
    return read_json(made_.path / "place.json");
  }
  insula::test::SceneFolder folder_;
  CaseFolder made_{folder_.path() / "case", "case"};
  fs::path project_ = find_project(INSULA_SOURCE_DIR);
  Progress quiet_;
};

TEST_F(PlacedTube, IsMovedWhereThePoseSaysWithTheNumbersOfTheView) {
  Options o;
  const Json found = place(o);
  const PoseView view(made_, project_, o);
  const Placement built = placement_from(found);
  const auto expect_as_placed = [&](const std::vector<Room>& rooms, const Json& json, double tolerance) {
    ASSERT_EQ(rooms.size(), json.at("rooms").size());
    for (std::size_t k = 0; k < rooms.size(); ++k) {
      EXPECT_EQ(rooms[k].what, json.at("rooms").at(k).at("what"));
      EXPECT_NEAR(rooms[k].before, json.at("rooms").at(k).at("before_mm").get<double>(), tolerance) << rooms[k].what;
    }
  };
  expect_as_placed(view.rooms(built), found, 2e-3);

  // The same turn, the neck deeper by a millimetre: the option does just that.
  Placement moved = built;
  moved.shift -= read_approach(project_, o.approach).to_surgeon;
  o.pose = motion_of(moved);
  const std::vector<Room> there = view.rooms(moved);
  const Json parted = view.look_parted(moved, folder_.path()), again = place(o);
  const Placement taken = placement_from(again);
  EXPECT_LT((taken.shift - moved.shift).norm(), 1e-3);
  EXPECT_LT((taken.rotation - moved.rotation).norm(), 1e-3);
  expect_as_placed(there, again, 1e-4);
  EXPECT_EQ(parted.at("parted"), true);
  for (const Json& r : again.at("rooms"))
    EXPECT_NEAR(parted.at("overlap_mm").at(r.at("what").get<std::string>()).get<double>(),
                std::max(0.0, -r.at("after_mm").get<double>()), 1e-4);
  // The surfaces of a picture, and the line of sight, are those of the parted lobes.
  EXPECT_EQ(parted.at("surfaces"), (Json{"frontal", "temporal", "insula"}));
  Fissure there_parted = read_fissure(project_, made_.lobes(), read_approach(project_, o.approach));
  const Sight sight = sight_of_neck(read_wall(made_.artery()), there_parted);
  EXPECT_NEAR(parted.at("seen_pct").get<double>(), 100 * sight.seen, 3);
  for (const Lobe& lobe : there_parted.lobes) {
    const TriMesh shown = read_ply(folder_.path() / ("parted_" + lobe.name + ".ply"));
    ASSERT_EQ(shown.vertices.size(), lobe.surface.vertices.size());
    for (std::size_t k = 0; k < shown.vertices.size(); ++k)
      EXPECT_LT((shown.vertices[k] - lobe.surface.vertices[k]).norm(), 1e-3) << lobe.name;
  }
  const artery::Vessel v = read_wall(made_.artery());
  EXPECT_LT((v.neck->centre - moved.apply(read_wall(made_.wall()).neck->centre)).norm(), 0.02);
}

TEST_F(PlacedTube, QuestionsAreAnsweredLineByLine) {
  const Json found = place({});
  const PoseView view(made_, project_, {});
  std::istringstream in("0 0 0 mm 0 0 0 deg\nnonsense\n1 2 3 mm 0 0 90\n");
  std::FILE* out = std::tmpfile();
  answer_poses(view, folder_.path() / "surfaces", in, out);
  std::rewind(out);
  std::vector<Json> answers;
  for (char line[8192]; std::fgets(line, sizeof line, out);) answers.push_back(Json::parse(line));
  std::fclose(out);
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0].at("surfaces"), (Json{"vessel", "frontal", "temporal", "insula", "retractors"}));
  for (const Json& name : answers[0].at("surfaces"))
    EXPECT_FALSE(read_ply(folder_.path() / "surfaces" / (name.get<std::string>() + ".ply")).triangles.empty()) << name;
  EXPECT_EQ(answers[0].at("pose").size(), 6u);
  EXPECT_EQ(answers[1].at("pose"), (Json{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(answers[1].at("rooms").size(), 3u);
  double shares = answers[1].at("seen_pct");
  for (const auto& [what, pct] : answers[1].at("hidden_pct").items()) shares += pct.get<double>();
  EXPECT_NEAR(shares, 100, 0.1);
  EXPECT_NE(answers[2].at("error").get<std::string>().find("X Y Z mm RX RY RZ deg"), std::string::npos);
  EXPECT_NE(answers[3].at("error").get<std::string>().find("1 2 3 mm 0 0 90"), std::string::npos);
}

}  // namespace
}  // namespace insula::case_builder
