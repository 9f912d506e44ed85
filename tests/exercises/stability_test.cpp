// SPDX-License-Identifier: GPL-3.0-or-later
// Every exercise left alone, and in random hands. The test runs a short part of it; docs/validation.md says how to run
// all.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/exercises/soak.h"

namespace insula {
namespace {

using test::Soak;

struct Exercise {
  const char* name;
  const char* file;
  test::IdleSettings quick, full;  ///< left alone
  int motions;                     ///< in the short part
  /// Of beats at rest, without a trend: steps do not fall on the same phases in each beat, and a clip rocks with the
  /// pulse. Kernels of other instruction sets round otherwise, and it rocks otherwise.
  double energy_scatter = 0.001;
  double drift = 1e-4;  ///< m
};

// What is played before: until a clip is closed, let go, and the hands are away. A clip beds in for half a minute.
const Exercise exercises[] = {
    {"Fissure", "1_sylvian_fissure.xml", {"", 0, 0.5, 5}, {"", 0, 1.5, 600}, 6},
    {"Dissection", "2_aneurysm_dissection.xml", {"", 0, 0.5, 3}, {"", 0, 1.5, 600}, 1},
    {"Clipping", "3_clipping.xml", {"steady", 7.8, 8, 2}, {"steady", 9.3, 40, 600}, 1, 0.008, 3e-4},
    {"Rupture", "4_rupture.xml", {"steady", 30.3, 8, 2}, {"steady", 30.3, 40, 600}, 1, 0.005, 2e-4},
};
void PrintTo(const Exercise& e, std::ostream* out) { *out << e.file; }

constexpr double max_depth =
    4e-4;  // m: the corner of a retractor between two vertices (1 mm apart) of the tissue that it presses
constexpr double collapsed = 0.01;  // of the size at rest

const char* environment(const char* name) {
  const char* v = std::getenv(name);
  return v && *v ? v : nullptr;
}
double number(const char* name, double fallback) { return environment(name) ? std::atof(environment(name)) : fallback; }
bool all_of_it() { return environment("INSULA_SOAK") != nullptr; }

std::filesystem::path scene(const Exercise& e) {
  return std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training" / e.file;
}

class Stability : public testing::TestWithParam<Exercise> {};

TEST_P(Stability, LeftAloneNothingMoves) {
  const Exercise& e = GetParam();
  test::IdleSettings settings = all_of_it() ? e.full : e.quick;
  settings.duration = number("INSULA_SOAK_IDLE", settings.duration);
  const Soak o = test::leave_alone(scene(e), settings, all_of_it() || environment("INSULA_SOAK_TRACE"));
  ASSERT_TRUE(o.ran);
  ASSERT_FALSE(o.energy.empty());
  std::printf(
      "%s left alone: %.1f s, drift %.2e m (%s), energy %.6e -> %.6e J in %zu beats, %d inverted, least volume %.3f "
      "(%s), area %.3f (%s), tool %.3f mm deep (%s), clip %.3f mm (%s); %.1f s of computing\n",
      e.name, o.seconds, o.drift.value, o.drift.whose.c_str(), o.energy.front(), o.energy.back(), o.energy.size(),
      o.rest.inverted, o.rest.volume.value, o.rest.volume.whose.c_str(), o.rest.area.value, o.rest.area.whose.c_str(),
      1e3 * o.tool.value, o.tool.whose.c_str(), 1e3 * o.clip.value, o.clip.whose.c_str(), o.cpu_s);
  EXPECT_TRUE(o.finite);
  EXPECT_LT(o.drift.value, e.drift) << o.drift.whose;
  EXPECT_LE(o.energy.back(), o.energy.front() * (1 + e.energy_scatter) + 1e-8);
  EXPECT_EQ(o.rest.inverted, 0);
  EXPECT_GT(o.rest.volume.value, collapsed) << o.rest.volume.whose;
  EXPECT_GT(o.rest.area.value, collapsed) << o.rest.area.whose;
  EXPECT_LT(o.tool.value, max_depth) << o.tool.whose;
}

/// Description of the faults after one random motion; empty if there are none.
std::string fault_of(const Soak& o) {
  std::string why;
  if (!o.finite) why += " a number that is not finite;";
  if (o.rest.inverted > 0)
    why += " " + std::to_string(o.rest.inverted) + " inverted, first at " + std::to_string(o.first_inverted) + " s;";
  if (!(o.rest.volume.value > collapsed))
    why += " " + o.rest.volume.whose + " has " + std::to_string(o.rest.volume.value) + " of its volume;";
  if (!(o.rest.area.value > collapsed))
    why += " " + o.rest.area.whose + " has " + std::to_string(o.rest.area.value) + " of its area;";
  const auto depth = [](const test::Worst& w) { return " " + w.whose + " " + std::to_string(1e3 * w.value) + " mm"; };
  if (!(o.tool.value < max_depth)) why += depth(o.tool) + ";";
  if (!(o.clip.value < max_depth)) why += depth(o.clip) + ";";
  if (!(o.astray.value < 1e-3)) why += depth(o.astray) + " from its hand;";
  return why;
}

void print_motion(const Soak& o, const std::string& why) {
  std::printf(
      "  %.2f s: %s inverted at most %d, least volume %.3f, area %.3f, inside %.3f; at rest volume %.3f, area "
      "%.3f, inside %.3f, moved %.2f mm (%s), tool %.3f mm (%s), clip %.3f mm (%s); %.1f s of computing\n",
      o.seconds, why.empty() ? "sound;" : why.c_str(), o.ever.inverted, o.ever.volume.value, o.ever.area.value,
      o.ever.inside.value, o.rest.volume.value, o.rest.area.value, o.rest.inside.value, 1e3 * o.moved.value,
      o.moved.whose.c_str(), 1e3 * o.tool.value, o.tool.whose.c_str(), 1e3 * o.clip.value, o.clip.whose.c_str(),
      o.cpu_s);
  std::fflush(stdout);
}

void print_campaign(const Exercise& e, std::uint64_t count, int failed, const Soak& worst) {
  std::printf(
      "%s in random hands: %llu motions (%.0f s), %d unsound, %s, inverted at rest %d (at most %d), least volume %.3f "
      "(%s), area %.3f (%s), tool %.3f mm deep (%s), clip %.3f mm (%s), astray %.3f mm (%s); %.1f s of computing\n",
      e.name, (unsigned long long)count, worst.seconds, failed, worst.finite ? "finite" : "NOT FINITE",
      worst.rest.inverted, worst.ever.inverted, worst.rest.volume.value, worst.rest.volume.whose.c_str(),
      worst.rest.area.value, worst.rest.area.whose.c_str(), 1e3 * worst.tool.value, worst.tool.whose.c_str(),
      1e3 * worst.clip.value, worst.clip.whose.c_str(), 1e3 * worst.astray.value, worst.astray.whose.c_str(),
      worst.cpu_s);
}

void keep_worst(Soak& worst, const Soak& o) {
  worst.finite = worst.finite && o.finite;
  worst.rest.inverted = std::max(worst.rest.inverted, o.rest.inverted);
  worst.ever.inverted = std::max(worst.ever.inverted, o.ever.inverted);
  worst.rest.volume.least(o.rest.volume.value, o.rest.volume.whose);
  worst.rest.area.least(o.rest.area.value, o.rest.area.whose);
  worst.tool.most(o.tool.value, o.tool.whose);
  worst.clip.most(o.clip.value, o.clip.whose);
  worst.astray.most(o.astray.value, o.astray.whose);
  worst.seconds += o.seconds;
  worst.cpu_s += o.cpu_s;
}

TEST_P(Stability, RandomHandsBreakNothing) {
  const Exercise& e = GetParam();
  const auto seed = std::uint64_t(number("INSULA_SOAK_SEED", 1));
  const auto first = std::uint64_t(number("INSULA_SOAK_FIRST", 0));
  const auto count = std::uint64_t(number("INSULA_SOAK_COUNT", all_of_it() ? 1000 : e.motions));
  const bool trace = environment("INSULA_SOAK_TRACE") != nullptr;
  test::RandomHandsSettings hands;
  if (!all_of_it()) {
    hands.busy = 1.5;
    hands.rest = 1;
  }
  test::RandomCampaign campaign(scene(e));
  ASSERT_TRUE(campaign.opened()) << campaign.diagnostics().format();
  ASSERT_EQ(campaign.settled().inverted, 0);
  Soak worst;
  int failed = 0;
  for (std::uint64_t k = first; k < first + count; ++k) {
    if (all_of_it())
      std::printf("%s, seed %llu, motion %llu ...\n", e.name, (unsigned long long)seed, (unsigned long long)k),
          std::fflush(stdout);
    const Soak o = campaign.run(seed, k, hands, trace);
    const std::string why = fault_of(o);
    failed += !why.empty();
    EXPECT_EQ(why, "") << e.name << ", seed " << seed << ", motion " << k;
    if (all_of_it() || !why.empty()) print_motion(o, why);
    keep_worst(worst, o);
  }
  print_campaign(e, count, failed, worst);
}

INSTANTIATE_TEST_SUITE_P(Exercises, Stability, testing::ValuesIn(exercises),
                         [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace insula
