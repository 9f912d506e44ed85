// SPDX-License-Identifier: GPL-3.0-or-later
// The servo against the engine at 1 kHz, in short: a tap on the cortex of exercise 1; force cross-fade at 30 Hz with
// jitter; what is compared how.
#include "tools/workbench/haptic_truth.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

const std::filesystem::path source(INSULA_SOURCE_DIR);
constexpr double tap_s = 0.6;  // the first of three

std::unique_ptr<Simulation> fissure(double step_s) {
  return load_simulation(source / "scenes/training/1_sylvian_fissure.xml", test::builtin(), 1, step_s).simulation;
}

/// The reference is made once: it is most of the work.
class HapticTruth : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    motion_ = new Motion(load_motion(source / "scenes/haptics/tap.csv"));
    auto simulation = fissure(1e-3);
    ASSERT_TRUE(simulation);
    ASSERT_EQ(simulation->h(), 1e-3);
    reference_ = new ForceTrace(reference_forces(*simulation, *motion_, tap_s));
  }
  static void TearDownTestSuite() {
    delete motion_;
    delete reference_;
  }
  static std::vector<RecordedStep> steps(double rate, double prediction_horizon_s = -1) {
    auto simulation = fissure(1 / rate);
    simulation->set_collision_horizon(3 / rate);
    return record_steps(*simulation, *motion_, tap_s, prediction_horizon_s);
  }
  static TruthOfHand truth(const ForceTrace& rendered) { return compare(reference_->force[1], rendered.force[1]); }
  static Motion* motion_;
  static ForceTrace* reference_;
};
Motion* HapticTruth::motion_ = nullptr;
ForceTrace* HapticTruth::reference_ = nullptr;

TEST_F(HapticTruth, ATapAt60HzFeelsAsAt1kHz) {
  const auto problems = steps(60);
  ReplaySettings s;
  s.latency_s = 1.0 / 60;
  const TruthOfHand plain = truth(replay(problems, *motion_, tap_s, s));
  s.servo = ServoSettings::beyond_equation_7();
  const TruthOfHand full = truth(replay(problems, *motion_, tap_s, s));
  s.rendering = Rendering::held;
  const TruthOfHand held = truth(replay(problems, *motion_, tap_s, s));
  EXPECT_GT(full.peak_N, 0.02);
  EXPECT_EQ(full.onsets, 1);
  EXPECT_LT(full.rms, 0.05);
  EXPECT_LE(std::abs(full.onset_s), 2e-3);
  EXPECT_GT(held.rms, 5 * full.rms);
  EXPECT_GT(plain.rms, 3 * full.rms);
  EXPECT_GT(held.onset_s, 10e-3);
}

// A tool that goes over an edge of the surface is past it when the step arrives that began before it.
TEST_F(HapticTruth, ContactsTurnedByTheEngineAreTruerAt30Hz) {
  ReplaySettings s;
  s.latency_s = 3e-3;
  s.servo = ServoSettings::beyond_equation_7();
  const double as_in_the_step = truth(replay(steps(30), *motion_, tap_s, s)).rms;
  const double predicted = truth(replay(steps(30, s.latency_s), *motion_, tap_s, s)).rms;
  std::printf("a tap at 30 Hz: %.4f, turned %.4f\n", as_in_the_step, predicted);
  EXPECT_LT(predicted, 0.8 * as_in_the_step);
}

// A blade touches by several places at once: held still, each keeps its own direction.
TEST(HapticTruthPredicted, FramesOfWhatIsHeldStillAreNotRotated) {
  constexpr double still_s = 0.44;  // pressed on from 0.35 to 0.45 s
  const Motion drag = load_motion(source / "scenes/haptics/drag.csv");
  auto simulation = fissure(1.0 / 60);
  const auto push = [&](double prediction_horizon_s) -> Vec3 {
    simulation->reset();
    const ConstraintProblem p = record_steps(*simulation, drag, still_s, prediction_horizon_s).back().update.problem;
    Vec6 sum = Vec6::Zero();
    for (const ToolTerms& tool : p.tools)
      for (int i = 0; i < p.rows; ++i) sum += p.lambda[std::size_t(i)] * tool.jacobian.row(i).transpose();
    return sum.head<3>();
  };
  const Vec3 as_in_the_step = push(-1), predicted = push(3e-3);
  std::printf("held still: %.1f mN, turned %.2f mN away\n", 1e3 * as_in_the_step.norm(),
              1e3 * (predicted - as_in_the_step).norm());
  EXPECT_GT(as_in_the_step.norm(), 0.02);
  EXPECT_LT((predicted - as_in_the_step).norm(), 0.005 * as_in_the_step.norm());
}

TEST_F(HapticTruth, ANewProblemDoesNotJumpAt30HzWithJitter) {
  const auto problems = steps(30);
  ReplaySettings s;
  s.latency_s = 1.0 / 30;
  s.jitter = 0.3;
  s.servo = ServoSettings::beyond_equation_7();
  EXPECT_LT(replay(problems, *motion_, tap_s, s).jump[1], 0.02 * truth(*reference_).peak_N);
  s.servo.force_crossfade.within_s = 0;
  EXPECT_GT(replay(problems, *motion_, tap_s, s).jump[1],
            0.03 * truth(*reference_).peak_N);  // there is something to hand over
}

TEST_F(HapticTruth, LookingAheadChangesNoForce) {
  auto simulation = fissure(1.0 / 60);
  const auto without = record_steps(*simulation, *motion_, 0.4);
  const auto with = steps(60);
  for (std::size_t n = 0; n < without.size(); ++n)
    EXPECT_NEAR((with[n].force[1] - without[n].force[1]).norm(), 0, 1e-4) << n;
}

/// Where a strand parts and where a clip comes up against a vessel, at 30 Hz, late and with jitter. The peak: of the
/// engine's own force.
void expect_no_jump(const char* scene, const char* motion_file, double until_s) {
  const auto simulation = load_simulation(source / "scenes/training" / scene, test::builtin(), 1, 1.0 / 30).simulation;
  ASSERT_TRUE(simulation);
  simulation->set_collision_horizon(3.0 / 30);
  const Motion motion = load_motion(source / "scenes/haptics" / motion_file);
  const auto steps = record_steps(*simulation, motion, until_s);
  double peak[2] = {0, 0};
  for (const RecordedStep& step : steps)
    for (std::size_t h = 0; h < 2; ++h) peak[h] = std::max(peak[h], step.force[h].norm());
  ReplaySettings s;
  s.latency_s = 1.0 / 30;
  s.jitter = 0.3;
  s.servo = ServoSettings::beyond_equation_7();
  const ForceTrace smooth = replay(steps, motion, until_s, s);
  s.servo.force_crossfade.within_s = 0;
  const ForceTrace abrupt = replay(steps, motion, until_s, s);
  double most = 0;
  for (std::size_t h = 0; h < 2; ++h) {
    EXPECT_LE(smooth.jump[h], 0.02 * peak[h]) << h;
    if (peak[h] > 0) most = std::max(most, abrupt.jump[h] / peak[h]);
  }
  EXPECT_GT(most, 0.03);  // there is something to hand over, more than is left with the crossfade
}

TEST(HapticCrossfade, WhereStrandsPart) { expect_no_jump("1_sylvian_fissure.xml", "strand.csv", 2.5); }
TEST(HapticCrossfade, WhereAClipComesUpAgainstAVessel) { expect_no_jump("3_clipping.xml", "clip.csv", 2.6); }

TEST(HapticTruthCompare, ErrorsAndOnsets) {
  std::vector<Vec3> reference(200, Vec3::Zero()), rendered = reference;
  for (std::size_t i = 100; i < 200; ++i) reference[i] = Vec3(0, 0, 0.1);
  for (std::size_t i = 103; i < 200; ++i) rendered[i] = Vec3(0, 0.01, 0.1);
  TruthOfHand t = compare(reference, rendered);
  EXPECT_NEAR(t.peak_N, 0.1, 1e-12);
  EXPECT_NEAR(t.rms, std::sqrt((3 * 1.0 + 97 * 0.01) / 100), 1e-12);
  EXPECT_NEAR(t.worst, 1, 1e-12);
  EXPECT_NEAR(t.onset_s, 3e-3, 1e-12);
  EXPECT_EQ(t.onsets, 1);
  for (std::size_t i = 98; i < 103; ++i) rendered[i] = reference[100];
  EXPECT_NEAR(compare(reference, rendered).onset_s, -2e-3, 1e-12);
  EXPECT_FALSE(compare(rendered, reference).onsets == 0);
  // A force that was there creeps over the threshold: no contact begins.
  std::vector<Vec3> creeping = reference;
  for (std::size_t i = 0; i < 100; ++i) creeping[i] = Vec3(0, 0, 2.1e-5 * double(i));
  EXPECT_EQ(compare(creeping, rendered).onsets, 0);
  EXPECT_FALSE(compare(std::vector<Vec3>(5, Vec3::Zero()), rendered).counts());
}

// A motion whose exchange is refused would be flown with another tool, unnoticed.
TEST(HapticTruthCommands, ARefusedOneIsAnErrorThatSaysWhatAndWhen) {
  test::SceneFolder folder;
  folder.write("motion.csv",
               "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n0,command,exchange,right "
               "nothing\n0,right,0,0,0,1,0,0,0,0,0\n1,right,0,0,0,1,0,0,0,0,0\n");
  const Motion motion = load_motion(folder.path() / "motion.csv");
  auto simulation = fissure(1.0 / 30);
  ASSERT_TRUE(simulation);
  try {
    record_steps(*simulation, motion, 0.1);
    FAIL() << "nothing was said";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("at 0.000 s of the motion, with a step of 33.3 ms, its command \"exchange\" "
                                         "is refused: no tool \"nothing\""),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace insula
