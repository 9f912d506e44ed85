// SPDX-License-Identifier: GPL-3.0-or-later
// Every fault, with several seeds, in the middle of contact: what the manual promises is what happens.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/faults/fault_cases.h"

namespace insula::testing {
namespace {

constexpr int seeds = 5, settled_ms = 1500, phase_ms = 7, longest_ms = 2000, back_ms = 1000;
using Trace = std::vector<std::array<Vec3, 2>>;

/// The forces without any fault, in which no seed plays a part.
const Trace& undisturbed() {
  static const Trace trace = [] {
    FaultRig rig(1);
    rig.run(settled_ms + seeds * phase_ms + longest_ms + back_ms);
    return rig.trace;
  }();
  return trace;
}

Vec3 mean(const Trace& trace, int from_ms, int to_ms, int hand) {
  Vec3 sum = Vec3::Zero();
  for (int t = from_ms; t < to_ms; ++t) sum += trace[std::size_t(t)][std::size_t(hand)];
  return sum / (to_ms - from_ms);
}

void expect_promise(const FaultCase& fault, int seed) {
  const Trace& clean = undisturbed();
  FaultRig rig(std::uint64_t(seed) * 77 + 5);
  rig.run(settled_ms + phase_ms * seed);  // each at another phase of the engine's step
  const int begin = int(rig.trace.size()), lasts = int(std::lround(1000 * fault.lasts_s));
  ASSERT_LE(lasts, longest_ms);
  for (int hand = 0; hand < 2; ++hand) ASSERT_GT(rig.trace.back()[std::size_t(hand)].norm(), 0.4) << "not in contact";
  rig.set_link(fault.link);
  if (fault.set) fault.set(rig, true);
  rig.run(lasts);
  rig.set_link({});
  if (fault.set) fault.set(rig, false);
  rig.run(back_ms);
  for (const DeviceDouble* d : rig.device) EXPECT_EQ(d->broken(), "");

  const int end = begin + lasts, last = end + back_ms;
  for (int hand = 0; hand < 2; ++hand) {
    const bool hit = !fault.one_hand || hand == 0;
    const int silent = hit && fault.zero_after_s >= 0 ? begin + int(std::lround(1000 * fault.zero_after_s)) : end;
    for (int t = silent; t < end; ++t)
      ASSERT_EQ(rig.trace[std::size_t(t)][std::size_t(hand)], Vec3(0, 0, 0))
          << t - begin << " ms after it began, hand " << hand;
    double rendered = 0, all = 0;
    bool same = true;
    for (int t = begin; t < end; ++t) {
      const Vec3 &is = rig.trace[std::size_t(t)][std::size_t(hand)], &was = clean[std::size_t(t)][std::size_t(hand)];
      rendered += is.norm();
      all += was.norm();
      same = same && is == was;
    }
    EXPECT_TRUE(same || fault.min_share < 1) << "hand " << hand;
    EXPECT_GE(rendered, (hit ? fault.min_share : 0.95) * all * (1 - 1e-12))
        << "hand " << hand << ": " << rendered / all;
    const Vec3 back = mean(rig.trace, last - 20, last, hand), wanted = mean(clean, last - 20, last, hand);
    EXPECT_LT((back - wanted).norm(), 0.05 * wanted.norm())
        << "not back after a second, hand " << hand << ": " << back.transpose() << " instead of " << wanted.transpose();
  }
}

class Fault : public ::testing::TestWithParam<FaultCase> {};

TEST_P(Fault, KeepsItsPromise) {
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_promise(GetParam(), seed);
    if (HasFatalFailure()) return;
  }
}
INSTANTIATE_TEST_SUITE_P(Campaign, Fault, ::testing::ValuesIn(fault_cases),
                         [](const auto& i) { return std::string(i.param.name); });

TEST(FaultRigs, AreInContactAndTheSameEveryTime) {
  const Trace& clean = undisturbed();
  FaultRig again(99);
  again.run(2000);
  for (int t = 0; t < 2000; ++t) ASSERT_EQ(again.trace[std::size_t(t)], clean[std::size_t(t)]) << t;
  EXPECT_GT(again.device[0]->torque().norm(), 1e-4);  // torques are watched, so there must be some
}

TEST(FaultRigs, ServoStallsAreCountedAndNotMadeUpFor) {
  FaultRig rig(1);
  rig.run(1000);
  rig.servo_stalled = true;
  rig.run(500);
  rig.servo_stalled = false;
  rig.run(100);
  EXPECT_EQ(rig.ticks, 1100);
  EXPECT_EQ(rig.server->publish_status().missed_ticks, 500);
}

TEST(FaultTable, IsTheManuals) {
  std::ifstream in(std::string(INSULA_SOURCE_DIR) + "/docs/haptics-and-safety.md");
  std::stringstream text;
  text << in.rdbuf();
  std::string wanted;
  for (const FaultCase& c : fault_cases)
    wanted += std::string("| `") + c.name + "` | " + c.cause + " | " + c.promise + " |\n";
  EXPECT_NE(text.str().find(wanted), std::string::npos) << "the manual's table of faults should read:\n" << wanted;
}

}  // namespace
}  // namespace insula::testing
