// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 3 with the Doppler probe: what it hears before the clip and after it, against the flow of the network and
// the vessel's own centrelines.
#include <numbers>

#include "core/mechanics/shell_body.h"
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

const std::filesystem::path clipping_exercise =
    std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/3_clipping.xml";

/// Where the motion holds the probe, as tools/motions/clipping.py has it.
struct Listened {
  const char* vessel;
  double share;  ///< of the centreline
};
constexpr Listened places[] = {{"parent", 0.8}, {"superior", 0.5}, {"inferior", 0.62}, {"sac", 0.65}};
constexpr double beat = 60.0 / 70;  // s

/// Start of the two beats at a place, s, before the clip (0) or after it (1).
double begins(int round, int place) { return (round == 0 ? 0 : 30.61) + 2.35 + 4.9 * place; }

/// v cos(theta) at rest: the flow of the last beat through the centreline's radius without half of the wall, m/s.
double expected_velocity(const Simulation& s, const Listened& at, double flow) {
  for (const auto& line : s.scene().find_as<ShellBody>("artery")->model().centrelines) {
    if (line.name != at.vessel) continue;
    const std::size_t k = std::size_t(at.share * double(line.points.size() - 1));
    const Vec3 along = (line.points[k + 1] - line.points[k - 1]).normalized();
    const double r = line.radius[k] - 0.15e-3;
    return flow / (std::numbers::pi * r * r) * along.dot(Vec3(0.93, 0.25, 0.27).normalized());
  }
  return -1;
}

TEST(Clipping, TheDopplerProbeHearsOpenBranchesAndASilentDome) {
  double sum[2][4] = {}, most[2][4] = {}, expected[2][4] = {};
  int count[2][4] = {};
  test::Played o = test::play_motion(clipping_exercise, "listening", -1, [&](const Simulation& s) {
    const double t = s.report().time;
    const double v = *s.channels().find("doppler.doppler_velocity")->channel->values(0);
    Vessels vessels(s);
    for (int round = 0; round < 2; ++round)
      for (int p = 0; p < 4; ++p) {
        if (t < begins(round, p) || t >= begins(round, p) + 2 * beat) continue;
        sum[round][p] += v;
        most[round][p] = std::max(most[round][p], std::abs(v));
        ++count[round][p];
        for (const VesselState& vessel : vessels.now())
          if (vessel.id == places[p].vessel) expected[round][p] = expected_velocity(s, places[p], vessel.flow);
      }
  });
  ASSERT_TRUE(o.ran);
  EXPECT_EQ(o.state, ExerciseState::done);
  for (const auto& [fault, times] : o.faults) EXPECT_EQ(times, 0) << fault;
  for (int round = 0; round < 2; ++round)
    for (int p = 0; p < 3; ++p) {
      ASSERT_GT(count[round][p], 90);
      // The wall beats and the tip may press on it, so the lumen is not quite that at rest.
      EXPECT_NEAR(sum[round][p] / count[round][p], expected[round][p], 0.15 * expected[round][p])
          << places[p].vessel << (round == 0 ? " before" : " after");
      EXPECT_GT(most[round][p], 1.2 * sum[round][p] / count[round][p]) << "it beats";
    }
  EXPECT_GT(sum[0][3] / count[0][3], 0.01) << "the dome murmurs";
  EXPECT_EQ(most[1][3], 0) << "and is silent behind the clip";
}

}  // namespace
}  // namespace insula
