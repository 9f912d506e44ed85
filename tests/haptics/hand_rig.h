// SPDX-License-Identifier: GPL-3.0-or-later
// A person's arm against something hard, in simulated time: engine at its rate, servo at 1 kHz, gate, encoder, arm and
// hand. For comparison, the servo's force may be held between problems, as by solvers without a haptic loop.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "core/testing/example.h"
#include "haptic_server/devices/make_device.h"
#include "haptic_server/devices/simulated.h"
#include "haptic_server/passivity.h"
#include "haptic_server/safety_gate.h"
#include "haptic_server/servo.h"

namespace insula::test {

/// Device and hand together, as one mass on the person's spring and damper.
struct Person {
  double mass_kg = 0.125, damping_Ns_m = 10, stiffness_N_m = 400;
  /// Friction of the device: a tenth of that of the best arms. Without friction, an encoder's steps keep a tool on a
  /// wall trembling by less than a step. Friction above stiffness x step / 2, here 14 mN, ends this (Abbott and Okamura
  /// 2005).
  double friction_N = 0.02;
};

struct Press {
  double coupling_N_m = 250;
  double engine_Hz = 60;
  double depth_m = 2e-3;  ///< the goal lies so deep in the plate
  double slide_m_s = 0;   ///< and goes along it
  double seconds = 5;
  bool held = false;  ///< the force of a tick in which a problem came stays until the next one
  bool late = true;   ///< a problem reaches the servo a step after the poses it was made with, as from an engine that
                      ///< only just keeps up
  ServoSettings servo = ServoSettings::beyond_equation_7();
};

struct Pressed {
  double first_speed = 0, last_speed = 0;  ///< rms of the arm across the plate, first and last second of contact, m/s
  double swing = 0;                        ///< largest less smallest height in the last second, m
  double max_energy = 0;                   ///< that the hand was ever given, all it had given before taken off, J
  double last_energy = 0;                  ///< at the end
  double observed = 0;                     ///< the observer's own largest
  double force = 0;                        ///< mean at the end, N
  double at = 0;                           ///< mean height at the end, m
};

inline Pressed press(const Press& press, const Person& person) {
  constexpr double top = -20.2e-3, begin = 0.5, arrival = 0.3;
  const std::string text = "<scene title=\"plate\" time_step=\"" + std::to_string(1000 / press.engine_Hz) + R"( ms">
    <obstacle id="plate"><surface id="top" mesh="../../meshes/examples/plate.obj" mesh_unit="mm"/></obstacle>
    <dissector id="tool" hand="right" sharp="never" model="../../meshes/instruments/dissector/dissector.urdf" home="0 0 -19 mm" shaft="0 0 1" flat="1 0 0" coupling=")" +
                           std::to_string(press.coupling_N_m) + R"( N/m"/>
    <contact between="plate tool" friction="0.1" spacing="1 mm" max_contacts="10"/></scene>)";
  Pressed out;
  const auto s = load_text(text, std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/contact/plate.xml");
  if (!s) return out;
  s->set_collision_horizon(2 * s->h());
  ArmParameters p = simulated_arm(1);
  p.tremor_m = p.tremor_rad = 0;
  p.arm_friction_N = person.friction_N;
  p.hand_mass_kg = person.mass_kg - p.arm_mass_kg;
  p.hand_damping_Ns_m = person.damping_Ns_m;
  p.hand_stiffness_N_m = person.stiffness_N_m;
  SimulatedDevice device(p);
  SafetyGate gate(p.profile);
  Servo servo(press.servo);
  PassivityObserver observer;
  const Pose home = s->instrument_of(1)->home_pose();
  device.place(home, home.p, Vec3::Constant(1));
  std::array<ConstraintProblem, 3> problem;
  std::size_t newest = 0;
  Vec3 held = Vec3::Zero();
  const int ticks = int(std::lround(press.seconds * 1000));
  const double dt = 1e-3, h = 1 / press.engine_Hz;
  double next_step = h, energy = 0, low = 1e9, high = -1e9;
  double first2 = 0, last2 = 0;
  int first_count = 0, last_count = 0;
  for (int k = 0; k < ticks; ++k) {
    const double t = k * dt;
    HandGoal goal;
    goal.pose = home;
    // After the gate has faded forces in, the hand arrives within a third of a second, at the speed of a tap.
    const double part = std::clamp((t - begin) / arrival, 0.0, 1.0);
    goal.pose.p.z() += part * (top - press.depth_m - home.p.z());
    goal.v.z() = part > 0 && part < 1 ? (top - press.depth_m - home.p.z()) / arrival : 0;
    if (t > begin) {
      goal.pose.p.x() += press.slide_m_s * (t - begin);
      goal.v.x() = press.slide_m_s;
    }
    goal.stops = false;
    device.guide(goal);
    const double z_before = device.arm().pose().p.z();
    const Vec3 before = device.arm().pose().p;
    device.advance(dt);
    const DeviceReading reading = device.read();
    ServoInput input;
    input.device[1] = reading.pose;
    input.connected[1] = true;
    bool fresh = false;
    if (t + 1e-9 >= next_step) {
      next_step += h;
      s->set_hand(1, {true, reading.pose, false, false});
      s->step();
      const std::size_t made = (newest + 1) % problem.size(), older = newest;
      problem[made] = s->problem();
      newest = made;
      if (!press.late) servo.set_problem(&problem[made]);
      else if (s->steps() > 1) servo.set_problem(&problem[older], {}, h);
      fresh = true;
    }
    const ServoResult r = servo.tick(input);
    const ServoHand& hand = r.hand[1];
    if (fresh) held = hand.force;
    const Vec3 wanted = press.held ? held : hand.force;
    // Work of the last tick's force over this tick's displacement.
    energy += gate.force().dot(device.arm().pose().p - before);
    observer.observe(gate.force(), reading.pose.p);
    gate.apply(dt, r.solved && hand.valid, wanted, Vec3::Zero());
    device.write(gate.force(), Vec3::Zero());
    out.max_energy = std::max(out.max_energy, energy);
    const double speed = (device.arm().pose().p.z() - z_before) / dt;
    if (t >= begin + arrival && t < begin + arrival + 1) first2 += speed * speed, ++first_count;
    if (k >= ticks - 1000) {
      last2 += speed * speed, ++last_count;
      low = std::min(low, device.arm().pose().p.z()), high = std::max(high, device.arm().pose().p.z());
      out.force += gate.force().z() / 1000;
      out.at += device.arm().pose().p.z() / 1000;
    }
  }
  out.observed = observer.most();
  out.last_energy = energy;
  out.first_speed = std::sqrt(first2 / std::max(1, first_count));
  out.last_speed = std::sqrt(last2 / std::max(1, last_count));
  out.swing = high - low;
  return out;
}

}  // namespace insula::test
