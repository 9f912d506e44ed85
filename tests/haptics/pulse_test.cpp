// SPDX-License-Identifier: GPL-3.0-or-later
// A fingertip on an artery feels it beat: every beat, smoothly, and as strongly as the engine itself says.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/testing/example.h"
#include "haptic_server/servo.h"

namespace insula::test {
namespace {

/// A dissector that lies still against the dome of an aneurysm; force along it every millisecond, N.
std::vector<double> on_the_dome(double rate_per_min, const ServoSettings& settings, std::vector<double>& engine) {
  const Vec3 top(52.012e-3, 15.325e-3, -6.586e-3),
      out = Vec3(0.86411434, -0.03014352, 0.50239206).normalized();  // apex, and away from the neck
  const Vec3 home = 1000 * (top + 0.1e-3 * out);
  char text[1500];
  std::snprintf(text, sizeof text, R"(<scene title="pulse">
    <shell_body id="artery" wall="meshes/arteries/narrow_neck/vessel.json">
      <membrane thickness="0.3 mm" young="1 MPa"/>
      <anchor_springs stiffness="2000000 N/m3"/>
      <surface id="wall" material="vessel"/>
    </shell_body>
    <pressure id="pressure" on="artery" systolic="120 mmHg" diastolic="80 mmHg" imaged_at="93 mmHg" heart_rate="%g 1/min"/>
    <dissector id="tool" hand="right" sharp="never" model="meshes/instruments/dissector/dissector.urdf" coupling="250 N/m"
               home="%.6f %.6f %.6f mm" shaft="%.8f %.8f %.8f" flat="0 1 0"/>
    <contact between="artery tool" friction="0.1" spacing="1 mm" max_contacts="10"/></scene>)",
                rate_per_min, home.x(), home.y(), home.z(), out.x(), out.y(), out.z());
  const auto s = load_text(text, std::filesystem::path(INSULA_SOURCE_DIR) / "pulse.xml");
  std::vector<double> rendered;
  if (!s) return rendered;
  Pose device = s->instrument_of(1)->home_pose();
  Servo servo(settings);
  std::array<ConstraintProblem, 2> problem;
  const double beat = 60 / rate_per_min;
  for (int step = 0; s->time() < 5 * beat; ++step) {
    // In within a second, then still.
    const double distance = std::min(1.0, s->time() / 1.0) * 0.4e-3;
    Pose now = device;
    now.p -= distance * out;
    s->set_hand(1, {true, now, false, false});
    s->step();
    ConstraintProblem& latest = problem[std::size_t(step % 2)];
    latest = s->problem();
    servo.set_problem(&latest, {}, s->h());
    ServoInput in;
    in.device[1] = now;
    in.connected[1] = true;
    const int ticks = int(std::lround(1000 * s->h()));
    for (int k = 0; k < ticks; ++k) {
      const ServoHand hand = servo.tick(in).hand[1];
      if (s->time() < 3 * beat) continue;
      rendered.push_back(hand.force.dot(out));
      engine.push_back(s->instrument_of(1)->hand_force().head<3>().dot(out));
    }
  }
  return rendered;
}

/// Amplitude of the part of a signal that goes round `times` over its length.
double amplitude(const std::vector<double>& x, int times) {
  double c = 0, s = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = 2 * std::numbers::pi * times * double(i) / double(x.size());
    c += x[i] * std::cos(a);
    s += x[i] * std::sin(a);
  }
  return 2 * std::hypot(c, s) / double(x.size());
}

TEST(Pulse, AFingertipFeelsEveryBeat) {
  for (const double rate : {60.0, 90.0}) {
    std::vector<double> engine;
    const std::vector<double> rendered = on_the_dome(rate, ServoSettings::beyond_equation_7(), engine);
    ASSERT_FALSE(rendered.empty());
    // Two beats: what goes round twice is the pulse.
    const double pulse = amplitude(rendered, 2), between = amplitude(rendered, 1) + amplitude(rendered, 3);
    EXPECT_GT(pulse, 1e-3) << "N, at " << rate << " a minute";
    EXPECT_GT(pulse, 3 * between);
    EXPECT_NEAR(pulse, amplitude(engine, 2), 0.1 * pulse);
    // No staircase: the largest change in a millisecond is a small part of the beat, that of the engine's steps is not.
    double most = 0, step = 0, low = rendered[0], high = rendered[0];
    for (std::size_t i = 1; i < rendered.size(); ++i) {
      most = std::max(most, std::abs(rendered[i] - rendered[i - 1]));
      step = std::max(step, std::abs(engine[i] - engine[i - 1]));
      low = std::min(low, rendered[i]);
      high = std::max(high, rendered[i]);
    }
    EXPECT_LT(most, 0.04 * (high - low));
    EXPECT_GT(step, 3 * most);
  }
}

}  // namespace
}  // namespace insula::test
