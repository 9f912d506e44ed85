// SPDX-License-Identifier: GPL-3.0-or-later
// Assembly and stepping of a deformable body.
#include "core/mechanics/deformable_body.h"

#include <algorithm>
#include <chrono>

#include "core/base/nearest_rotation.h"
#include "core/base/sorted_pairs.h"
#include "core/linalg/asynchronous_solver.h"
#include "core/linalg/direct_solver.h"

namespace insula {

void DeformableBody::start_at_rest() {
  q_.resize(3 * nodes());
  for (int i = 0; i < nodes(); ++i) q_.segment<3>(3 * i) = rest_nodes()[std::size_t(i)];
  v_ = VecX::Zero(3 * nodes());
  external = filling = VecX::Zero(3 * nodes());
}

void DeformableBody::connect(PrepareContext& context) {
  const std::size_t n = std::size_t(nodes());
  forces_ = children_of<ForceModel>();
  held_.assign(n, 0);
  hold_own(held_);
  for (Support* s : children_of<Support>()) s->hold(context, rest_nodes(), held_);
  free_.assign(n, -1);
  free_count_ = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (!held_[i]) free_[i] = free_count_++;

  const int errors_before = context.diagnostics.errors();
  relaxation_ = 0;
  for (ForceModel* f : forces_) {
    f->attach(context, *this);
    relaxation_ = std::max(relaxation_, f->stiffness_damping());
  }
  std::vector<std::pair<int, int>> all, pairs;
  for (ForceModel* f : forces_) f->couplings(all, Tangent::system);
  for (auto [i, j] : all)
    if (free_[std::size_t(i)] >= 0 && free_[std::size_t(j)] >= 0)
      pairs.emplace_back(free_[std::size_t(i)], free_[std::size_t(j)]);
  neighbours_.clear();
  if (tangent_tolerance() > 0 || solver_kind.is("asynchronous")) {
    sort_unique_pairs(all, int(n));
    for (auto [i, j] : all)
      if (i != j) neighbours_.push_back({i, j, (rest_nodes()[std::size_t(i)] - rest_nodes()[std::size_t(j)]).squaredNorm()});
  }
  a_.set_pattern(free_count_, std::move(pairs));
  mass_.assign(n, 0.0);
  damping_.assign(n, 0.0);
  for (ForceModel* f : forces_) {
    f->bind(a_, free_);
    f->add_mass(mass_, damping_);
  }
  for (std::size_t i = 0; i < n; ++i)
    if (!held_[i] && !(mass_[i] > 0)) {
      // A force model that said what is wrong with it has given no mass; once is enough.
      if (context.diagnostics.errors() == errors_before)
        error(context, "node " + std::to_string(i) + " has no mass; a force model with a density is needed");
      return;
    }
  if (solver_kind.is("asynchronous")) solver_ = std::make_unique<AsynchronousSolver>(solver_tolerance());
  else solver_ = make_direct_solver(solver_kind.is("single"));
  solver_->analyse(a_);
  force_ = VecX::Zero(3 * nodes());
  packed_ = guess_ = response_ = load_ = unforced_ = VecX::Zero(3 * free_count_);
  turn_.assign(std::size_t(free_count_), Quat::Identity());
  turned_.assign(std::size_t(free_count_), Mat3::Identity());
  around_ = turned_;
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
    if (const int b = free_[std::size_t(p.node[std::size_t(k)])]; b >= 0) x += p.weight[std::size_t(k)] * unforced_.segment<3>(3 * b);
  return x;
}

bool DeformableBody::can_move(const MaterialPoint& p) const {
  for (int k = 0; k < p.count; ++k)
    if (p.weight[std::size_t(k)] != 0 && !held_[std::size_t(p.node[std::size_t(k)])]) return true;
  return false;
}

void DeformableBody::add_row(BodyRows& out, const MaterialPoint& p, const Vec3& d) const {
  for (int k = 0; k < p.count; ++k)
    if (p.weight[std::size_t(k)] != 0) out.add(p.node[std::size_t(k)], p.weight[std::size_t(k)] * d);
}

// Whether the factor at hand still serves: no pair of neighbours has turned or stretched much since it was made.
bool DeformableBody::tangent_is_good(double h) const {
  if (factor_h_ != h || tangent_tolerance() <= 0 || !solver_->exact()) return false;
  const double limit = tangent_tolerance() * tangent_tolerance();
  for (const Neighbours& n : neighbours_) {
    const Vec3 now = q_.segment<3>(3 * n.i) - q_.segment<3>(3 * n.j);
    const Vec3 then = factor_q_.segment<3>(3 * n.i) - factor_q_.segment<3>(3 * n.j);
    if ((now - then).squaredNorm() > limit * n.distance2) return false;
  }
  return true;
}

// Of each free node: that which turns its neighbours at rest into its neighbours now, best in the least squares.
void DeformableBody::find_rotations() {
  for (int j = 0; j < free_count_; ++j) around_[std::size_t(j)].setZero();
  const auto add = [&](int i, int j) {
    const Vec3 rest = rest_nodes()[std::size_t(i)] - rest_nodes()[std::size_t(j)];
    const Mat3 m = (q_.segment<3>(3 * i) - q_.segment<3>(3 * j)) * rest.transpose();
    if (const int b = free_[std::size_t(i)]; b >= 0) around_[std::size_t(b)] += m;
    if (const int b = free_[std::size_t(j)]; b >= 0) around_[std::size_t(b)] += m;
  };
  for (const Neighbours& n : neighbours_) add(n.i, n.j);
  for (int j = 0; j < free_count_; ++j) turned_[std::size_t(j)] = nearest_rotation(around_[std::size_t(j)], turn_[std::size_t(j)]);
}

// Assembles force and A, factorises A.
// The system's matrix but for inertia, and the force that goes with it.
void DeformableBody::assemble(double h) {
  if (solver_->wants_rotations()) {
    find_rotations();
    solver_->turn(turned_);
  }
  a_.set_zero();
  for (ForceModel* f : forces_) f->linearise(q_.data(), force_.data(), &a_, h, Tangent::system);
}

void DeformableBody::factorise(double h) {
  double extra = 1;
  for (int attempt = 0;; ++attempt) {
    for (int i = 0; i < nodes(); ++i) {
      const int b = free_[std::size_t(i)];
      if (b < 0) continue;
      const double inertia = mass_[std::size_t(i)] / (h * h) + damping_[std::size_t(i)] / h;
      double* d = a_.block(a_.diagonal(b));
      const double add = attempt == 0 ? inertia : (extra - extra / 10) * inertia;
      d[0] += add;
      d[4] += add;
      d[8] += add;
    }
    // An indefinite matrix (force models promise not to make one) is met with ten times the inertia, as often as needed.
    const auto begin = std::chrono::steady_clock::now();
    const bool good = solver_->factorise_and_begin(a_, load_, guess_);
    factor_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    if (good || attempt == 12) break;
    ++indefinite_;
    extra *= 10;
  }
  ++factorisations_;
  factor_q_ = q_;
  factor_h_ = h;
}

void DeformableBody::free_motion(const StepContext& context) {
  const double h = step_ = context.h;
  force_ = external + filling;
  factor_ms_ = 0;
  const bool fresh = !tangent_is_good(h);
  if (fresh) assemble(h);
  else
    for (ForceModel* f : forces_) f->linearise(q_.data(), force_.data(), nullptr, h, Tangent::system);
  for (int i = 0; i < nodes(); ++i)
    if (const int b = free_[std::size_t(i)]; b >= 0) {
      load_.segment<3>(3 * b) = force_.segment<3>(3 * i) + mass_[std::size_t(i)] * (context.gravity + v_.segment<3>(3 * i) / h);
      if (!solver_->exact()) guess_.segment<3>(3 * b) = h * v_.segment<3>(3 * i);
    }
  if (fresh) factorise(h);
  else solver_->begin_motion(load_, guess_);
  // Who asked in the last step will ask again: now bodies work side by side.
  const bool asked = unforced_is_ == Unforced::asked;
  unforced_is_ = asked ? Unforced::known : Unforced::unknown;
  if (asked) solver_->unforced_motion(load_, unforced_);
}

void DeformableBody::compute_compliance(const BodyRows& r) { solver_->compute_compliance(r, free_); }
void DeformableBody::begin_compliance(const BodyRows& r) { solver_->begin_compliance(r, free_); }
int DeformableBody::compliance_parts(ComplianceAct act) const { return solver_->compliance_parts(act); }
void DeformableBody::compliance_part(ComplianceAct act, int part) { solver_->compliance_part(act, part); }
void DeformableBody::add_compliance(const BodyRows& r, double* w, int stride) { solver_->add_compliance(r, w, stride); }

void DeformableBody::take_off_held(const BodyRows& r, double* delta) const { solver_->take_off_held(r, delta); }
void DeformableBody::respond(const BodyRows& r, const double* lambda) { solver_->correct(r, lambda, response_.data()); }

void DeformableBody::add_response(const BodyRows& r, double* delta) const {
  for (int i = 0; i < r.count(); ++i)
    for (int e = r.start[std::size_t(i)]; e < r.start[std::size_t(i) + 1]; ++e)
      if (const int b = free_[std::size_t(r.block[std::size_t(e)])]; b >= 0)
        delta[r.row[std::size_t(i)]] += r.coeff[std::size_t(e)].dot(response_.segment<3>(3 * b));
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
  solver_->forget();
  for (ForceModel* f : forces_) f->reset();
}

// At rest the force of the prestrained models is linear in the displacement u that leads to their natural shape, f = f0 + K u:
// K u = -(load + f0) by conjugate gradients. K is known by its products only; the preconditioner is the step's tangent of the
// models that take part, with what inertia a step of a second leaves, so that a body no one holds is no exception.
double DeformableBody::prestress(const VecX& load) {
  constexpr double enough = 1e-10, slow = 1;
  constexpr int most = 500;
  VecX rest(3 * nodes());
  for (int i = 0; i < nodes(); ++i) rest.segment<3>(3 * i) = rest_nodes()[std::size_t(i)];
  const VecX none = VecX::Zero(3 * nodes());
  std::vector<ForceModel*> carry;
  for (ForceModel* f : forces_)
    if (f->prestrain(none.data())) carry.push_back(f);
  const auto free_part = [&](VecX x) {
    for (int i = 0; i < nodes(); ++i)
      if (held_[std::size_t(i)]) x.segment<3>(3 * i).setZero();
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

  VecX f = unbalanced(), r = -f, z = none, p = none;
  double before = 1, left = r.norm();
  for (int k = 0; k < most && left > enough * size; ++k) {
    for (int i = 0; i < nodes(); ++i)
      if (const int b = free_[std::size_t(i)]; b >= 0) packed_.segment<3>(3 * b) = r.segment<3>(3 * i);
    solver_->solve(packed_.data());
    for (int i = 0; i < nodes(); ++i)
      if (const int b = free_[std::size_t(i)]; b >= 0) z.segment<3>(3 * i) = packed_.segment<3>(3 * b);
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
  solver_->forget();
  return left / size;
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
