// SPDX-License-Identifier: GPL-3.0-or-later
// The prestrain that balances a load on a deformable body at rest.
#include "core/linalg/inexact_solver.h"
#include "core/mechanics/deformable_body.h"

namespace insula {
namespace {

/// Conjugate gradients on unbalanced() = 0, in which prestrain(u) adds u to the unknown. Returns what is left, N.
template <class Unbalanced, class Prestrain, class Precondition>
double balance(const Unbalanced& unbalanced, const Prestrain& prestrain, const Precondition& precondition,
               double size) {
  constexpr double enough = 1e-10;
  constexpr int most = 500;
  VecX f = unbalanced(), r = -f, z = VecX::Zero(f.size()), p = z;
  double before = 1, left = r.norm();
  for (int k = 0; k < most && left > enough * size; ++k) {
    precondition(r, z);
    const double rz = r.dot(z);
    p = z + (k > 0 ? rz / before : 0) * p;
    before = rz;
    prestrain(p);
    const double curvature = p.dot(unbalanced() - f);
    if (!(curvature > 0)) {
      prestrain(-p);
      break;
    }
    prestrain((rz / curvature - 1) * p);
    f = unbalanced();
    r = -f;
    left = r.norm();
  }
  return left;
}

}  // namespace

// At rest the force of the prestrained models is linear in the displacement u that leads to their stress-free
// configuration, f = f0 + K u: K u = -(load + f0) by conjugate gradients. Only products with K are available. The
// preconditioner is the step's tangent of these models with the inertia of a step of one second, so that it is also
// regular for a body without fixed nodes.
double DeformableBody::prestress(const VecX& load) {
  constexpr double slow = 1;  // s
  VecX rest(3 * nodes());
  for (int i = 0; i < nodes(); ++i) rest.segment<3>(3 * i) = rest_nodes()[std::size_t(i)];
  const VecX none = VecX::Zero(3 * nodes());
  std::vector<ForceModel*> carry;
  for (ForceModel* f : forces_)
    if (f->prestrain(none.data())) carry.push_back(f);
  const auto free_part = [&](VecX x) {
    for (int i = 0; i < nodes(); ++i)
      if (fixed_[std::size_t(i)]) x.segment<3>(3 * i).setZero();
    return x;
  };
  const auto unbalanced = [&] {
    VecX f = load;
    for (ForceModel* m : carry) m->linearise(rest.data(), f.data(), nullptr, slow, Tangent::system);
    return free_part(std::move(f));
  };
  const auto prestrain = [&](const VecX& u) {
    for (ForceModel* m : carry) m->prestrain(u.data());
  };
  const double size = free_part(load).norm();
  if (size == 0) return 0;
  if (carry.empty()) return 1;

  std::swap(forces_, carry);
  q_.swap(rest);
  const int indefinite = indefinite_, factorisations = factorisations_;
  force_.setZero();
  assemble(slow);
  load_.setZero();
  factorise(slow);
  std::swap(forces_, carry);
  q_.swap(rest);
  indefinite_ = indefinite;
  factorisations_ = factorisations;
  factor_h_ = 0;

  const auto precondition = [&](const VecX& r, VecX& z) {
    for (int i = 0; i < nodes(); ++i)
      if (const int b = free_[std::size_t(i)]; b >= 0) packed_.segment<3>(3 * b) = r.segment<3>(3 * i);
    solver_->solve(packed_.data());
    for (int i = 0; i < nodes(); ++i)
      if (const int b = free_[std::size_t(i)]; b >= 0) z.segment<3>(3 * i) = packed_.segment<3>(3 * b);
  };
  const double left = balance(unbalanced, prestrain, precondition, size);
  if (InexactSolver* s = solver_->inexact()) s->reset();
  return left / size;
}

}  // namespace insula
