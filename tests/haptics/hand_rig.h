// SPDX-License-Identifier: GPL-3.0-or-later
// A person's arm against something hard, in simulated time: engine at its rate, servo at 1 kHz, gate, encoder, arm and
// hand. For comparison, the servo's force may be held between problems, as by solvers without a haptic loop.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "core/haptics/surface_patch_builder.h"
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
  bool soft = false;  ///< a block of brain tissue in place of the plate, with patches and a reduced model
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
  int modelled = 0;                        ///< problems with a reduced model
};

inline std::string scene_of(const Press& press) {
  const std::string plate = R"(<obstacle id="target"><surface id="top" mesh="../../meshes/examples/plate.obj"
    mesh_unit="mm"/></obstacle>)";
  const std::string block = R"(<soft_body id="target" mesh="../../meshes/examples/block.msh" mesh_unit="mm">
    <corotational_fem young="2.1 kPa" poisson="0.45" rayleigh_stiffness="20 ms"/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface id="top"/></soft_body>)";
  return "<scene title=\"press\" time_step=\"" + std::to_string(1000 / press.engine_Hz) + " ms\">" +
         (press.soft ? block : plate) + R"(<dissector id="tool" hand="right" sharp="never"
    model="../../meshes/instruments/dissector/dissector.urdf" shaft="0 0 1" flat="1 0 0" home=")" +
         (press.soft ? "0 0 1.2 mm" : "0 0 -19 mm") + R"(" coupling=")" + std::to_string(press.coupling_N_m) +
         R"( N/m"/><contact between="target tool" friction="0.1" spacing="1 mm" max_contacts="10"/></scene>)";
}

inline ArmParameters arm_of(const Person& person) {
  ArmParameters p = simulated_arm(1);
  p.tremor_m = p.tremor_rad = 0;
  p.arm_friction_N = person.friction_N;
  p.hand_mass_kg = person.mass_kg - p.arm_mass_kg;
  p.hand_damping_Ns_m = person.damping_Ns_m;
  p.hand_stiffness_N_m = person.stiffness_N_m;
  return p;
}

constexpr double press_begin = 0.5, press_arrival = 0.3;  ///< s

/// The pose that the person wants at time t. After the gate has faded forces in, the hand arrives within a third of a
/// second, at the speed of a tap.
inline HandGoal goal_at(double t, const Press& press, const Pose& home) {
  const double top = press.soft ? 0 : -20.2e-3;
  HandGoal goal;
  goal.pose = home;
  const double part = std::clamp((t - press_begin) / press_arrival, 0.0, 1.0);
  goal.pose.p.z() += part * (top - press.depth_m - home.p.z());
  goal.v.z() = part > 0 && part < 1 ? (top - press.depth_m - home.p.z()) / press_arrival : 0;
  if (t > press_begin) {
    goal.pose.p.x() += press.slide_m_s * (t - press_begin);
    goal.v.x() = press.slide_m_s;
  }
  goal.stops = false;
  return goal;
}

/// The engine at its rate. It gives the servo its problems, immediately or a step late.
class PressEngine {
 public:
  PressEngine(Simulation& s, const Press& press) : s_(s), press_(press), next_step_(1 / press.engine_Hz) {}
  /// Makes a step if one is due. Returns whether it made a problem.
  bool advance(double t, const Pose& device, Servo& servo) {
    if (t + 1e-9 < next_step_) return false;
    const double h = 1 / press_.engine_Hz;
    next_step_ += h;
    s_.set_hand(1, {true, device, false, false});
    s_.step();
    const std::size_t made = (newest_ + 1) % problem_.size(), older = newest_;
    problem_[made] = press_.soft ? build_(s_, 200) : s_.problem();
    if (press_.soft) build_.compute_modes();
    modelled_ += !problem_[made].reduced.empty();
    newest_ = made;
    if (!press_.late) servo.set_problem(&problem_[made]);
    else if (s_.steps() > 1) servo.set_problem(&problem_[older], {}, h);
    return true;
  }
  int modelled() const { return modelled_; }

 private:
  Simulation& s_;
  const Press& press_;
  double next_step_;
  std::array<ConstraintProblem, 3> problem_;
  std::size_t newest_ = 0;
  SurfacePatchBuilder build_;
  int modelled_ = 0;
};

/// Records speeds, heights and force in the first and in the last second of contact.
class PressRecord {
 public:
  explicit PressRecord(int ticks) : ticks_(ticks) {}
  void add(int tick, double t, double speed, double z, double force) {
    if (t >= press_begin + press_arrival && t < press_begin + press_arrival + 1)
      first2_ += speed * speed, ++first_count_;
    if (tick < ticks_ - 1000) return;
    last2_ += speed * speed, ++last_count_;
    low_ = std::min(low_, z), high_ = std::max(high_, z);
    force_ += force / 1000;
    at_ += z / 1000;
  }
  void write(Pressed& out) const {
    out.first_speed = std::sqrt(first2_ / std::max(1, first_count_));
    out.last_speed = std::sqrt(last2_ / std::max(1, last_count_));
    out.swing = high_ - low_;
    out.force = force_;
    out.at = at_;
  }

 private:
  int ticks_, first_count_ = 0, last_count_ = 0;
  double first2_ = 0, last2_ = 0, low_ = 1e9, high_ = -1e9, force_ = 0, at_ = 0;
};

inline Pressed press(const Press& press, const Person& person) {
  Pressed out;
  const auto s = load_text(scene_of(press), std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/contact/plate.xml");
  if (!s) return out;
  s->set_collision_horizon(2 * s->h());
  const ArmParameters arm = arm_of(person);
  SimulatedDevice device(arm);
  SafetyGate gate(arm.profile);
  Servo servo(press.servo);
  PassivityObserver observer;
  const Pose home = s->instrument_of(1)->home_pose();
  device.place(home, home.p, Vec3::Constant(1));
  PressEngine engine(*s, press);
  Vec3 held = Vec3::Zero();
  const int ticks = int(std::lround(press.seconds * 1000));
  const double dt = 1e-3;
  PressRecord record(ticks);
  for (int k = 0; k < ticks; ++k) {
    const double t = k * dt;
    device.guide(goal_at(t, press, home));
    const Vec3 before = device.arm().pose().p;
    device.advance(dt);
    const DeviceReading reading = device.read();
    ServoInput input;
    input.device[1] = reading.pose;
    input.connected[1] = true;
    const bool fresh = engine.advance(t, reading.pose, servo);
    const ServoResult r = servo.tick(input);
    const ServoHand& hand = r.hand[1];
    if (fresh) held = hand.force;
    const Vec3 moved = device.arm().pose().p - before;
    // What the last tick's force has done on the motion of this tick.
    out.last_energy += gate.force().dot(moved);
    observer.observe(gate.force(), reading.pose.p);
    gate.apply(dt, r.solved && hand.valid, press.held ? held : hand.force, Vec3::Zero());
    device.write(gate.force(), Vec3::Zero());
    out.max_energy = std::max(out.max_energy, out.last_energy);
    record.add(k, t, moved.z() / dt, device.arm().pose().p.z(), gate.force().z());
  }
  out.observed = observer.most();
  out.modelled = engine.modelled();
  record.write(out);
  return out;
}

}  // namespace insula::test
