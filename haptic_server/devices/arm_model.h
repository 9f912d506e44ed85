// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated haptic arm held by a simulated hand, for use without device and person.
#pragma once
#include "haptic_server/devices/device.h"

namespace insula {

/// Arm and hand as one rigid body that a spring and damper tie to the goal of the hand:
///   m v'  = k (x_goal - x) + c (v_goal - v) + F          m = apparent mass of the arm + mass of the hand
///   J w'  = k_r r(q -> q_goal) + c_r (w_goal - w) + T    r: rotation vector
/// Under a constant force F it comes to rest at a distance F / k from its goal.
struct ArmParameters {
  DeviceProfile profile;
  double arm_mass_kg = 0.045;  ///< apparent mass at the tip
  double arm_friction_N = 0;   ///< Coulomb friction of the arm, backdrive
  double hand_mass_kg = 0.08;  ///< hand and fingers that move with it
  double hand_stiffness_N_m = 400;
  double hand_damping_Ns_m = 10;  ///< ratio 0.7 with the masses above
  double inertia_kgm2 = 1e-4;
  double hand_stiffness_Nm_rad = 1.0;
  double hand_damping_Nms_rad = 0.014;
  /// Amplitudes of the physiological tremor of a resting hand: two incommensurate frequencies between 8 and 12 Hz on
  /// each axis.
  double tremor_m = 0;
  double tremor_rad = 0;
  int tremor_seed = 0;  ///< sets the phases, so that two hands differ
};

/// The limits of a Phantom Omni (maker's data sheet): 160 x 120 x 70 mm, 3.3 N, 0.055 mm, 45 g, 0.26 N backdrive
/// friction, forces in three axes and no torques. Friction is not included here and can be set in ArmParameters.
DeviceProfile omni_profile();

/// State and integration. Deterministic: the same calls give the same bits.
class ArmModel {
 public:
  explicit ArmModel(const ArmParameters& parameters) : p_(parameters) {}

  /// Puts the arm at rest at `pose`, which is also the goal. The mechanical stops form a box around `centre` with edges
  /// `extent`.
  void place(const Pose& pose, const Vec3& centre, const Vec3& extent);
  void set_goal(const HandGoal& goal) { goal_ = goal; }
  void set_load(const Vec3& force_N, const Vec3& torque_Nm);
  /// One step of implicit Euler for spring and damper (stable for any dt > 0), with an explicit load.
  void step(double dt);

  const Pose& pose() const { return pose_; }
  const Vec3& v() const { return v_; }
  const Vec3& w() const { return w_; }
  const HandGoal& goal() const { return goal_; }
  /// Kinetic energy and energy of the hand's springs towards the goal, J.
  double energy() const;
  const ArmParameters& parameters() const { return p_; }

 private:
  void stop_at_walls();

  ArmParameters p_;
  HandGoal goal_;
  Pose pose_;
  Vec3 v_ = Vec3::Zero(), w_ = Vec3::Zero();
  Vec3 force_ = Vec3::Zero(), torque_ = Vec3::Zero();
  Vec3 low_ = Vec3::Constant(-1e9), high_ = Vec3::Constant(1e9);
  double time_ = 0;
};

/// Position and velocity from a quantised encoder by an alpha-beta tracker (g-h filter). It follows a constant velocity
/// without lag and interpolates between counts, as a device's driver does to obtain a velocity.
class EncoderTracker {
 public:
  void reset(const Vec3& x);
  void update(const Vec3& measured, double dt);
  const Vec3& x() const { return x_; }
  const Vec3& v() const { return v_; }

 private:
  static constexpr double alpha = 0.4;
  static constexpr double beta = alpha * alpha / (2 - alpha);  // critically damped (Benedict and Bordner 1962)
  Vec3 x_ = Vec3::Zero(), v_ = Vec3::Zero();
};

}  // namespace insula
