// SPDX-License-Identifier: GPL-3.0-or-later
// The virtual coupling of a tool.
//   A dq = Kc disp(tool, device) + (D/h) disp(last device, device) + M v/h,   A = M/h^2 + D/h + Kc,  D = coupling_time
//   Kc
// so the free tool follows the device as dq_free' = dq_free + A^-1 (Kc + D/h) (x_dev' - x_dev): the gain of equation 7.
#include "core/mechanics/instrument.h"

#include <Eigen/LU>

#include "core/base/input_error.h"

namespace insula {

void Instrument::prepare(PrepareContext& context) {
  try {
    tool_ = read_tool(model());
  } catch (const InputError& e) {
    return error(context, model, e.what());
  }
  if (shaft().norm() < 1e-9) return error(context, shaft, "shaft: a direction must not be zero");
  if (shaft().cross(flat()).norm() < 1e-6 * shaft().norm())
    return error(context, flat, "flat: must not be parallel to the shaft");
  Instrument::reset();
}

Pose Instrument::home_pose() const {
  const Vec3 z = shaft().normalized();
  const Vec3 x = (flat() - flat().dot(z) * z).normalized();
  Mat3 r;
  r << x, z.cross(x), z;
  return {home(), Quat(r).normalized()};
}

void Instrument::reset() {
  active_ = in_hand_at_start_;
  pose_ = device_ = last_device_ = free_pose_ = hand_index() < 0 ? arm_pose(-infinite) : home_pose();
  velocity_.setZero();
  free_dq_.setZero();
  hand_force_.setZero();
  hand_state_ = {};
}

void Instrument::take_up(const Pose& device) {
  reset();
  pose_ = device_ = last_device_ = free_pose_ = device;
  active_ = true;
}

void Instrument::lay_down() {
  reset();
  active_ = false;
}

MaterialPoint Instrument::point(const Vec3& scene_position) const {
  MaterialPoint p;
  p.body = const_cast<Instrument*>(this);
  p.local = pose_.q.conjugate() * (scene_position - pose_.p);
  return p;
}

Vec3 Instrument::free_displacement(const MaterialPoint& p) const {
  return free_dq_.head<3>() + free_dq_.tail<3>().cross(pose_.q * p.local);
}

void Instrument::add_row(BodyRows& out, const MaterialPoint& p, const Vec3& d) const {
  out.add(0, d);
  out.add(1, (pose_.q * p.local).cross(d));
}

void Instrument::free_motion(const StepContext& context) {
  const double h = context.h;
  last_device_ = device_;
  if (hand_index() < 0) device_ = arm_pose(context.time + h);
  else if (hand_state_.present) device_ = hand_state_.device;
  stiffness_.setZero();
  stiffness_.topLeftCorner<3, 3>().diagonal().setConstant(coupling());
  stiffness_.bottomRightCorner<3, 3>().diagonal().setConstant(angular_coupling());
  const Mat6 follow = (1 + coupling_time() / h) * stiffness_;
  Mat6 a = follow;
  Vec6 b = stiffness_ * displacement(pose_, device_) +
           (coupling_time() / h) * stiffness_ * displacement(last_device_, device_);
  if (mass() > 0) {
    // Inertia of the model about the tip, scaled to the mass of the parameter.
    const double m = mass(), scale = m / tool_.mass;
    const Mat3 r = pose_.q.toRotationMatrix();
    const Vec3 c = r * tool_.centre_of_mass;
    Mat6& inertia = inertia_;
    inertia.setZero();
    inertia.topLeftCorner<3, 3>().diagonal().setConstant(m);
    inertia.topRightCorner<3, 3>() = -m * skew(c);
    inertia.bottomLeftCorner<3, 3>() = m * skew(c);
    inertia.bottomRightCorner<3, 3>() = scale * r * tool_.inertia * r.transpose() - m * skew(c) * skew(c);
    a += inertia / (h * h);
    b += inertia * velocity_ / h;
  }
  if (mass() > 0) {
    compliance_ = a.inverse();
    compliance_ = (0.5 * (compliance_ + compliance_.transpose())).eval();
    gain_ = compliance_ * follow;
  } else {
    compliance_.setZero();
    compliance_.diagonal() = a.diagonal().cwiseInverse();
    gain_.setIdentity();
  }
  free_dq_ = compliance_ * b;
  free_pose_ = displaced(pose_, free_dq_);
}

void Instrument::add_response(const BodyRows& r, double* w, int stride, double* delta_free) {
  const int m = r.count();
  auto row = [&](int i) {
    Vec6 j = Vec6::Zero();
    for (int e = r.start[std::size_t(i)]; e < r.start[std::size_t(i) + 1]; ++e)
      j.segment<3>(3 * r.block[std::size_t(e)]) += r.coeff[std::size_t(e)];
    return j;
  };
  for (int i = 0; i < m; ++i) {
    const Vec6 y = compliance_ * row(i);
    for (int j = 0; j <= i; ++j) {
      const double v = y.dot(row(j));
      const std::size_t a = std::size_t(r.row[std::size_t(i)]), b = std::size_t(r.row[std::size_t(j)]);
      w[a * std::size_t(stride) + b] += v;
      if (a != b) w[b * std::size_t(stride) + a] += v;
    }
  }
  for (int i = 0; i < m; ++i)
    for (int e = r.start[std::size_t(i)]; e < r.start[std::size_t(i) + 1]; ++e)
      delta_free[r.row[std::size_t(i)]] +=
          r.coeff[std::size_t(e)].dot(free_dq_.segment<3>(3 * r.block[std::size_t(e)]));
}

void Instrument::apply(const StepContext& context, const BodyRows& r, const double* lambda) {
  Vec6 f = Vec6::Zero();
  for (int i = 0; i < r.count(); ++i)
    for (int e = r.start[std::size_t(i)]; e < r.start[std::size_t(i) + 1]; ++e)
      f.segment<3>(3 * r.block[std::size_t(e)]) += lambda[r.row[std::size_t(i)]] * r.coeff[std::size_t(e)];
  const Vec6 correction = compliance_ * f;
  // The correction is applied to the free pose, as in the haptic loop.
  const Pose before = pose_;
  pose_ = displaced(free_pose_, correction);
  velocity_ = displacement(before, pose_) / context.h;
  hand_force_ = stiffness_ * displacement(device_, pose_);
}

void Instrument::fill_terms(ToolTerms& t, int problem_rows) const {
  t.hand = hand_index();
  t.device = device_;
  t.swept_displacement = device_.p - last_device_.p;
  t.free = free_pose_;
  t.gain = gain_;
  t.compliance = compliance_;
  t.stiffness = stiffness_;
  t.jacobian.setZero(problem_rows, 6);
  for (int i = 0; i < rows.count(); ++i)
    for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
      t.jacobian.block<1, 3>(rows.row[std::size_t(i)], 3 * rows.block[std::size_t(e)]) +=
          rows.coeff[std::size_t(e)].transpose();
}

double Instrument::energy() const {
  if (!active_) return 0;
  const Vec6 d = displacement(device_, pose_);
  return 0.5 * d.dot(stiffness_ * d) + 0.5 * velocity_.dot(inertia_ * velocity_);
}

void Instrument::append_state(std::vector<double>& out) const {
  out.insert(out.end(), {pose_.p.x(), pose_.p.y(), pose_.p.z(), pose_.q.w(), pose_.q.x(), pose_.q.y(), pose_.q.z()});
  for (int i = 0; i < 6; ++i) out.push_back(velocity_[i]);
  out.push_back(active_);
}

}  // namespace insula
