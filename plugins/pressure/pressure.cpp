// SPDX-License-Identifier: GPL-3.0-or-later
/*
# pressure

Blood pressure inside a closed shell, as a constraint on the volumes of its chambers. With V_j the volume of chamber j
and g_j = dV_j/dq (area-weighted normals, exact for the polyhedron):

    force on the wall   sum_j g_j P_j          row   delta = (V - V_rest) / A,   lambda = p A,   p = P(t + h) - P(t)

A is the mean area of a chamber. A row is thus in metres of mean wall displacement, and its lambda is in newtons. The
pressure of the last step is part of the free motion (DeformableBody::filling). Collision therefore searches at the
position that the wall will have under this pressure. The rows add the change of pressure.

The imaged shape is the one at mean pressure (or at `imaged_at`). The wall is prestressed so that its tension balances
that pressure there (DeformableBody::prestress, the linear inverse problem). It then bears the whole pressure. Without
pressure it is slack and somewhat smaller. With prestress="false" the imaged shape is free of stress and P is the
excess.

Alone, the pressure follows the pulse: bounds of the row lower = upper = (P(t + h) - P(t)) A.

If a network of vessels feeds the chambers, the pressures are unknowns. With everything but the chambers eliminated,
the network is Y p = s - Q, where Q is the chambers' dV/dt. It is integrated implicitly, with the volume of blood F of
each chamber as state:

    V(t + h) - F(t) + h (Y p - s) = 0,         F(t + h) = F(t) - h (Y p - s)

Here s belongs to pressures counted from P(t). The factorisation Y = L D L^T makes the rows' law diagonal. L comes
from the star-mesh shares; it is unit lower triangular and free of cancellation. With B = L^-1:

    row k   delta = B_k (V - F) / A - c_k lambda_k^feed,   c_k = h D_k / A^2,   p = B^T lambda / A

The coupling is exact. An open chamber takes the pressure of its feed. A sealed one is incompressible. Two that are
sealed off together keep their common volume. The hands feel the same. F keeps the account, so no blood is lost by
linearisation. If D is large, c may exceed the largest value of a message to the haptic server. Such a row gets a
resistance in series, and the pressure of the network behind it stays exact.

Source of the idea: Dequidt et al. 2015, section 3.4 (pressure as a constraint with area-weighted normals).
*/
#include "plugins/pressure/pressure.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
void BloodPressure::prepare(PrepareContext& context) {
  if (diastolic() > systolic()) error(context, diastolic, "is above systolic");
}

void BloodPressure::connect(PrepareContext& context, Simulation& simulation) {
  for (Constraint* c : simulation.constraints())
    if (auto* other = dynamic_cast<BloodPressure*>(c); other && other->on.get() == on.get() && other->order < order)
      return error(context, on, in_quotes(on->id) + " has a pressure already, " + in_quotes(other->id));
  ready(context);
}

bool BloodPressure::ready(PrepareContext& context) {
  if (!connected_) {
    connected_ = true;
    good_ = make_chambers(context);
  }
  return good_;
}

void BloodPressure::set_feed(ChamberFeed* feed) {
  feed_ = feed;
  for (int c = 0; c < chambers_.count(); ++c) pressure_[std::size_t(c)] = reference(c);
  prestress_wall(nullptr);
  fill();
}

void BloodPressure::reset() {
  phase_ = 0;
  systolic_now_ = systolic_wanted_ = systolic();
  diastolic_now_ = diastolic_wanted_ = diastolic();
  rate_ = rate_wanted_ = heart_rate();
  fluid_ = rest_volume_;
  pressure_.resize(rest_volume_.size());
  std::vector<std::string> names;
  for (int c = 0; c < chambers_.count(); ++c) names.push_back(chambers_.name(c));
  chamber_volume.declare(names);
  chamber_pressure.declare(std::move(names));
  heart_phase.set_subject(on.get());
  chamber_pressure.set_subject(on.get());
  for (int c = 0; c < int(pressure_.size()); ++c) pressure_[std::size_t(c)] = reference(c);
  fill();
}

/// Adds the pressure of the last step to the coming free motion.
void BloodPressure::fill() {
  on->filling.setZero();
  for (int c = 0; c < chambers_.count(); ++c) {
    auto& g = gradient_[std::size_t(c)];
    chambers_.gradient(c, on->q(), g);
    const double p = excess_[std::size_t(c)] = pressure(c) - (prestressed_ ? 0 : reference(c));
    for (std::size_t i = 0; i < g.size(); ++i) on->filling.segment<3>(3 * chambers_.nodes(c)[i]) += p * g[i];
  }
}

void BloodPressure::add_gradient(BlockMatrix& a, double scale) const {
  chambers_.add_second_derivative(on->q(), excess_, scale, a);
}

bool BloodPressure::set_pause(HeartPause* pause) {
  if (pause_ && pause_ != pause) return false;
  pause_ = pause;
  return true;
}

double BloodPressure::arterial(double h) const {
  return pause_ ? pause_->arterial(h, beat_pressure(h)) : beat_pressure(h);
}

double BloodPressure::beat_pressure(double h) const {
  const double next = phase_ + step_beats(h);
  return diastolic_now_ + (systolic_now_ - diastolic_now_) * wave_.value(next - std::floor(next));
}

void BloodPressure::prepare_feed(double h) {
  const int n = chambers_.count();
  const double max_compliance = 1e-5 / area_;
  for (int k = 0; k < n; ++k) {  // pressures count from those of the last step
    double s = -mesh_.ground(k) * pressure(k);
    for (int j = 0; j < n; ++j)
      if (j != k) s -= mesh_.link(k, j) * (pressure(k) - pressure(j));
    flow_[std::size_t(k)] = s;
  }
  for (int k = 0; k < n; ++k) mesh_.source(k, flow_[std::size_t(k)]);
  std::fill(mix_.begin(), mix_.end(), 0.0);
  for (int k = 0; k < n; ++k) mix_[std::size_t(k * n + k)] = 1;
  for (int k = 0; k < n; ++k) {
    mesh_.eliminate(k);
    for (int j = k + 1; j < n; ++j)
      for (int i = 0; i <= k; ++i) mix_[std::size_t(j * n + i)] += mesh_.share(k, j) * mix_[std::size_t(k * n + i)];
    Row& r = rows_[std::size_t(k)];
    r.feed = mesh_.pivot(k) > 0 ? mesh_.current(k) / mesh_.pivot(k) : 0;
    r.conductance = std::min(mesh_.pivot(k), max_compliance * area_ * area_ / h);
  }
}

void BloodPressure::detect(const StepContext& context) {
  if (!feed_) return;
  mesh_.clear(chambers_.count());
  feed_->reduce(context, mesh_);
  prepare_feed(context.h);
}

void BloodPressure::build(const StepContext& context, ConstraintBuilder& builder) {
  const int n = chambers_.count();
  h_ = context.h;
  for (int c = 0; c < n; ++c) {
    chambers_.gradient(c, on->q(), gradient_[std::size_t(c)]);
    volume_[std::size_t(c)] = volume(c) - (feed_ ? fluid_[std::size_t(c)] : rest_volume_[std::size_t(c)]);
  }
  for (int k = 0; k < n; ++k) {
    Row& r = rows_[std::size_t(k)];
    r.row = -1;
    Block block;
    block.id = row_id(*this, std::uint64_t(k));
    block.role = BlockRole::pressure;
    double violation = 0;
    if (feed_) {
      for (int j = 0; j <= k; ++j) violation += mix_[std::size_t(k * n + j)] * volume_[std::size_t(j)];
      violation = (violation - context.h * r.conductance * r.feed) / area_;
      block.compliance = context.h * r.conductance / (area_ * area_);
    } else {
      if (!yields_[std::size_t(k)]) continue;  // has no node that can move
      violation = volume_[std::size_t(k)] / area_;
      block.lower = block.upper = (arterial(context.h) - pressure(k)) * area_;
    }
    add_row(builder, k, block, violation);
  }
}

void BloodPressure::add_row(ConstraintBuilder& builder, int k, Block block, double violation) {
  const int n = chambers_.count();
  const int row = rows_[std::size_t(k)].row = builder.add(block);
  builder.violation(row, violation);
  row_nodes_.clear();
  for (int j = 0; j < n; ++j) {
    const double part = feed_ ? mix_[std::size_t(k * n + j)] : double(j == k);
    if (part == 0) continue;
    const auto& nodes = chambers_.nodes(j);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      row_gradient_[std::size_t(nodes[i])] += part / area_ * gradient_[std::size_t(j)][i];
      row_nodes_.push_back(nodes[i]);
    }
  }
  std::sort(row_nodes_.begin(), row_nodes_.end());
  row_nodes_.erase(std::unique(row_nodes_.begin(), row_nodes_.end()), row_nodes_.end());
  MaterialPoint p;
  p.body = on.get();
  p.count = 1;
  p.weight[0] = 1;
  for (int v : row_nodes_) {
    p.node[0] = v;
    builder.point(row, p, row_gradient_[std::size_t(v)]);
    row_gradient_[std::size_t(v)].setZero();
  }
}

void BloodPressure::finish(const StepContext& context, const ConstraintSolution& solution) {
  if (feed_) finish_feed(context, solution);
  else std::fill(pressure_.begin(), pressure_.end(), arterial(context.h));
  fill();
  const double next = phase_ + step_beats(context.h);
  phase_ = next - std::floor(next);
  const double follow = response() > 0 ? 1 - std::exp(-context.h / response()) : 1;
  systolic_now_ += follow * (systolic_wanted_ - systolic_now_);
  diastolic_now_ += follow * (diastolic_wanted_ - diastolic_now_);
  rate_ += follow * (rate_wanted_ - rate_);
  if (pause_) pause_->advance(context.h, beat_pressure(0));
}

void BloodPressure::finish_feed(const StepContext& context, const ConstraintSolution& solution) {
  const int n = chambers_.count();
  const auto at = [](std::vector<double>& v, int i) -> double& { return v[std::size_t(i)]; };
  // Back from the rows' combinations: p = B^T lambda / A on the wall and, before the series resistance, in the network.
  for (int k = n - 1; k >= 0; --k) {
    const Row& r = rows_[std::size_t(k)];
    const double own = solution.lambda[r.row] / area_;
    at(flow_, k) = r.conductance * (r.feed - own);
    double wall = own, node = mesh_.pivot(k) > 0 ? r.feed - at(flow_, k) / mesh_.pivot(k) : own;
    for (int j = k + 1; j < n; ++j) {
      wall += mesh_.share(k, j) * at(volume_, j);
      node += mesh_.share(k, j) * at(at_node_, j);
    }
    at(volume_, k) = wall;  // the volumes of the step are no longer needed; pressures from here on
    at(at_node_, k) = node;
  }
  for (int k = n - 1; k >= 0; --k)
    for (int j = k + 1; j < n; ++j) at(flow_, j) -= mesh_.share(k, j) * at(flow_, k);
  // Compliance of the chambers: A^2 L W L^T, diagonal.
  const auto w = [&](int i, int j) -> double& { return yielding_[std::size_t(i * n + j)]; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      w(i, j) = area_ * area_ * solution.problem.w_at(rows_[std::size_t(i)].row, rows_[std::size_t(j)].row);
  for (int k = n - 1; k >= 0; --k)
    for (int j = k + 1; j < n; ++j)
      for (int i = 0; i < n; ++i) w(j, i) -= mesh_.share(k, j) * w(k, i);
  for (int k = n - 1; k >= 0; --k)
    for (int j = k + 1; j < n; ++j)
      for (int i = 0; i < n; ++i) w(i, j) -= mesh_.share(k, j) * w(i, k);
  for (int c = 0; c < n; ++c) {
    at(fluid_, c) += context.h * at(flow_, c);
    at(at_node_, c) += pressure(c);
    at(pressure_, c) += at(volume_, c);
    at(yielding_, c) = std::max(0.0, w(c, c));
  }
  feed_->settle(context, at_node_.data(), yielding_.data());
}

void BloodPressure::publish() {
  heart_phase.set(phase_);
  arterial_now.set(arterial(0));
  for (std::size_t c = 0; c < pressure_.size(); ++c) {
    chamber_pressure.set(c, pressure_[c]);
    chamber_volume.set(c, volume(int(c)) / rest_volume_[c]);
  }
}

void BloodPressure::append_state(std::vector<double>& out) const {
  out.insert(out.end(),
             {phase_, systolic_now_, diastolic_now_, rate_, systolic_wanted_, diastolic_wanted_, rate_wanted_});
  out.insert(out.end(), pressure_.begin(), pressure_.end());
  out.insert(out.end(), fluid_.begin(), fluid_.end());
}

// The change of pressure in the step does work on the volume. A feed stores the energy of the chambers' excess volume.
StatedLaw BloodPressure::law() const {
  const int n = chambers_.count();
  double energy = 0;
  for (int k = 0; k < n; ++k) {
    const Row& r = rows_[std::size_t(k)];
    if (!feed_) {
      if (yields_[std::size_t(k)]) energy -= (arterial(h_) - pressure(k)) * (volume(k) - rest_volume(k));
      continue;
    }
    double excess = -h_ * r.conductance * r.feed;  // m3
    for (int j = 0; j <= k; ++j) excess += mix_[std::size_t(k * n + j)] * (volume(j) - fluid(j));
    if (excess != 0) energy += 0.5 * excess * excess / (h_ * r.conductance);
  }
  return StatedLaw::potential(energy);
}

}  // namespace insula

INSULA_PLUGIN(pressure) {
  registry.add<insula::BloodPressure>("pressure", insula::Kind::constraint,
                                      "pulsating blood pressure on the wall of a closed shell");
}
