// SPDX-License-Identifier: GPL-3.0-or-later
// What turns, and by how much.
#include "haptic_server/turning_rows.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double most_turn = 0.1;       // rad from problem to problem; more is an edge of the mesh, or another place
constexpr double most_share = 1.5;
constexpr double least_way_m = 5e-5;    // a hand that rests turns nothing

Vec3 direction(const ToolTerms& t, int row) { return t.jacobian.row(row).head<3>().transpose(); }

/// Across a block's tangents, or along its only row; zero: the tool has no part in it.
Vec3 normal_of(const ToolTerms& t, const Block& b) {
  const Vec3 n = b.law == LawKind::patch ? Vec3(direction(t, b.row).cross(direction(t, b.row + 1))) : direction(t, b.row);
  const double size = n.norm();
  return size > 0.9 && size < 1.1 ? Vec3(n / size) : Vec3(Vec3::Zero());
}

bool turns(const Block& b) { return b.law != LawKind::box || b.lower != -infinite || b.upper != infinite; }

}  // namespace

TurningRows::TurningRows(int most_rows) {
  for (std::size_t t = 0; t < 2; ++t) {
    jacobian_[t].setZero(most_rows, 6);
    turns_[t].reserve(std::size_t(most_rows));
    last_[t].reserve(std::size_t(most_rows));
  }
  next_.reserve(std::size_t(most_rows));
}

void TurningRows::begin(const ConstraintProblem& p, const std::array<Load, 2>& loads) noexcept {
  problem_ = &p;
  const std::size_t tools = std::min<std::size_t>(p.tools.size(), 2);
  for (std::size_t t = 0; t < tools; ++t) {
    const ToolTerms& tool = p.tools[t];
    for (int i = 0; i < p.rows; ++i) jacobian_[t].row(i) = tool.jacobian.row(i);
    const bool same = last_count_ > t && hand_[t] == tool.hand;
    way_[t] = same ? Vec3(tool.device.p - device_[t].p) : Vec3(Vec3::Zero());
    turns_[t].clear();
    next_.clear();
    for (const Block& b : p.blocks) {
      const Vec3 now = normal_of(tool, b);
      if (now.isZero(0)) continue;
      next_.push_back({b.id, now});
      if (!same || loads[t].any || !turns(b)) continue;
      const auto at = std::lower_bound(last_[t].begin(), last_[t].end(), b.id, [](const Direction& d, std::uint64_t id) { return d.id < id; });
      if (at == last_[t].end() || at->id != b.id) continue;
      const Vec3 by = at->normal.cross(now);
      if (at->normal.dot(now) <= 0 || by.norm() > most_turn) continue;
      Vec3 arm = Vec3::Zero();
      for (int k = 0; k < b.rows(); ++k) arm += direction(tool, b.row + k).cross(Vec3(tool.jacobian.row(b.row + k).tail<3>()));
      turns_[t].push_back({b.row, b.rows(), by, b.rows() == 3 ? Vec3(0.5 * arm) : arm});
    }
    last_[t].swap(next_);
    std::sort(last_[t].begin(), last_[t].end(), [](const Direction& a, const Direction& b) { return a.id < b.id; });
    device_[t] = tool.device;
    hand_[t] = tool.hand;
  }
  last_count_ = tools;
}

void TurningRows::turn(const std::array<Vec6, 2>& moved) noexcept {
  for (std::size_t t = 0; t < last_count_; ++t) {
    const double square = way_[t].squaredNorm();
    const double share = square > least_way_m * least_way_m ? std::clamp(moved[t].head<3>().dot(way_[t]) / square, -most_share, most_share) : 0.0;
    for (const Turn& turn : turns_[t]) {
      const Vec3 by = share * turn.by;
      for (int k = turn.row; k < turn.row + turn.rows; ++k) {
        Vec3 d = direction(problem_->tools[t], k);
        const double size = d.norm();
        const Vec3 moment = problem_->tools[t].jacobian.row(k).tail<3>().transpose();
        Vec3 turned = d + by.cross(d) + 0.5 * by.cross(by.cross(d));
        turned *= size / turned.norm();
        const Vec3 now = moment + turn.arm.cross(turned - d);
        jacobian_[t].row(k) << turned.transpose(), now.transpose();
      }
    }
  }
}

}  // namespace insula
