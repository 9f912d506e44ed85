// SPDX-License-Identifier: GPL-3.0-or-later
// The system matrix of a deformable body and its factor, which are kept as long as they are accurate enough.
#include <chrono>

#include "core/base/nearest_rotation.h"
#include "core/linalg/inexact_solver.h"
#include "core/mechanics/deformable_body.h"

namespace insula {

// Whether the present factor is accurate enough: no pair of neighbours has rotated or stretched much since it was
// computed.
bool DeformableBody::tangent_is_good(double h) const {
  if (factor_h_ != h || tangent_tolerance() <= 0 || solver_->inexact()) return false;
  const double limit = tangent_tolerance() * tangent_tolerance();
  for (const Neighbours& n : neighbours_) {
    const Vec3 now = q_.segment<3>(3 * n.i) - q_.segment<3>(3 * n.j);
    const Vec3 then = factor_q_.segment<3>(3 * n.i) - factor_q_.segment<3>(3 * n.j);
    if ((now - then).squaredNorm() > limit * n.distance2) return false;
  }
  return true;
}

// Rotation of each free node's neighbours from rest to their present positions, by least squares.
void DeformableBody::find_rotations() {
  for (int j = 0; j < free_count_; ++j) around_[std::size_t(j)].setZero();
  const auto add = [&](int i, int j) {
    const Vec3 rest = rest_nodes()[std::size_t(i)] - rest_nodes()[std::size_t(j)];
    const Mat3 m = (q_.segment<3>(3 * i) - q_.segment<3>(3 * j)) * rest.transpose();
    if (const int b = free_[std::size_t(i)]; b >= 0) around_[std::size_t(b)] += m;
    if (const int b = free_[std::size_t(j)]; b >= 0) around_[std::size_t(b)] += m;
  };
  for (const Neighbours& n : neighbours_) add(n.i, n.j);
  for (int j = 0; j < free_count_; ++j)
    rotation_[std::size_t(j)] = nearest_rotation(around_[std::size_t(j)], turn_[std::size_t(j)]);
}

// Assembles A without inertia, and the force.
void DeformableBody::assemble(double h) {
  if (InexactSolver* s = solver_->inexact()) {
    find_rotations();
    s->set_rotations(rotation_);
  }
  a_.set_zero();
  for (ForceModel* f : forces_) f->linearise(q_.data(), force_.data(), &a_, h, Tangent::system);
  if (filling_gradient) filling_gradient->add_gradient(a_, -1);
}

// Forces that depend on velocity, and D v in damped_load_. D is assembled together with A.
void DeformableBody::add_damping(double h, bool fresh) {
  if (fresh) damping_matrix_.set_zero();
  for (ForceModel* f : damped_)
    f->linearise_damping(q_.data(), v_.data(), force_.data(), fresh ? &damping_matrix_ : nullptr, h);
  if (fresh) a_.add_scaled(damping_matrix_, 1 / h);
  for (int i = 0; i < nodes(); ++i)
    if (const int b = free_[std::size_t(i)]; b >= 0) packed_v_.segment<3>(3 * b) = v_.segment<3>(3 * i);
  damped_load_.setZero();
  damping_matrix_.add_product(packed_v_.data(), damped_load_.data());
}

// Factorises A with inertia, and begins the motion under load_.
void DeformableBody::factorise(double h) {
  double extra = 1, inertia_so_far = 0;
  bool with_load = filling_gradient != nullptr;
  for (int attempt = 0;; ++attempt) {
    for (int i = 0; i < nodes(); ++i) {
      const int b = free_[std::size_t(i)];
      if (b < 0) continue;
      const double inertia = mass_[std::size_t(i)] / (h * h) + damping_[std::size_t(i)] / h;
      double* d = a_.block(a_.diagonal(b));
      const double add = (extra - inertia_so_far) * inertia;
      d[0] += add;
      d[4] += add;
      d[8] += add;
    }
    inertia_so_far = extra;
    // A fluid's load makes the matrix indefinite where its wall buckles. The step then leaves the load's gradient out.
    // If the matrix is still indefinite, although force models must not cause this, its inertia is multiplied by ten
    // until it is not.
    const auto begin = std::chrono::steady_clock::now();
    const bool good = solver_->begin_motion(&a_, load_, guess_);
    factor_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    if (good && !retardation_times_known_) {  // once
      find_retardation_times(h);
      solver_->begin_motion(nullptr, load_, guess_);
    }
    if (good || attempt == 12) break;
    ++indefinite_;
    if (with_load) filling_gradient->add_gradient(a_, 1);
    else extra *= 10;
    with_load = false;
  }
  ++factorisations_;
  factor_q_ = q_;
  factor_h_ = h;
}

}  // namespace insula
