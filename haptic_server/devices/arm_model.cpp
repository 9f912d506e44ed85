// SPDX-License-Identifier: GPL-3.0-or-later
// Integration of the simulated arm and hand.
#include "haptic_server/devices/arm_model.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double two_pi = 6.283185307179586;

/// Sum of two sines with a total amplitude `a`. It starts at 0, so that a placed arm is at rest.
double tremor(double t, double a, int axis, int seed) {
  const double slow = 8.3 + 0.37 * axis + 0.11 * seed;
  const double fast = 11.1 + 0.29 * axis + 0.07 * seed;
  return a * (0.6 * std::sin(two_pi * slow * t) + 0.4 * std::sin(two_pi * fast * t));
}

Vec3 tremor3(double t, double a, int first_axis, int seed) {
  return {tremor(t, a, first_axis, seed), tremor(t, a, first_axis + 1, seed), tremor(t, a, first_axis + 2, seed)};
}

bool finite(const Vec3& v) { return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()); }

}  // namespace

DeviceProfile omni_profile() {
  DeviceProfile p;
  p.name = "simulated";
  p.max_force_N = 3.3;
  p.max_slew_N_s = 66;
  p.max_torque_Nm = 0;
  p.max_slew_Nm_s = 0;
  p.resolution_m = 55e-6;
  p.workspace_m = Vec3(0.160, 0.120, 0.070);
  return p;
}

void ArmModel::place(const Pose& pose, const Vec3& centre, const Vec3& extent) {
  low_ = centre - 0.5 * extent;
  high_ = centre + 0.5 * extent;
  pose_ = pose;
  goal_ = HandGoal{};
  goal_.pose = pose;
  v_.setZero();
  w_.setZero();
  force_.setZero();
  torque_.setZero();
  time_ = 0;
}

void ArmModel::set_load(const Vec3& force_N, const Vec3& torque_Nm) {
  force_ = finite(force_N) ? force_N : Vec3(Vec3::Zero());
  torque_ = finite(torque_Nm) ? torque_Nm : Vec3(Vec3::Zero());
}

void ArmModel::step(double dt) {
  if (!(dt > 0)) return;
  time_ += dt;
  const Vec3 x_goal = goal_.pose.p + tremor3(time_, p_.tremor_m, 0, p_.tremor_seed);
  const Quat q_goal = from_rotation_vector(tremor3(time_, p_.tremor_rad, 3, p_.tremor_seed)) * goal_.pose.q;

  // (m + dt c + dt^2 k) v' = m v + dt (k (x_goal - x) + c v_goal + F)
  const double m = p_.arm_mass_kg + p_.hand_mass_kg, k = p_.hand_stiffness_N_m, c = p_.hand_damping_Ns_m;
  Vec3 momentum = m * v_ + dt * (k * (x_goal - pose_.p) + c * goal_.v + force_);
  if (p_.arm_friction_N > 0) {
    // Coulomb friction removes at most the present momentum. It never drives the arm.
    const double size = momentum.norm(), most = p_.arm_friction_N * dt;
    momentum *= size > most ? 1 - most / size : 0;
  }
  v_ = momentum / (m + dt * c + dt * dt * k);
  pose_.p += dt * v_;

  const double j = p_.inertia_kgm2, kr = p_.hand_stiffness_Nm_rad, cr = p_.hand_damping_Nms_rad;
  const Vec3 turn = rotation_vector(q_goal * pose_.q.conjugate());
  w_ = (j * w_ + dt * (kr * turn + cr * goal_.w + torque_)) / (j + dt * cr + dt * dt * kr);
  pose_.q = (from_rotation_vector(dt * w_) * pose_.q).normalized();

  if (goal_.stops) stop_at_walls();
}

void ArmModel::stop_at_walls() {
  for (int i = 0; i < 3; ++i) {
    const double inside = std::clamp(pose_.p[i], low_[i], high_[i]);
    if (inside == pose_.p[i]) continue;
    pose_.p[i] = inside;
    v_[i] = 0;  // an inelastic stop
  }
}

double ArmModel::energy() const {
  const double m = p_.arm_mass_kg + p_.hand_mass_kg;
  const Vec3 turn = rotation_vector(goal_.pose.q * pose_.q.conjugate());
  return 0.5 * (m * v_.squaredNorm() + p_.inertia_kgm2 * w_.squaredNorm() +
                p_.hand_stiffness_N_m * (goal_.pose.p - pose_.p).squaredNorm() +
                p_.hand_stiffness_Nm_rad * turn.squaredNorm());
}

void EncoderTracker::reset(const Vec3& x) {
  x_ = x;
  v_.setZero();
}

void EncoderTracker::update(const Vec3& measured, double dt) {
  if (!(dt > 0)) return;
  x_ += dt * v_;
  const Vec3 r = measured - x_;
  x_ += alpha * r;
  v_ += (beta / dt) * r;
}

}  // namespace insula
