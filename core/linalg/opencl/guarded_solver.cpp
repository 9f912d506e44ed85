// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/opencl/guarded_solver.h"

#include <spdlog/spdlog.h>

#include "core/linalg/direct_solver.h"

namespace insula::opencl {

BodySolver& GuardedSolver::present() const {
  return on_device_ ? static_cast<BodySolver&>(*on_device_) : *on_processor_;
}

/// On the device, or after its failure on the processor.
template <class F>
void GuardedSolver::attempt(F&& f) {
  if (on_device_) try {
      return f(static_cast<BodySolver&>(*on_device_));
    } catch (const DeviceFailure& e) {
      take_over(e.what());
    }
  f(*on_processor_);
}

void GuardedSolver::take_over(const std::string& why) {
  spdlog::error("{} has failed ({}); its body is solved on the processor from now on, with other bits", name_, why);
  on_device_.reset();
  on_processor_ = make_direct_solver(false);
  if (pattern_) on_processor_->analyse(*pattern_);
  if (!matrix_) return;
  if (loaded_) on_processor_->begin_motion(matrix_, load_, load_);
  else on_processor_->factorise(*matrix_);
  repeat(second_);
  on_processor_->exchange_rows();
  repeat(given_);
}

void GuardedSolver::repeat(Given& given) {
  if (!given.node_of_block) return;
  on_processor_->compute_compliance(given.rows, *given.node_of_block);
  given.computed = true;
}

void GuardedSolver::analyse(const BlockMatrix& a) {
  pattern_ = &a;
  matrix_ = nullptr;
  loaded_ = false;
  given_ = second_ = {};
  attempt([&](BodySolver& s) { s.analyse(a); });
}

// What is given is noted after the attempt: the processor repeats what was before it, and then makes the attempt.
bool GuardedSolver::factorise(const BlockMatrix& a) {
  bool good = false;
  matrix_ = nullptr;
  loaded_ = false;
  attempt([&](BodySolver& s) { good = s.factorise(a); });
  matrix_ = good ? &a : nullptr;
  return good;
}

bool GuardedSolver::begin_motion(const BlockMatrix* a, const VecX& load, const VecX& guess) {
  bool good = false;
  if (a) matrix_ = nullptr;
  loaded_ = false;
  attempt([&](BodySolver& s) { good = s.begin_motion(a, load, guess); });
  if (a) matrix_ = good ? a : nullptr;
  load_ = load;
  loaded_ = good;
  return good;
}

void GuardedSolver::solve(double* x) {
  const VecX before = Eigen::Map<const VecX>(x, pattern_ ? 3 * pattern_->nodes() : 0);
  attempt([&](BodySolver& s) {
    Eigen::Map<VecX>(x, before.size()) = before;
    s.solve(x);
  });
}

void GuardedSolver::unforced_motion(const VecX& load, VecX& x) {
  attempt([&](BodySolver& s) { s.unforced_motion(load, x); });
}

void GuardedSolver::add_free_motion(const BodyRows& rows, double* delta) const {
  present().add_free_motion(rows, delta);
}

void GuardedSolver::end_motion(const BodyRows& rows, const double* lambda, VecX& x) {
  attempt([&](BodySolver& s) { s.end_motion(rows, lambda, x); });
}

void GuardedSolver::begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
  given_.node_of_block = nullptr;
  attempt([&](BodySolver& s) { s.begin_compliance(rows, node_of_block); });
  given_.rows = rows;
  given_.node_of_block = &node_of_block;
  given_.computed = false;
}

int GuardedSolver::compliance_parts(ComplianceAct act) const {
  return given_.computed ? 0 : present().compliance_parts(act);
}

void GuardedSolver::compliance_part(ComplianceAct act, int part) {
  if (given_.computed) return;
  attempt([&](BodySolver& s) {
    if (!given_.computed) s.compliance_part(act, part);
  });
}

void GuardedSolver::add_compliance(const BodyRows& rows, double* w, int stride) {
  present().add_compliance(rows, w, stride);
}

void GuardedSolver::exchange_rows() {
  present().exchange_rows();
  std::swap(given_, second_);
}

SolverCost GuardedSolver::cost() const { return present().cost(); }

}  // namespace insula::opencl
