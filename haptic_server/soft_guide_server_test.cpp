// SPDX-License-Identifier: GPL-3.0-or-later
// A soft guide in the haptic server: only a fresh message of the present engine begins one, and it passes the gate.
#include <gtest/gtest.h>

#include <functional>

#include "haptic_server/rig_for_test.h"
#include "haptic_server/soft_guide.h"

namespace insula {
namespace {

using testing::Rig;

/// Runs for so long. In each step of the engine a message of guide 1 of the right hand goes out, if `sends`.
void run_guided(Rig& rig, int milliseconds, const std::function<bool(int)>& sends,
                const std::function<void(int)>& after = {}) {
  for (int k = 0; k < milliseconds; ++k) {
    if (k % 16 == 0 && sends(k)) rig.send_guide(1, 1);
    rig.run(1);  // checks the slew limit
    if (after) after(k);
  }
}

const auto always = [](int) { return true; };

struct GuidedServer : public ::testing::Test {
  Rig rig;
  double most = 0;
  void SetUp() override {
    rig.send_scene();
    rig.run(600);
    ASSERT_LT(rig.server->force(1).norm(), 0.02) << "in free air";
  }
  std::function<void(int)> watch() {
    return [this](int) { most = std::max(most, rig.server->guided(1).norm()); };
  }
};

TEST_F(GuidedServer, IsFeltThroughTheGateByItsHandAlone) {
  double felt = 0, other = 0;
  run_guided(rig, 1400, always, [&](int k) {
    const Vec3 force = rig.server->force(1), guided = rig.server->guided(1);
    felt = std::max(felt, force.z());
    other = std::max(other, rig.server->force(0).norm());
    const double t = (k + 1) * 1e-3;
    ASSERT_NEAR((guided - Vec3(0, 0, 0.4 * SoftGuide::profile(t, 1.2))).norm(), 0, 1e-9) << k << " ms";
  });
  EXPECT_NEAR(felt, 0.4, 0.04);
  EXPECT_LT(other, 0.02);
  EXPECT_EQ(rig.server->guided(1), Vec3(0, 0, 0));
  EXPECT_LT(rig.server->force(1).norm(), 0.02);
  EXPECT_LT(rig.server->publish_status().given_mJ[1], 0.01) << "a guide is no sign of an active contact";
  EXPECT_EQ(rig.server->messages_refused(), 0);
}

TEST_F(GuidedServer, EndsWhenItsMessagesStop) {
  run_guided(rig, 500, [](int k) { return k < 400; });
  ASSERT_GT(rig.server->guided(1).norm(), 0.35);
  run_guided(rig, 305, [](int) { return false; });  // 100 ms until it is stale, since 384 ms, and the fade
  EXPECT_EQ(rig.server->guided(1), Vec3(0, 0, 0));
  run_guided(rig, 500, always, watch());
  EXPECT_EQ(most, 0) << "the same guide does not begin again";
}

TEST_F(GuidedServer, EndsWithTheEnginesProblems) {
  run_guided(rig, 400, always);
  ASSERT_GT(rig.server->force(1).norm(), 0.3);
  rig.engine_alive = false;
  run_guided(rig, 103, always);
  EXPECT_EQ(rig.server->force(1), Vec3(0, 0, 0)) << "guides alone keep no force up";
}

TEST_F(GuidedServer, TakesNoMessageThatIsLateOrFromElsewhere) {
  const std::vector<std::function<void(insula_lcm::soft_guide_t&)>> wrong{
      [](auto& m) { m.time_us -= 101'000; },
      [](auto& m) { m.time_us += 1'000'000; },
      [](auto& m) { --m.session; },
      [](auto& m) { m.session += 5; },
  };
  for (const auto& change : wrong)
    for (int k = 0; k < 200; ++k) {
      auto m = rig.guide_message(1, 1);
      change(m);
      if (k % 16 == 0) rig.engine_bus.publish(channel::soft_guide, rig.encoded(m));
      rig.run(1);
      watch()(k);
    }
  EXPECT_EQ(most, 0);
}

TEST_F(GuidedServer, RefusesDamagedMessages) {
  std::int64_t sent = 0;
  const auto send = [&](const std::function<void(insula_lcm::soft_guide_t&)>& change, std::size_t cut) {
    auto m = rig.guide_message(1, 1);
    change(m);
    std::vector<std::uint8_t> bytes = rig.encoded(m);
    bytes.resize(bytes.size() - cut);
    rig.engine_bus.publish(channel::soft_guide, bytes);
    rig.run(20);
    watch()(0);
    EXPECT_EQ(rig.server->messages_refused(), ++sent);
  };
  send([](auto& m) { m.force_N = 0.51; }, 0);
  send([](auto& m) { m.force_N = std::nan(""); }, 0);
  send([](auto& m) { m.direction[0] = 1; }, 0);
  send([](auto& m) { m.duration_s = 3600; }, 0);
  send([](auto& m) { m.hand = 2; }, 0);
  send([](auto&) {}, 1);
  send([](auto&) {}, 40);
  EXPECT_EQ(most, 0);
}

}  // namespace
}  // namespace insula
