// SPDX-License-Identifier: GPL-3.0-or-later
// A session whose hints were also a soft force is run again from its file with the same bits. The engine never applies
// that force: it asks the haptic server for it, and what it does to the hand comes back in the poses of the device,
// which the file has. So a rerun needs no force, and a guide to which the hand does not yield changes no bit.
#include <insula_lcm/soft_guide_t.hpp>

#include "core/testing/example.h"
#include "engine/live/engine_for_test.h"
#include "engine/session/rerun.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
const fs::path example = fs::path(INSULA_SOURCE_DIR) / "plugins/hints/example.xml";

/// What a session left.
struct Recorded {
  fs::path file;
  int guides = 0;        ///< messages SOFT_GUIDE
  double yielded_m = 0;  ///< by the arm
};

/// The right hand presses on the block of the example. Its arm yields by so much for each message of a guide.
class PressingHand : public test::EngineInStep {
 public:
  explicit PressingHand(double yields_m) {
    bus_.subscribe(channel::soft_guide, [this, yields_m](Bytes b) {
      const auto m = decode<insula_lcm::soft_guide_t>(b);
      ASSERT_TRUE(m);
      ++guides_;
      yielded_ += yields_m * Vec3(m->direction[0], m->direction[1], m->direction[2]);
    });
  }
  Recorded record(const fs::path& file, bool guided) {
    const auto scene = test::load(example);
    if (!scene) return {};
    const Pose home = scene->instruments().front()->home_pose();
    on_step_ = [this, guided, home](int step) {
      if (step == 1 && guided) ask("soft_guide", "on");
      Pose hand = home;
      hand.p += Vec3(0, 0, -0.004 * std::min(1.0, step / 150.0)) + yielded_;
      send_hand(connected_hand(1, "haply", hand));
    };
    LiveOptions settings = options(example, 4);
    settings.motion = "none";
    settings.mode = SessionMode::practice;
    settings.record = file;
    EXPECT_EQ(run(settings), 0);
    return {file, guides_, yielded_.norm()};
  }

 private:
  int guides_ = 0;
  Vec3 yielded_ = Vec3::Zero();
};

class GuidedSession : public testing::Test {
 protected:
  Recorded record(const std::string& name, bool guided, double yields_m) const {
    return PressingHand(yields_m).record(folder_.path() / (name + ".insula"), guided);
  }
  static std::int64_t last_hash(const Recorded& session) {
    std::int64_t hash = 0;
    SessionReader(session.file).steps([&](const insula_lcm::session_step_t& step) {
      if (step.hashed) hash = step.state_hash;
      return true;
    });
    return hash;
  }
  static RerunResult again(const Recorded& session) {
    SessionReader reader(session.file);
    return rerun(reader, test::builtin(), {.threads = 1});
  }
  static std::vector<std::string> choices(const Recorded& session) {
    std::vector<std::string> out;
    SessionReader(session.file).events([&](const insula_lcm::sim_event_t& e) {
      if (e.kind == "soft_guide") out.push_back(e.id);
      return true;
    });
    return out;
  }

  test_files::TempFolder folder_;
};

TEST_F(GuidedSession, HasTheSameBitsWhenItIsRunAgain) {
  const Recorded guided = record("guided", true, 20e-6), alone = record("alone", false, 20e-6);
  EXPECT_GT(guided.guides, 50) << "the hint was a force";
  EXPECT_GT(guided.yielded_m, 1e-3) << "the hand gave way to it";
  EXPECT_EQ(alone.guides, 0);
  EXPECT_NE(last_hash(guided), last_hash(alone)) << "it moved the tissue";
  EXPECT_EQ(choices(guided), std::vector<std::string>{"on"});
  EXPECT_TRUE(choices(alone).empty());
  for (const Recorded& session : {guided, alone}) {
    const RerunResult r = again(session);
    EXPECT_TRUE(r.good()) << session.file << ": " << r.broken << ", first different at " << r.first_different_s << " s";
    EXPECT_GE(r.compared, 4) << "each second";
  }
}

TEST_F(GuidedSession, AGuideThatTheHandDoesNotFollowChangesNoBit) {
  const Recorded guided = record("guided", true, 0), alone = record("alone", false, 0);
  EXPECT_GT(guided.guides, 50);
  EXPECT_EQ(last_hash(guided), last_hash(alone));
}

}  // namespace
}  // namespace insula
