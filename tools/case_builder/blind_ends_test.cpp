// SPDX-License-Identifier: GPL-3.0-or-later
// Ends that are closed: of thirty generated arteries, rounded, and flat under noise. The sac stays whole.
#include "tools/case_builder/blind_ends.h"

#include <gtest/gtest.h>

#include <random>

#include "tools/artery/generated_artery_for_test.h"
#include "tools/artery/import_parts.h"
#include "tools/case_builder/openings.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

using artery::Surface;
using artery::test::GeneratedArtery;

struct TrueEnd {
  Vec3 at, outward;
  double radius;
};
std::vector<TrueEnd> true_ends(const GeneratedArtery& a) {
  std::vector<TrueEnd> out;
  for (const auto& l : a.limbs) {
    const std::size_t last = l.curve.size() - 1;
    if (l.capped_first) out.push_back({l.curve.points[0], -l.curve.tangent(0), l.curve.radius[0]});
    if (l.capped_last) out.push_back({l.curve.points[last], l.curve.tangent(last), l.curve.radius[last]});
  }
  return out;
}

/// The artery as its function ends it, by half balls, without a cap.
Surface with_round_ends(GeneratedArtery a) {
  for (auto& l : a.limbs) l.capped_first = l.capped_last = false;
  return a.surface();
}

/// Flat ends that are no longer known, and that noise hides.
Surface with_noisy_ends(const GeneratedArtery& a, double noise) {
  Surface s = a.surface();
  s.caps.clear();
  std::fill(s.patch.begin(), s.patch.end(), -1);
  std::mt19937 generator(7);
  std::normal_distribution<double> push(0, noise);
  for (Vec3& p : s.mesh.vertices)
    for (int k = 0; k < 3; ++k) p[k] += push(generator);
  return s;
}

/// The caps lie at the true ends, at most `shortest` radii farther in, and the sac is whole.
void expect_caps_at_the_ends(const GeneratedArtery& a, const Surface& s, double shortest) {
  const std::vector<TrueEnd> ends = true_ends(a);
  EXPECT_EQ(s.caps.size(), ends.size());
  for (const TrueEnd& e : ends) {
    double least = 1e300;
    const artery::CapPlane* cap = nullptr;
    for (const artery::CapPlane& c : s.caps)
      if (const double away = (c.centre - e.at).norm(); away < least) least = away, cap = &c;
    ASSERT_TRUE(cap);
    const double back = (e.at - cap->centre).dot(e.outward);
    EXPECT_GT(back, -0.6 * e.radius);
    EXPECT_LT(back, shortest * e.radius);
    EXPECT_LT((e.at - cap->centre - back * e.outward).norm(), 0.5 * e.radius);
    EXPECT_GT(cap->normal.dot(e.outward), std::cos(20 * std::numbers::pi / 180));
    EXPECT_NEAR(cap->radius, e.radius, 0.2 * e.radius);
  }
  EXPECT_TRUE(artery::quality(s.mesh).closed);
  // Nothing of the sac has gone.
  double farthest = 0;
  for (const Vec3& p : s.mesh.vertices)
    if (a.of_dome(p) < 0.5) farthest = std::max(farthest, (p - a.dome.root).dot(a.dome.axis));
  EXPECT_GT(farthest, (a.dome.lift + 2) * a.dome.half_height - 0.5);
}

void expect_the_ends(const GeneratedArtery& a, Surface s, double shortest) {
  std::vector<Note> notes;
  cut_blind_ends(s, {}, notes);
  EXPECT_EQ(notes.size(), s.caps.size());
  expect_caps_at_the_ends(a, s, shortest);
}

class BlindEnds : public testing::TestWithParam<GeneratedArtery> {};

TEST_P(BlindEnds, RoundOnesAreCutWhereTheVesselHasItsCalibre) {
  expect_the_ends(GetParam(), with_round_ends(GetParam()), 2);
}

INSTANTIATE_TEST_SUITE_P(Thirty, BlindEnds, testing::ValuesIn(artery::test::generated_arteries()),
                         [](const auto& p) { return p.param.name; });

class NoisyEnds : public testing::TestWithParam<GeneratedArtery> {};

TEST_P(NoisyEnds, FlatOnesUnderNoiseAreCut) { expect_the_ends(GetParam(), with_noisy_ends(GetParam(), 0.06), 3); }

/// One of each kind, and those that once were cut in the wrong place.
std::vector<GeneratedArtery> some_arteries() {
  std::vector<GeneratedArtery> out;
  for (const GeneratedArtery& a : artery::test::generated_arteries())
    for (const char* name :
         {"fork_plain", "fork_narrow", "side_tilted", "side_with_branch", "giant_fork", "blister", "kissing_branch"})
      if (a.name == name) out.push_back(a);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Some, NoisyEnds, testing::ValuesIn(some_arteries()),
                         [](const auto& p) { return p.param.name; });

/// Open ends whose border runs up and down by more than the vessel's radius, as where triangles were deleted by hand.
TriMesh with_torn_ends(const GeneratedArtery& a) {
  const std::vector<TrueEnd> ends = true_ends(a);
  return test::without(with_round_ends(a).mesh, [&](const Vec3& p) {
    return std::any_of(ends.begin(), ends.end(), [&](const TrueEnd& e) {
      const Vec3 u = e.outward.unitOrthogonal(), v = e.outward.cross(u), r = p - e.at;
      const double angle = std::atan2(r.dot(v), r.dot(u)), notch = e.radius * (0.8 * std::sin(2 * angle) - 0.8);
      return r.dot(e.outward) > notch && r.norm() < 3 * e.radius;
    });
  });
}

class TornEnds : public testing::TestWithParam<GeneratedArtery> {};

TEST_P(TornEnds, AreCutStraightBehindTheirNotches) {
  TriMesh m = with_torn_ends(GetParam());
  turn_inside_out(m);
  std::vector<Note> notes;
  ClosedSurface closed = closed_surface(m, notes);
  EXPECT_FALSE(closed.torn.empty());
  EXPECT_GT(signed_volume(closed.surface.mesh), 0);
  cut_blind_ends(closed.surface, closed.torn, notes);
  EXPECT_NO_THROW(check_torn(closed.surface, closed.torn, notes));
  expect_caps_at_the_ends(GetParam(), closed.surface, 4);
}
INSTANTIATE_TEST_SUITE_P(Some, TornEnds, testing::ValuesIn(some_arteries()),
                         [](const auto& p) { return p.param.name; });

/// A long hole in the side of a tube of radius 1.4 mm is filled while it is narrower than the ends.
TEST(TornWall, ANarrowHoleIsFilledAndToldOf) {
  const TriMesh whole = test::open_tube(0.12);
  const auto closed_with = [&](double half_length, std::vector<Note>& notes) {
    const Vec3 at(-4, -1.4, 0);
    const TriMesh holed = test::without(whole, [&](const Vec3& p) {
      return std::hypot((p.x() - at.x()) / half_length, (p - at).tail<2>().norm() / 0.25) < 1;
    });
    const ClosedSurface closed = closed_surface(holed, notes);
    EXPECT_EQ(closed.torn.size(), 1u);
    check_torn(closed.surface, closed.torn, notes);
    return closed.surface;
  };
  std::vector<Note> notes;
  const artery::Surface s = closed_with(0.95, notes);
  EXPECT_EQ(s.caps.size(), 2u);
  EXPECT_TRUE(artery::quality(s.mesh).closed);
  std::vector<Note> without;
  const double volume = signed_volume(closed_surface(whole, without).surface.mesh);
  EXPECT_NEAR(signed_volume(s.mesh), volume, 0.02 * volume);
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const Note& n) {
    return n.text.starts_with("A hole of ") && n.text.ends_with(" was filled.");
  }));
  EXPECT_THROW(closed_with(3.9, notes), InputError);
}

TEST(BlindEnds, KnownEndsAndTheSacBetweenThemStay) {
  for (const GeneratedArtery& a : artery::test::generated_arteries()) {
    Surface s = a.surface();
    const std::size_t triangles = s.mesh.triangles.size();
    std::vector<Note> notes;
    cut_blind_ends(s, {}, notes);
    EXPECT_TRUE(notes.empty()) << a.name << ": " << notes.front().text;
    EXPECT_EQ(s.mesh.triangles.size(), triangles) << a.name;
  }
}

/// The stalk has one calibre for longer than a vessel's end needs, and a wider dome lies before it.
TEST(BlindEnds, ASacOnAStalkStays) {
  artery::test::Dome dome;
  dome.neck_diameter = 1.6, dome.radius = 2, dome.half_height = 2, dome.lift = 2.2;
  const GeneratedArtery a = artery::test::on_fork("stalk", {}, dome, 0, 0);
  Surface s = a.surface();
  std::vector<Note> notes;
  cut_blind_ends(s, {}, notes);
  EXPECT_TRUE(notes.empty()) << notes.front().text;
  expect_the_ends(a, with_round_ends(a), 2);
}

/// As the border of a scan cuts a vessel that leaves it at a small angle.
TEST(BlindEnds, EndsThatWereCutAslantAreNotCutAgain) {
  for (const GeneratedArtery& a : some_arteries()) {
    Surface s = a.surface();
    s.caps.clear();
    std::fill(s.patch.begin(), s.patch.end(), -1);
    const std::vector<TrueEnd> ends = true_ends(a);
    for (const TrueEnd& e : ends)
      cut_off(s, e.at - 3.5 * e.radius * e.outward, (e.outward + 2.5 * e.outward.unitOrthogonal()).normalized(), "end");
    ASSERT_EQ(s.caps.size(), ends.size()) << a.name;
    std::vector<Note> notes;
    cut_blind_ends(s, {}, notes);
    EXPECT_TRUE(notes.empty()) << a.name << ": " << notes.front().text;
  }
}

}  // namespace
}  // namespace insula::case_builder
