// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic loop in simulated time.
#include "haptic_server/in_process.h"

#include <algorithm>

#include "haptic_server/devices/make_device.h"

namespace insula {

InProcessHaptics::InProcessHaptics(const Motion& motion, const std::array<Home, 2>& home, const ServoSettings& settings)
    : InProcessHaptics(motion, home, settings, {simulated_arm(0), simulated_arm(1)}) {}

InProcessHaptics::InProcessHaptics(const Motion& motion, const std::array<Home, 2>& home, const ServoSettings& settings,
                                   const std::array<ArmParameters, 2>& arms)
    : motion_(motion),
      home_(home),
      device_{SimulatedDevice(arms[0]), SimulatedDevice(arms[1])},
      gate_{SafetyGate(arms[0].profile), SafetyGate(arms[1].profile)},
      servo_(settings) {
  reset();
}

void InProcessHaptics::reset() {
  servo_.set_problem(nullptr);
  servo_.reset();
  last_ = ServoResult{};
  time_ = problem_time_ = 0;
  ticks_ = 0;
  started_ = false;
  for (std::size_t i = 0; i < 2; ++i) {
    hands_[i] = Hand{};
    last_force_[i].setZero();
    gate_[i] = SafetyGate(device_[i].profile());
    const bool scripted = motion_.has(int(i));
    if (!scripted && !home_[i].present) continue;
    const Pose start = scripted ? motion_.at(int(i), 0).pose : home_[i].pose;
    Vec3 centre, extent;
    lay_workspace(scripted ? &motion_ : nullptr, int(i), home_[i].present ? home_[i].pose.p : start.p,
                  device_[i].profile().workspace_m, centre, extent);
    device_[i].place(start, centre, extent);
    guide_[i].place(start);
    hands_[i].present = true;
    hands_[i].device = start;
  }
}

void InProcessHaptics::set_problem(const ConstraintProblem& problem, const std::array<bool, 2>& left_out) {
  const std::size_t next = 1 - current_;
  problem_[next] = problem;
  std::erase_if(problem_[next].tools, [&](const ToolTerms& t) { return left_out[t.hand == 1 ? 1 : 0]; });
  servo_.set_problem(&problem_[next]);
  current_ = next;
  problem_time_ = time_;
}

void InProcessHaptics::tick(double t) {
  const double dt = started_ ? t - time_ : 1e-3;
  if (!(dt > 0)) return;
  started_ = true;
  time_ = t;
  ++ticks_;

  ServoInput input;
  input.dt_s = dt;
  std::array<DeviceReading, 2> reading;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!hands_[i].present) continue;
    HandSample wish = motion_.has(int(i)) ? motion_.at(int(i), t) : HandSample{home_[i].pose, false, false};
    device_[i].guide(guide_[i].advance(dt, wish));
    device_[i].advance(dt);
    reading[i] = device_[i].read();
    input.device[i] = reading[i].pose;
    input.connected[i] = true;
  }
  last_ = servo_.tick(input);
  const bool recent = t - problem_time_ <= SafetyGate::stale_after_s;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!hands_[i].present) continue;
    Hand& hand = hands_[i];
    const ServoHand& wanted = last_.hand[i];
    const bool live = last_.solved && wanted.valid && recent;
    gate_[i].apply(dt, live, wanted.force, wanted.torque);
    device_[i].write(gate_[i].force(), gate_[i].torque());
    hand.device = reading[i].pose;
    hand.v = reading[i].v;
    hand.button1 = reading[i].button1;
    hand.button2 = reading[i].button2;
    hand.force = gate_[i].force();
    hand.torque = gate_[i].torque();
    hand.max_force_N = std::max(hand.max_force_N, hand.force.norm());
    if (live && wanted.force != last_force_[i]) ++hand.fresh_forces;
    if (!wanted.force.isZero(0) || !last_force_[i].isZero(0)) hand.touching_s += dt;
    last_force_[i] = wanted.force;
  }
}

void InProcessHaptics::advance(int ticks, double dt) {
  const double start = time_;
  for (int k = 1; k <= ticks; ++k) tick(start + k * dt);
}

double InProcessHaptics::fresh_forces_per_s() const {
  double least = -1;
  for (const Hand& hand : hands_) {
    if (!hand.present || !(hand.touching_s > 0)) continue;
    const double rate = double(hand.fresh_forces) / hand.touching_s;
    least = least < 0 ? rate : std::min(least, rate);
  }
  return std::max(least, 0.0);
}

}  // namespace insula
