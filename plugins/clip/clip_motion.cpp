// SPDX-License-Identifier: GPL-3.0-or-later
// The clip's equation of motion. Degrees of freedom of the rows: translation of the tip (the frame's origin), rotation
// vector, (opening, 0, 0). Internally, translation is that of the centre of mass, where it is decoupled from rotation:
//   m (1/h^2 + drag/h) dc = f + m v/h,   J (1/h^2 + drag/h) dr = t + L/h,   (I (1/h^2 + drag/h) + (1 + hinge_time/h) 2
//   dT/do) do = -2 T + I w/h
// The state is L = J dr/h instead of the angular velocity, since J rotates with the body and the angular momentum does
// not.
#include <Eigen/LU>
#include <cmath>

#include "plugins/clip/clip.h"
#include "plugins/clip/clip_applier.h"

namespace insula {

void Clip::free_motion(const StepContext& context) {
  const double h = context.h, m = added_mass(), factor = 1 / (h * h) + drag() / h;
  const Mat3 r = pose_.q.toRotationMatrix();
  to_centre_ = r * tool_.centre_of_mass;
  moments_ = (m / tool_.mass) * r * tool_.inertia * r.transpose();
  moments_.diagonal().array() += m * gyration() * gyration();
  give_shift_ = 1 / (m * factor);
  give_ = (moments_ * factor).inverse();
  give_ = (0.5 * (give_ + give_.transpose())).eval();
  free_shift_ = give_shift_ * (external.head<3>() + tool_.mass * context.gravity + m * velocity_ / h);
  free_turn_ = give_ * (external.tail<3>() + spin_ / h);
  const double reach = data_.reference, turning_inertia = m * reach * reach / 3;  // two rods of half the mass each
  const double rise = strength_ * 4 * reach * reach * slope() * std::cos(opening_);
  give_opening_ = 1 / (turning_inertia * factor + std::max(0.0, rise) * (1 + hinge_time() / h));
  free_opening_ = give_opening_ * (-2 * torque(opening_) + turning_inertia * turn_rate_ / h);
  soonest_ = closing_time() > 0 ? opening_ - tool_.opening_max * h / closing_time() : 0;

  const Mat3 s = skew(to_centre_);
  compliance_.setZero();
  compliance_.topLeftCorner<3, 3>() = s * give_ * s.transpose();
  compliance_.topLeftCorner<3, 3>().diagonal().array() += give_shift_;
  compliance_.block<3, 3>(0, 3) = s * give_;
  compliance_.block<3, 3>(3, 0) = give_ * s.transpose();
  compliance_.block<3, 3>(3, 3) = give_;
  compliance_(6, 6) = give_opening_;

  free_pose_.q = (from_rotation_vector(free_turn_) * pose_.q).normalized();
  free_pose_.p = pose_.p + to_centre_ + free_shift_ - free_pose_.q * tool_.centre_of_mass;
}

Pose Clip::link_pose(int link) const {
  const Pose& t = turned_[std::size_t(link)];
  return {pose_.apply(t.p), pose_.q * t.q};
}

// Pose for the collision horizon: that of the applier that holds it. The jaws close at most to their stop, and hardly
// faster than in the last step, since without contact they would shut at once. The rows use the exact free motion.
Pose Clip::link_free_pose(int link) const {
  const double least = min_opening();
  const double change = std::max(free_opening_, std::min(0.0, last_change_) - 0.02);
  const double angle = std::clamp(opening_ + change, least, std::max(least, tool_.opening_max));
  const Pose t = tool_.link_pose(link, angle);
  Pose body = free_pose_;
  if (holder_) {
    const Pose &a = holder_->free_pose(), &in = holder_->clip_pose();
    body = {a.apply(in.p), a.q * in.q};
  }
  return {body.apply(t.p), body.q * t.q};
}

double Clip::turning(int link, const Vec3& arm, const Vec3& d) const {
  if (link == 0) return 0;
  const Hinge& hinge = tool_.hinges[std::size_t(link) - 1];
  return hinge.multiplier * d.dot((pose_.q * hinge.axis).cross(arm - pose_.q * hinge.origin));
}

Vec3 Clip::free_displacement(const MaterialPoint& p) const {
  const Vec3 a = arm(p);
  Vec3 x = free_shift_ + free_turn_.cross(a - to_centre_);
  for (int k = 0; k < 3; ++k) x[k] += free_opening_ * turning(p.link, a, Vec3::Unit(k));
  return x;
}

void Clip::add_row(BodyRows& out, const MaterialPoint& p, const Vec3& d) const {
  const Vec3 a = arm(p);
  out.add(0, d);
  out.add(1, a.cross(d));
  if (p.link > 0) out.add(2, Vec3(turning(p.link, a, d), 0, 0));
}

void Clip::begin_compliance(const BodyRows& r) {
  const std::size_t m = std::size_t(r.count());
  jacobian_.resize(m);
  answer_.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    Vec7& j = jacobian_[i];
    j.setZero();
    for (int e = r.start[i]; e < r.start[i + 1]; ++e) {
      const Vec3& c = r.coeff[std::size_t(e)];
      if (r.block[std::size_t(e)] == 2) j[6] += c.x();
      else j.segment<3>(3 * r.block[std::size_t(e)]) += c;
    }
    answer_[i].noalias() = compliance_ * j;
  }
}

void Clip::add_response(const BodyRows& r, double* w, int stride, double* delta_free) {
  for (std::size_t i = 0; i < jacobian_.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double v = answer_[i].dot(jacobian_[j]);
      const std::size_t a = std::size_t(r.row[i]), b = std::size_t(r.row[j]);
      w[a * std::size_t(stride) + b] += v;
      if (a != b) w[b * std::size_t(stride) + a] += v;
    }
  Vec7 free;
  free << free_shift_ - free_turn_.cross(to_centre_), free_turn_, free_opening_;
  for (std::size_t i = 0; i < jacobian_.size(); ++i) delta_free[r.row[i]] += jacobian_[i].dot(free);
}

void Clip::apply(const StepContext& context, const BodyRows& r, const double* lambda) {
  Vec7 f = Vec7::Zero();
  for (std::size_t i = 0; i < jacobian_.size(); ++i) f += lambda[r.row[i]] * jacobian_[i];
  pushed_ = f[6];
  const Vec3 push = f.head<3>();
  const Vec3 shift = free_shift_ + give_shift_ * push;
  const Vec3 turn = give_ * (f.segment<3>(3) - to_centre_.cross(push));
  const double open = free_opening_ + give_opening_ * f[6];
  const Vec3 centre = pose_.p + to_centre_ + shift;
  const Quat q = (from_rotation_vector(turn) * free_pose_.q).normalized();
  place({centre - q * tool_.centre_of_mass, q}, opening_ + open);
  velocity_ = shift / context.h;
  spin_ = moments_ * (free_turn_ + turn) / context.h;
  last_change_ = open;
  turn_rate_ = open / context.h;
  const Vec3 turned = free_turn_ + turn;
  moving_ << (shift - turned.cross(to_centre_)) / context.h, turned / context.h, turn_rate_;
}

void Clip::add_rate(const BodyRows& r, double* rate) const {
  for (std::size_t i = 0; i < jacobian_.size(); ++i) rate[r.row[i]] += jacobian_[i].dot(moving_);
}

}  // namespace insula
