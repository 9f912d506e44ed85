// SPDX-License-Identifier: GPL-3.0-or-later
// Builds rows outside a step.
#include "core/testing/row_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/mechanics/deformable_body.h"

namespace insula::test {

bool RowData::has_law() const {
  if (!positional()) return false;
  return block.law == LawKind::friction || block.compliance > 0 || block.lower > -infinite || block.upper < infinite;
}

double RowData::potential() const {
  if (!has_law()) return 0;
  const double c = block.compliance;
  double lambda = 0;
  if (c > 0) lambda = std::min(std::max(-violation / c, lower()), upper());
  else if (violation != 0) lambda = violation < 0 ? upper() : lower();
  if (lambda == 0) return 0;
  if (!std::isfinite(lambda)) return infinite;
  return -lambda * violation - 0.5 * c * lambda * lambda;
}

std::string name_of(const RowKey& key, const RowData& row) {
  const std::uint64_t own = key.first & ((std::uint64_t(1) << 44) - 1);
  return fmt::format("row {} of key {}, violation {:.4g} mm", key.second, own, 1e3 * row.violation);
}

RowBench::RowBench(Simulation& s, Component& c) : simulation_(s), component_(c), builder_(problem_, s.bodies()) {
  context_.h = s.h();
  context_.gravity = s.scene().gravity();
  context_.step = s.steps() + 1;
}

RowMap RowBench::rows(double time) {
  for (Surface* f : simulation_.surfaces()) {
    f->update();
    f->update_collision();
  }
  ++context_.step;  // data that are updated once a step are updated now
  context_.time = simulation_.time() + time;
  builder_.clear();
  if (auto* c = dynamic_cast<Constraint*>(&component_)) {
    c->detect(context_);
    c->build(context_, builder_);
  } else if (auto* b = dynamic_cast<DynamicBody*>(&component_)) {
    b->build(context_, builder_);
  }
  builder_.finish();
  blocks = problem_.blocks;
  RowMap out;
  std::vector<RowData*> by_row;
  for (const Block& b : problem_.blocks)
    for (int k = 0; k < b.rows(); ++k) {
      RowData& r = out[{b.id, k}];
      r.block = b;
      r.offset = k;
      r.h = no_motion(simulation_);
      by_row.push_back(&r);
    }
  for (std::size_t b = 0; b < simulation_.bodies().size(); ++b) {
    const BodyRows& rows = simulation_.bodies()[b]->rows;
    for (int i = 0; i < rows.count(); ++i)
      for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
        by_row[std::size_t(rows.row[std::size_t(i)])]->h[b].segment<3>(3 * rows.block[std::size_t(e)]) +=
            rows.coeff[std::size_t(e)];
  }
  // The builder has only the violation. H dq_free is added with the compliance.
  for (std::size_t r = 0; r < by_row.size(); ++r) {
    by_row[r]->violation = problem_.delta_free[r];
    by_row[r]->rate = problem_.rate[r];
  }
  add_ways(by_row);
  return out;
}

void RowBench::add_ways(std::vector<RowData*>& by_row) const {
  std::vector<VecX> expected;
  for (Body* b : simulation_.bodies()) expected.push_back(by_row.empty() ? VecX() : expected_motion(*b));
  for (RowData* r : by_row)
    for (std::size_t b = 0; b < expected.size(); ++b)
      if (r->h[b].size() > 0) r->swept += r->h[b].dot(expected[b]);
  for (const Block& b : blocks) {
    double way2 = 0;
    for (int k = 0; k < b.rows(); ++k)
      way2 += by_row[std::size_t(b.row + k)]->swept * by_row[std::size_t(b.row + k)]->swept;
    for (int k = 0; k < b.rows(); ++k) by_row[std::size_t(b.row + k)]->swept = std::sqrt(way2);
  }
}

VecX RowBench::expected_motion(Body& body) const {
  VecX dq = VecX::Zero(3 * body.blocks());
  if (auto* soft = dynamic_cast<DeformableBody*>(&body)) {
    for (int i = 0; i < soft->nodes(); ++i) {
      MaterialPoint p;
      p.body = soft;
      p.count = 1;
      p.node[0] = i;
      p.weight[0] = 1;
      dq.segment<3>(3 * i) = soft->expected_displacement(p);
    }
  } else if (auto* tool = dynamic_cast<RigidBody*>(&body)) {
    // The translation follows from the tip, the rotation from two points at a distance of a metre.
    const Pose pose = tool->link_pose(0);
    const auto at = [&](const Vec3& offset) {
      return tool->free_displacement(tool->link_point(0, pose.q.conjugate() * offset));
    };
    const Vec3 t = at(Vec3::Zero()), x = at(Vec3::UnitX()) - t, y = at(Vec3::UnitY()) - t;
    dq.head<6>() << t, Vec3(y.z(), -x.z(), x.y());
    if (tool->blocks() < 3) return dq;
    // The opening follows from a point of the first jaw, along the direction in which it rotates.
    const MaterialPoint p = tool->link_point(1, Vec3::Zero());
    Vec3 turn;
    for (int k = 0; k < 3; ++k) {
      BodyRows rows;
      rows.clear();
      rows.open(0);
      tool->add_row(rows, p, Vec3::Unit(k));
      turn[k] = 0;
      for (std::size_t e = 0; e < rows.block.size(); ++e)
        if (rows.block[e] == 2) turn[k] += rows.coeff[e].x();
    }
    const Vec3 rigid = t + Vec3(dq.segment<3>(3)).cross(tool->position(p) - pose.p);
    dq[6] = turn.dot(tool->free_displacement(p) - rigid) / turn.squaredNorm();
  }
  return dq;
}

void move(Simulation& s, const std::vector<VecX>& dq, double scale) {
  for (std::size_t b = 0; b < s.bodies().size(); ++b) {
    if (auto* soft = dynamic_cast<DeformableBody*>(s.bodies()[b])) soft->q() += scale * dq[b];
    else if (auto* tool = dynamic_cast<RigidBody*>(s.bodies()[b]))
      tool->place(displaced(tool->link_pose(0), scale * Vec6(dq[b].head<6>())),
                  tool->opening() + (dq[b].size() > 6 ? scale * dq[b][6] : 0));
  }
}

std::vector<VecX> no_motion(const Simulation& s) {
  std::vector<VecX> out;
  for (const Body* body : s.bodies()) out.push_back(VecX::Zero(3 * body->blocks()));
  return out;
}

Restore::Restore(Simulation& s) : s_(s) {
  for (Body* b : s.bodies()) {
    if (auto* soft = dynamic_cast<DeformableBody*>(b)) q_.push_back(soft->q());
    else q_.emplace_back();
    if (auto* tool = dynamic_cast<RigidBody*>(b)) pose_.emplace_back(tool->link_pose(0), tool->opening());
    else pose_.emplace_back();
  }
}

void Restore::operator()() const {
  for (std::size_t b = 0; b < s_.bodies().size(); ++b) {
    if (auto* soft = dynamic_cast<DeformableBody*>(s_.bodies()[b])) soft->q() = q_[b];
    if (auto* tool = dynamic_cast<RigidBody*>(s_.bodies()[b])) tool->place(pose_[b].first, pose_[b].second);
  }
}

}  // namespace insula::test
