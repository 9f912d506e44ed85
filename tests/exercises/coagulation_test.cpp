// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 1 with a vein that the knife cuts: it bleeds until the bipolar forceps have closed both of its ends.
#include "plugins/bridging_veins/bridging_veins.h"
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

const std::filesystem::path fissure_exercise =
    std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/1_sylvian_fissure.xml";

/// The exercise with the right hand, which moves in straight lines.
struct RightHand {
  Registry registry;
  std::unique_ptr<Simulation> s;
  BridgingVeins* veins = nullptr;
  Pose pose;
  std::map<std::string, int> events;

  RightHand() {
    register_builtin(registry);
    s = load_simulation(fissure_exercise, registry, 0).simulation;
    if (!s) return;
    veins = s->scene().find_as<BridgingVeins>("veins");
    pose = s->scene().find_as<Instrument>("right_dissector")->home_pose();
  }
  /// Moves the tip there in so many seconds, with the button held or not.
  void move(const Vec3& to, double seconds, bool button = false) {
    const Vec3 from = pose.p;
    const int steps = std::max(1, int(std::lround(seconds * 60)));
    for (int k = 1; k <= steps; ++k) {
      pose.p = from + double(k) / steps * (to - from);
      HandState hand;
      hand.present = true;
      hand.device = pose;
      hand.button1 = button;
      s->set_hand(1, hand);
      s->step();
      ASSERT_TRUE(s->report().finite);
      for (const Event& e : s->events()) ++events[e.kind];
    }
  }
  double channel(const char* id) const {
    const ChannelEntry* e = s->channels().find(id);
    return *e->channel->values(e->item);
  }
};

TEST(SylvianFissure, ACutVeinBleedsUntilBothEndsAreClosed) {
  RightHand hand;
  ASSERT_TRUE(hand.s && hand.veins && hand.veins->count() > 0);
  const Vec3 out = Vec3(0.946, 0.236, 0.22).normalized(), home = hand.pose.p;
  const Vec3 a = hand.veins->beginning(0).body->position(hand.veins->beginning(0)),
             b = hand.veins->ending(0).body->position(hand.veins->ending(0));
  const Vec3 middle = 0.5 * (a + b);
  const Vec3 sweep = (b - a).cross(out).normalized();
  hand.move(middle + 0.008 * out - 0.004 * sweep, 1.5);
  hand.move(middle - 0.0005 * out - 0.004 * sweep, 1);
  for (int k = 0; k < 6 && hand.veins->veins_parted() == 0; ++k)
    hand.move(middle - 0.0005 * out + (k % 2 == 0 ? 0.004 : -0.004) * sweep, 1);
  ASSERT_EQ(hand.veins->veins_parted(), 1);
  EXPECT_EQ(hand.events["vein_parted"], 1);
  EXPECT_GT(hand.channel("veins.rate"), 0);

  hand.move(home, 1.5);
  ASSERT_EQ(hand.s->command("exchange", "right bipolar"), "");
  int cut = 0;  // the places of the parted vein
  while (!hand.veins->site(cut + 1)) cut += 3;
  for (const int stump : {cut + 1, cut + 2}) {
    const auto site = hand.veins->site(stump);
    ASSERT_TRUE(site);
    hand.move(site->position + 0.008 * out, 1.5);
    hand.move(site->position + 0.0005 * out, 0.8);
    for (int k = 0; k < 20 && hand.veins->site(stump); ++k)
      hand.move(hand.veins->site(stump)->position + 0.0005 * out, 0.1, true);
    EXPECT_FALSE(hand.veins->site(stump));
    hand.move(hand.pose.p + 0.008 * out, 0.8);
  }
  EXPECT_EQ(hand.events["coagulated"], 2);
  EXPECT_EQ(hand.events["vein_closed"], 0) << "no whole vein was burnt";
  EXPECT_EQ(hand.events["stuck"], 0);
  EXPECT_EQ(hand.channel("veins.rate"), 0);
  const double lost = hand.channel("veins.lost");
  EXPECT_GT(lost, 0);
  hand.move(home, 1);
  EXPECT_EQ(hand.channel("veins.lost"), lost);
}

}  // namespace
}  // namespace insula
