// SPDX-License-Identifier: GPL-3.0-or-later
// What the builder mends by itself: thin branches, false ends, triangles that are too long.
#include <gtest/gtest.h>

#include "tools/artery/generated_artery_for_test.h"
#include "tools/case_builder/progress.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/thin_branch.h"
#include "tools/case_builder/tidy.h"
#include "tools/case_builder/topology.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

using artery::Surface;

artery::test::Dome round_dome() {
  artery::test::Dome dome;
  dome.neck_diameter = 3, dome.radius = 2.6, dome.half_height = 2.8, dome.lift = 0.3;
  return dome;
}

TEST(ThinBranch, IsCutOffWhereItBegins) {
  const artery::test::GeneratedArtery without = artery::test::on_fork("fork", {}, round_dome(), 0, 0);
  artery::test::GeneratedArtery with = without;
  const double r = 0.4;
  const Vec3 from(0.4, -0.3, -5);
  with.limbs.push_back(
      {"twig", artery::smooth_curve({from, from + Vec3(0, -4, 0), from + Vec3(1, -8, -1)}, r, r, 0.4), false, true});
  Surface s = with.surface();
  const std::size_t twig = s.caps.size() - 1;
  ASSERT_EQ(s.caps[twig].name, "twig_last");
  ASSERT_TRUE(remove_branch(s, twig));
  EXPECT_EQ(s.caps.size(), twig);
  for (const artery::CapPlane& cap : s.caps) EXPECT_NE(cap.name, "twig_last");
  const artery::Quality q = artery::quality(s.mesh);
  EXPECT_TRUE(q.closed);
  EXPECT_EQ(q.euler, 2);
  EXPECT_EQ(q.components, 1);
  const double fork = signed_volume(without.surface().mesh);
  EXPECT_NEAR(signed_volume(s.mesh), fork, 0.01 * fork);
}

TEST(ThinBranch, AWideOneIsNotTakenWithOthers) {
  Surface s = artery::test::on_fork("fork", {}, round_dome(), 0, 0).surface();
  const std::size_t caps = s.caps.size();
  remove_branch(s, 1);
  EXPECT_GE(s.caps.size(), caps - 1) << "of one branch alone";
  EXPECT_TRUE(artery::quality(s.mesh).closed);
}

/// A place in the noise may look like a flat end. A cut there would take the sac, or half of the vessel.
TEST(MadeAnew, AFalseEndTakesNothingWithIt) {
  const TriMesh m = test::tube_with_sac();
  Surface s{m, std::vector<int>(m.triangles.size(), -1), {}};
  s.caps.push_back({"end", Vec3(8, 0, 0), Vec3::UnitX(), 1.4});
  s.caps.push_back({"no_end", Vec3(4, 0, 1.4), Vec3::UnitZ(), 0.4});
  const double before = area(s.mesh);
  std::vector<Note> notes;
  make_anew(s, "For the test", "the surface", {}, notes);
  EXPECT_NEAR(area(s.mesh), before, 0.05 * before);
  ASSERT_EQ(s.caps.size(), 1u);
  EXPECT_EQ(s.caps[0].name, "end");
}

/// The first branch forks just where it would be cut, so that the caps of both of its branches would overlap.
TEST(Wall, IsCutBeforeAForkThatLiesWhereItWouldEnd) {
  artery::test::GeneratedArtery a = artery::test::on_fork("fork", {1.4, 1.0, 1.1, 60, 60, 20}, round_dome(), 0, 0);
  const artery::Curve& branch = a.limbs[1].curve;
  std::size_t at = 0;
  for (double gone = 0; gone < 14; ++at) gone += (branch.points[at + 1] - branch.points[at]).norm();
  const Vec3 from = branch.points[at], d = (branch.tangent(at) + 0.8 * Vec3::UnitY()).normalized();
  a.limbs.push_back({"again", artery::smooth_curve({from, from + 4 * d, from + 9 * d}, 0.8, 0.8, 0.4), false, true});
  const Surface s = a.surface();
  std::vector<Note> notes;
  Progress quiet;
  Options o;
  const artery::Vessel v = make_wall(s, o, notes, quiet);
  EXPECT_LT(v.wall.mesh.vertices.size(), 2.0 * o.vertices);
  for (const artery::CapPlane& c : v.wall.caps)
    for (const artery::CapPlane& d : v.wall.caps) {
      if (&c == &d) continue;
      EXPECT_GT((c.centre - d.centre).norm(), c.radius + d.radius) << c.name << " " << d.name;
    }
}

/// The first branch ends in a cap that is smaller than the wall's triangles.
TEST(Wall, IsCutBeforeItWouldRunThroughItself) {
  artery::test::GeneratedArtery a = artery::test::on_fork("fork", {1.4, 1.0, 1.1, 60, 60, 20}, round_dome(), 0, 0);
  a.step = 0.2;
  const Vec3 d = artery::test::direction(60, 0);
  a.limbs[1].curve = artery::smooth_curve({Vec3::Zero(), 5 * d, 11.5 * d}, 1.0, 0.12, 0.25);
  std::vector<Note> notes;
  Progress quiet;
  const artery::Vessel v = make_wall(a.surface(), {}, notes, quiet);
  EXPECT_FALSE(artery::quality(v.wall.mesh).self_intersecting);
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const Note& n) {
    return n.text.find("farther out the wall would run through itself") != std::string::npos;
  }));
}

/// What its note says of a proposed neck.
std::string note_of_neck(const std::vector<Note>& notes) {
  for (const Note& n : notes)
    if (n.text.starts_with("Neck and sac are a proposal: ")) return n.text;
  return {};
}

/// Every plane that parts the dome of the second vessel leaves the branch's opening beyond it.
TEST(Wall, SaysWhichProposalTheNeckIs) {
  artery::test::GeneratedArtery a = artery::test::on_fork("fork", {}, round_dome(), 0, 0);
  Progress quiet;
  std::vector<Note> notes;
  artery::Vessel v = make_wall(a.surface(), {}, notes, quiet);
  EXPECT_EQ(v.proposals.front().method, "narrowest section");
  EXPECT_NE(note_of_neck(notes).find("narrowest section"), std::string::npos) << note_of_neck(notes);

  artery::test::Dome dome;
  dome.neck_diameter = 3.4, dome.radius = 3.2, dome.half_height = 3.2, dome.lift = 0.2;
  a = artery::test::on_fork("branch_of_the_dome", {}, dome, 0, 0);
  const Vec3 from = a.dome_centre() + Vec3(0, 1.4, 1.8);
  const std::vector<Vec3> way{from, from + Vec3(0, 3, 4), from + Vec3(1, 5, 8)};
  a.limbs.push_back({"of_the_dome", artery::smooth_curve(way, 0.5, 0.5, 0.4), false, true});
  notes.clear();
  v = make_wall(a.surface(), {}, notes, quiet);
  EXPECT_EQ(v.proposals.front().method, "shortest line");
  EXPECT_NE(note_of_neck(notes).find("shortest line"), std::string::npos) << note_of_neck(notes);
}

}  // namespace
}  // namespace insula::case_builder
