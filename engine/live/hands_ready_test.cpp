// SPDX-License-Identifier: GPL-3.0-or-later
// A live run waits after its first step until scripted hands are where their motion begins. It goes on by itself when
// none can come.
#include "core/haptics/haptic_update.h"
#include "engine/live/engine_for_test.h"

namespace insula {
namespace {

class HandsReady : public testing::Test, public test::EngineInStep {
 protected:
  HandsReady() {
    folder_.write("go.csv",
                  "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n"
                  "0,left,0.01,0,0,1,0,0,0,0,0\n2,left,0.03,0,0,1,0,0,0,0,0\n");
    bus_.subscribe(channel::haptic_problem, [this](Bytes bytes) {
      HapticUpdate update;
      std::string why;
      ASSERT_TRUE(decode_problem(bytes, update, why)) << why;
      times_.push_back(update.sim_time_s);
    });
  }

  void hand_at(double x_m, const char* device = "simulated") {
    send_hand(connected_hand(0, device, {Vec3(x_m, 0, 0), Quat::Identity()}));
  }
  void run(double duration_s) {
    LiveOptions settings = options(folder_.write("scene.xml", R"(<scene time_step="10 ms"><exercise id="e" title="E">
      <motion id="steady" file="go.csv"/></exercise></scene>)"),
                                   duration_s);
    settings.motion = "steady";
    ASSERT_EQ(EngineInStep::run(settings), 0);
  }
  /// Number of problems of the first step.
  long waited() const { return std::count(times_.begin(), times_.end(), times_.front()); }

  std::vector<double> times_;
};

TEST_F(HandsReady, TheMotionBeginsWhenTheHandIsAtItsStart) {
  on_step_ = [this](int n) { hand_at(n < 20 ? 0.03 : 0.0101); };
  run(0.2);
  EXPECT_GE(waited(), 20) << "it went on while the hand was at the end of its last motion";
  EXPECT_LE(waited(), 25);
  EXPECT_NEAR(times_.front(), 0.01, 1e-12);
}

TEST_F(HandsReady, NobodyIsWaitedForWithoutAServer) {
  run(0.2);
  EXPECT_GT(waited(), 5);
  EXPECT_LT(waited(), 100) << "half a second";
}

TEST_F(HandsReady, APersonsArmIsNotWaitedFor) {
  on_step_ = [this](int) { hand_at(0.5, "haply"); };
  run(0.2);
  EXPECT_LT(waited(), 5);
}

TEST_F(HandsReady, APersonWhoMovesAHandIsNotWaitedFor) {
  on_step_ = [this](int n) {
    insula_lcm::hand_input_t m{};
    m.q[0] = 1;
    if (n == 3) test::send(bus_, channel::hand_input, m);
    hand_at(0.5);
  };
  run(0.2);
  EXPECT_LT(waited(), 10);
}

}  // namespace
}  // namespace insula
