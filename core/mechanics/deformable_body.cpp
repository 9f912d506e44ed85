// SPDX-License-Identifier: GPL-3.0-or-later
// Stepping of a deformable body. Its matrix is in tangent.cpp, its prestress in prestress.cpp.
#include "core/mechanics/deformable_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/base/sorted_pairs.h"
#include "core/base/text.h"
#include "core/linalg/asynchronous_solver.h"
#include "core/linalg/direct_solver.h"
#include "core/linalg/opencl_solver.h"

namespace insula {

void DeformableBody::start_at_rest() {
  set_blocks(nodes());
  q_.resize(3 * nodes());
  for (int i = 0; i < nodes(); ++i) q_.segment<3>(3 * i) = rest_nodes()[std::size_t(i)];
  v_ = VecX::Zero(3 * nodes());
  external = filling = VecX::Zero(3 * nodes());
}

void DeformableBody::connect(PrepareContext& context) {
  const std::size_t n = std::size_t(nodes());
  forces_ = children_of<ForceModel>();
  fixed_.assign(n, 0);
  fix_own_nodes(fixed_);
  for (Support* s : children_of<Support>()) s->hold(context, rest_nodes(), fixed_);
  free_.assign(n, -1);
  free_count_ = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (!fixed_[i]) free_[i] = free_count_++;

  const int errors_before = context.diagnostics.errors();
  for (ForceModel* f : forces_) f->attach(context, *this);
  std::vector<std::pair<int, int>> all, pairs;
  for (const ForceModel* f : forces_) check_couplings(context, *f, all);
  for (auto [i, j] : all)
    if (free_[std::size_t(i)] >= 0 && free_[std::size_t(j)] >= 0)
      pairs.emplace_back(free_[std::size_t(i)], free_[std::size_t(j)]);
  neighbours_.clear();
  if (tangent_tolerance() > 0 || solver_kind.is("asynchronous")) {
    sort_unique_pairs(all, int(n));
    for (auto [i, j] : all)
      if (i != j)
        neighbours_.push_back({i, j, (rest_nodes()[std::size_t(i)] - rest_nodes()[std::size_t(j)]).squaredNorm()});
  }
  a_.set_pattern(free_count_, std::move(pairs));
  damped_.clear();
  std::copy_if(forces_.begin(), forces_.end(), std::back_inserter(damped_),
               [](const ForceModel* f) { return f->has_damping(); });
  damping_matrix_ = damped_.empty() ? BlockMatrix() : a_;
  mass_.assign(n, 0.0);
  damping_.assign(n, 0.0);
  for (ForceModel* f : forces_) {
    bind(context, *f);
    f->add_mass(mass_, damping_);
  }
  for (std::size_t i = 0; i < n; ++i)
    if (!fixed_[i] && !(mass_[i] > 0)) {
      // A force model with a reported error has given no mass, so there is no second message.
      if (context.diagnostics.errors() == errors_before)
        error(context, "node " + std::to_string(i) + " has no mass; a force model with a density is needed");
      return;
    }
  make_solver(context);
  solver_->analyse(a_);
  start_retardation_times();
  force_ = VecX::Zero(3 * nodes());
  packed_ = packed_v_ = damped_load_ = guess_ = load_ = unforced_ = VecX::Zero(3 * free_count_);
  turn_.assign(std::size_t(free_count_), Quat::Identity());
  rotation_.assign(std::size_t(free_count_), Mat3::Identity());
  around_ = rotation_;
}

void DeformableBody::make_solver(PrepareContext& context) {
  if (solver_kind.is("asynchronous")) solver_ = std::make_unique<AsynchronousSolver>(solver_tolerance());
  else if (solver_kind.is("faster")) solver_ = make_faster_solver(a_);
  else solver_ = make_direct_solver(solver_kind.is("single"));
  if (!solver_kind.is("opencl")) return;
  try {
    solver_ = make_opencl_solver();
  } catch (const NoDevice& e) {
    error(context, std::string(e.what()) + R"(; solver="faster" uses a device only where there is one)");
  }
}

/// Adds the model's couplings to `pairs`. Couplings with invalid nodes are reported and left out.
void DeformableBody::check_couplings(PrepareContext& context, const ForceModel& model,
                                     std::vector<std::pair<int, int>>& pairs) const {
  std::vector<std::pair<int, int>> own;
  model.couplings(own, Tangent::system);
  for (const auto& [i, j] : own) {
    const int wrong = i < 0 || i >= nodes() ? i : j;
    if (wrong < 0 || wrong >= nodes())
      return model.error(context, fmt::format("couples node {} of {}, which has the nodes 0 to {}", wrong,
                                              in_quotes(id), nodes() - 1));
  }
  pairs.insert(pairs.end(), own.begin(), own.end());
}

void DeformableBody::bind(PrepareContext& context, ForceModel& model) {
  try {
    model.bind(a_, free_);
  } catch (const UndeclaredCoupling& e) {
    const auto node = [&](int block) { return std::find(free_.begin(), free_.end(), block) - free_.begin(); };
    const bool known = std::min(e.row, e.column) >= 0 && std::max(e.row, e.column) < free_count_;
    model.error(context, known ? fmt::format("couples the nodes {} and {} of {} without declaring it in couplings()",
                                             node(e.column), node(e.row), in_quotes(id))
                               : fmt::format("asks for a block ({}, {}) of the matrix of {}, which has {} free nodes",
                                             e.row, e.column, in_quotes(id), free_count_));
  }
}

Vec3 DeformableBody::position(const MaterialPoint& p) const {
  Vec3 x = p.local;
  for (int k = 0; k < p.count; ++k) x += p.weight[std::size_t(k)] * q_.segment<3>(3 * p.node[std::size_t(k)]);
  return x;
}

Vec3 DeformableBody::expected_displacement(const MaterialPoint& p) const {
  Vec3 x = Vec3::Zero();
  for (int k = 0; k < p.count; ++k) x += p.weight[std::size_t(k)] * v_.segment<3>(3 * p.node[std::size_t(k)]);
  return x * step_;
}

Vec3 DeformableBody::unforced_displacement(const MaterialPoint& p) const {
  if (unforced_is_ == Unforced::unknown) solver_->unforced_motion(load_, unforced_);
  unforced_is_ = Unforced::asked;
  Vec3 x = Vec3::Zero();
  for (int k = 0; k < p.count; ++k)
    if (const int b = free_[std::size_t(p.node[std::size_t(k)])]; b >= 0)
      x += p.weight[std::size_t(k)] * unforced_.segment<3>(3 * b);
  return x;
}

bool DeformableBody::can_move(const MaterialPoint& p) const {
  for (int k = 0; k < p.count; ++k)
    if (p.weight[std::size_t(k)] != 0 && !fixed_[std::size_t(p.node[std::size_t(k)])]) return true;
  return false;
}

void DeformableBody::add_row(BodyRows& out, const MaterialPoint& p, const Vec3& d) const {
  for (int k = 0; k < p.count; ++k)
    if (p.weight[std::size_t(k)] != 0) out.add(p.node[std::size_t(k)], p.weight[std::size_t(k)] * d);
}

void DeformableBody::free_motion(const StepContext& context) {
  const double h = step_ = context.h;
  force_ = external + filling;
  factor_ms_ = 0;
  const bool fresh = !tangent_is_good(h);
  if (fresh) assemble(h);
  else
    for (ForceModel* f : forces_) f->linearise(q_.data(), force_.data(), nullptr, h, Tangent::system);
  if (!damped_.empty()) add_damping(h, fresh);
  for (int i = 0; i < nodes(); ++i)
    if (const int b = free_[std::size_t(i)]; b >= 0) {
      load_.segment<3>(3 * b) =
          force_.segment<3>(3 * i) + mass_[std::size_t(i)] * (context.gravity + v_.segment<3>(3 * i) / h);
      if (solver_->inexact()) guess_.segment<3>(3 * b) = h * v_.segment<3>(3 * i);
    }
  if (!damped_.empty()) load_ += damped_load_;
  if (fresh) factorise(h);
  else solver_->begin_motion(nullptr, load_, guess_);
  // A caller of the last step will ask again. It is computed now, while bodies are processed in parallel.
  const bool asked = unforced_is_ == Unforced::asked;
  unforced_is_ = asked ? Unforced::known : Unforced::unknown;
  if (asked) solver_->unforced_motion(load_, unforced_);
}

void DeformableBody::add_response(const BodyRows& r, double* w, int stride, double* delta_free) {
  solver_->add_compliance(r, w, stride);
  solver_->add_free_motion(r, delta_free);
}

void DeformableBody::apply(const StepContext& context, const BodyRows& r, const double* lambda) {
  solver_->end_motion(r, lambda, packed_);
  for (int i = 0; i < nodes(); ++i)
    if (const int b = free_[std::size_t(i)]; b >= 0) {
      q_.segment<3>(3 * i) += packed_.segment<3>(3 * b);
      v_.segment<3>(3 * i) = packed_.segment<3>(3 * b) / context.h;
    } else {
      v_.segment<3>(3 * i).setZero();
    }
}

void DeformableBody::add_rate(const BodyRows& r, double* rate) const {
  for (int i = 0; i < r.count(); ++i)
    for (int e = r.start[std::size_t(i)]; e < r.start[std::size_t(i) + 1]; ++e)
      rate[r.row[std::size_t(i)]] += r.coeff[std::size_t(e)].dot(v_.segment<3>(3 * r.block[std::size_t(e)]));
}

void DeformableBody::finish(const StepContext& context, const ConstraintSolution&) {
  for (ForceModel* f : forces_)
    if (f->finish(context, q_.data())) factor_h_ = 0;
}

void DeformableBody::reset() {
  for (int i = 0; i < nodes(); ++i) q_.segment<3>(3 * i) = rest_nodes()[std::size_t(i)];
  v_.setZero();
  external.setZero();
  filling.setZero();
  indefinite_ = 0;
  factorisations_ = 0;
  factor_h_ = 0;
  unforced_.setZero();
  unforced_is_ = Unforced::unknown;
  for (Quat& t : turn_) t.setIdentity();
  if (InexactSolver* s = solver_->inexact()) s->reset();
  for (ForceModel* f : forces_) f->reset();
}

double DeformableBody::energy() const {
  double e = 0;
  for (int i = 0; i < nodes(); ++i) e += 0.5 * mass_[std::size_t(i)] * v_.segment<3>(3 * i).squaredNorm();
  for (ForceModel* f : forces_) e += f->energy(q_.data());
  return e;
}

void DeformableBody::append_state(std::vector<double>& out) const {
  out.insert(out.end(), q_.data(), q_.data() + q_.size());
  out.insert(out.end(), v_.data(), v_.data() + v_.size());
  for (const ForceModel* f : forces_) f->append_state(out);
}

}  // namespace insula
