// SPDX-License-Identifier: GPL-3.0-or-later
// Modes of each body, from problem to problem.
#include "core/haptics/reduced_model_builder.h"

namespace insula {

void ReducedModelBuilder::begin(long step) {
  again_ = step == step_;
  if (!again_ && step != step_ + 1) basis_.clear();
  step_ = step;
}

void ReducedModelBuilder::add(const DeformableBody& body, const BodyRows& rows, std::span<const double> compliance,
                              ConstraintProblem& p) {
  Entry& e = basis_[&body];
  if (!again_ && e.step != step_ - 1) e.basis.clear();
  e.step = step_;
  if (!again_) e.basis.observe(body);
  e.basis.add(body, rows, compliance, p);
}

}  // namespace insula
