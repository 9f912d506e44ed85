// SPDX-License-Identifier: GPL-3.0-or-later
// The balance of the fluid against the closed form of its volume: it stands at its level, a tube drains it down to its
// own tip, and it fills again at the rate of its cisterns.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/sim/report.h"
#include "core/testing/example.h"
#include "plugins/bleeding/bowl.h"

namespace insula {
namespace {

constexpr double ml = 1e-6;

struct Field {
  std::unique_ptr<Simulation> s =
      test::load(std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/cerebrospinal_fluid/example.xml");
  Bowl bowl{0.008, 0.012};
  double h = 0.0166667;  ///< of a scene that names no other step, s

  void tube(const Vec3& tip, bool button, int steps) const {
    HandState hand;
    hand.present = true;
    hand.device = s->instruments().front()->home_pose();
    hand.device.p = tip;
    hand.button1 = button;
    for (int i = 0; i < steps; ++i) {
      s->set_hand(0, hand);
      s->step();
    }
  }
  double height() const {
    const ChannelEntry* e = s->channels().find("fluid.height");
    return e->channel->values(e->item)[0];
  }
  double volume() const { return bowl.volume(height()); }
};
const Vec3 above(0, 0, 0.03), inside(0, 0, 0.003);

TEST(CerebrospinalFluid, StandsAtItsLevelAndFillsAgainAtItsRate) {
  const Field f;
  ASSERT_TRUE(f.s);
  f.tube(above, true, 5);
  EXPECT_NEAR(f.height(), 0.006, 1e-12) << "a tube above the fluid takes nothing, and it does not rise over its level";

  f.tube(inside, true, 5);  // until the tool has followed the hand
  double before = f.volume();
  f.tube(inside, true, 10);
  EXPECT_NEAR(before - f.volume(), 10 * f.h * 42 * ml / 60, 1e-15) << "45 ml/min are taken, 3 come";
  f.tube(inside, true, 600);
  const double tip = f.bowl.volume(f.s->instruments().front()->pose().p.z());
  EXPECT_LT(f.volume(), tip + f.h * 3 * ml / 60 + 1e-15);
  EXPECT_GT(f.volume(), tip - f.h * 45 * ml / 60 - 1e-15) << "no more than a step's suction below the tip";

  f.tube(above, false, 5);
  before = f.volume();
  f.tube(above, false, 20);
  EXPECT_NEAR(f.volume() - before, 20 * f.h * 3 * ml / 60, 1e-15);
}

TEST(CerebrospinalFluid, LooksLikeItsMaterial) {
  const auto look = [](const std::string& attribute) {
    const auto s =
        test::load_text("<scene><cerebrospinal_fluid id=\"f\" origin=\"0 0 0 mm\"" + attribute + "/></scene>",
                        std::filesystem::path(INSULA_SOURCE_DIR) / "scene.xml");
    return s ? s->scene().find("f")->drawables().at(0)->material() : "";
  };
  EXPECT_EQ(look(""), "cerebrospinal_fluid");
  EXPECT_EQ(look(" material=\"blood\""), "blood");
}

TEST(CerebrospinalFluid, BeginsAnewOnReset) {
  const Field f;
  ASSERT_TRUE(f.s);
  f.tube(inside, true, 30);
  EXPECT_LT(f.height(), 0.0055);
  f.s->reset();
  f.tube(above, false, 1);
  EXPECT_NEAR(f.height(), 0.006, 1e-12);
}

}  // namespace
}  // namespace insula
