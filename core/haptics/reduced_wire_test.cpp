// SPDX-License-Identifier: GPL-3.0-or-later
// The reduced dynamic model in the haptic problem's wire format.
#include <functional>

#include "core/haptics/haptic_update_for_test.h"

namespace insula {
namespace {

using testing::Buffer;
using testing::encoded;
using testing::make_update;

constexpr double h = 1.0 / 60;

ReducedModel::Mode mode(double mass, double damping, double velocity, double force) {
  return {double(float(mass * h * h)), double(float(damping * h)), double(float(velocity)), double(float(force))};
}

/// Two bodies. Row 2 touches both, rows 0 and 1 one of them, the others none.
HapticUpdate reduced_update(unsigned seed) {
  HapticUpdate u = make_update(seed, 5, 0, 2);
  ReducedModel& m = u.problem.reduced;
  m.add_group({mode(0.3, 0.2, 0.01, -1e-3), mode(0.6, 0, 0, 2e-3), mode(0, 0.9, -0.02, 0)}, 5);
  m.add_group({mode(0.1, 0.1, 0.05, 1e-3), mode(1, 0, 0.1, 0)}, 5);
  const auto small = [](double x) { return double(float(x)); };
  for (std::size_t s = 0; s < 3; ++s) m.row(0)[s] = m.row(2)[s] = small(0.005 * double(s + 1));
  for (std::size_t s = 3; s < 5; ++s) m.row(1)[s] = m.row(2)[s] = small(-0.004 * double(s));
  return u;
}

TEST(ReducedModelWire, RoundTripIsExactAndInTheFormOfTheGeneratedClass) {
  const HapticUpdate sent = reduced_update(3);
  const Buffer bytes = encoded(sent);
  HapticUpdate got = make_update(9);
  std::string why;
  ASSERT_TRUE(decode_problem(bytes, got, why)) << why;
  testing::expect_equal(sent, got);
  EXPECT_TRUE(sent.problem.reduced == got.problem.reduced);
  const auto message = testing::expect_generated_form(bytes);
  ASSERT_EQ(message.reduced_bodies, 2);
  EXPECT_EQ(message.reduced_body[1].rows, 2);
  EXPECT_EQ(message.reduced_body[1].row[1], 2);
  EXPECT_EQ(message.reduced_body[0].participation[1][2], 0.015f);
}

TEST(ReducedModelWire, ABodyWithoutARowIsNotSent) {
  HapticUpdate u = reduced_update(3), got;
  for (std::size_t i = 0; i < 5; ++i) std::fill_n(u.problem.reduced.row(i), 3, 0.0);
  std::string why;
  ASSERT_TRUE(decode_problem(encoded(u), got, why)) << why;
  ASSERT_EQ(got.problem.reduced.groups.size(), 1u);
  EXPECT_EQ(got.problem.reduced.modes[1], u.problem.reduced.modes[4]);
  EXPECT_EQ(got.problem.reduced.row(2)[1], u.problem.reduced.row(2)[4]);
}

TEST(ReducedModelWire, WhatIsNotPassiveOrOutOfRangeIsRefused) {
  using Model = ReducedModel;
  const std::vector<std::pair<const char*, std::function<void(Model&)>>> faults = {
      {"negative mass", [](Model& m) { m.modes[1].mass_s2 = -1e-9; }},
      {"negative damping", [](Model& m) { m.modes[1].damping_s = -1e-9; }},
      {"negative stiffness", [](Model& m) { m.modes[1].damping_s = 0.5 * h; }},
      {"mass that is no number", [](Model& m) { m.modes[0].mass_s2 = NAN; }},
      {"damping that is no number", [](Model& m) { m.modes[0].damping_s = NAN; }},
      {"infinite velocity", [](Model& m) { m.modes[4].velocity = INFINITY; }},
      {"force that is no number", [](Model& m) { m.modes[4].force = NAN; }},
      {"large force", [](Model& m) { m.modes[4].force = 1e5; }},
      {"participation that is no number", [](Model& m) { m.row(2)[1] = NAN; }},
      {"a row that moves more than its W", [](Model& m) { m.row(2)[1] = 0.2; }},
  };
  const HapticUpdate before = make_update(9);
  for (const auto& [name, fault] : faults) {
    HapticUpdate u = reduced_update(4), into = before;
    fault(u.problem.reduced);
    std::string why;
    EXPECT_FALSE(decode_problem(encoded(u), into, why)) << name;
    EXPECT_TRUE(why.find("mode") != std::string::npos) << name << ": " << why;
    testing::expect_equal(before, into);
  }
}

TEST(ReducedModelWire, WhatDoesNotFitIsNotSent) {
  Buffer out;
  HapticUpdate u = make_update(3, 5, 0, 2);
  u.problem.reduced.modes.resize(ReducedModel::max_modes + 1);
  u.problem.reduced.groups = {{0, int(ReducedModel::max_modes) + 1}};
  u.problem.reduced.participation.assign(5 * (ReducedModel::max_modes + 1), 0.0);
  EXPECT_FALSE(encode_problem(u, out));
  u = reduced_update(3);
  u.problem.reduced.groups[1].first = 2;  // overlaps
  EXPECT_FALSE(encode_problem(u, out));
  u = reduced_update(3);
  u.problem.reduced.participation.resize(7);
  EXPECT_FALSE(encode_problem(u, out));
}

TEST(ReducedModelWire, EveryTruncationAndRandomDamageIsRefusedOrWhole) {
  const Buffer whole = encoded(reduced_update(1));
  testing::damage_message(
      whole, 79, 50'000,
      [](bool accepted, const Buffer&, const Buffer& before, const Buffer& now, const HapticUpdate& into) {
        if (!accepted) {
          ASSERT_EQ(now, before);
        }
        const ReducedModel& m = into.problem.reduced;
        ASSERT_LE(m.modes.size(), ReducedModel::max_modes);
        for (const ReducedModel::Mode& x : m.modes) {
          ASSERT_TRUE(x.mass_s2 >= 0 && x.damping_s >= 0 && std::isfinite(x.velocity) && std::isfinite(x.force));
          ASSERT_GE(x.stiffness(into.step_s), -1e-3);
        }
        for (const double x : m.participation) ASSERT_TRUE(std::isfinite(x));
      });
}

}  // namespace
}  // namespace insula
