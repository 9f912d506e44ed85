// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the rows that constraints add.
#include "core/mechanics/constraint.h"

#include <algorithm>

#include "core/mechanics/surface.h"

namespace insula {

void ConstraintBuilder::clear() {
  delta_.clear();
  rate_.clear();
  retardation_time_.clear();
  blocks_.clear();
  for (Body* b : bodies_) b->rows.clear();
}

int ConstraintBuilder::add(Block block) {
  block.row = rows();
  block.owner = owner_;
  delta_.resize(delta_.size() + std::size_t(block.rows()), 0.0);
  rate_.resize(delta_.size(), 0.0);
  retardation_time_.resize(delta_.size(), 0.0);
  blocks_.push_back(block);
  return block.row;
}

void ConstraintBuilder::point(int row, const MaterialPoint& p, const Vec3& d) {
  p.body->rows.open(row);
  p.body->add_row(p.body->rows, p, d);
  retardation_time_[std::size_t(row)] = std::max(retardation_time_[std::size_t(row)], p.body->retardation_time(p));
}

void ConstraintBuilder::surface_point(int row, const Surface& s, int triangle, const Vec3& bary, const Vec3& d) {
  Body& body = s.body();
  if (body.blocks() == 0) return;
  body.rows.open(row);
  s.add_row(body.rows, triangle, bary, d);
  const auto& corner = s.triangles()[std::size_t(triangle)];
  double time = 0;
  for (int k = 0; k < 3; ++k)
    if (bary[k] != 0) time += bary[k] * body.retardation_time(s.points()[std::size_t(corner[std::size_t(k)])]);
  retardation_time_[std::size_t(row)] = std::max(retardation_time_[std::size_t(row)], time);
}

void ConstraintBuilder::finish() {
  problem_.resize(rows());
  std::copy(delta_.begin(), delta_.end(), problem_.delta_free.begin());
  std::copy(rate_.begin(), rate_.end(), problem_.rate.begin());
  std::copy(retardation_time_.begin(), retardation_time_.end(), problem_.retardation_time.begin());
  problem_.blocks.assign(blocks_.begin(), blocks_.end());
}

}  // namespace insula
