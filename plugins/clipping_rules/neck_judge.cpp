// SPDX-License-Identifier: GPL-3.0-or-later
// Grades a remnant.
#include "plugins/clipping_rules/neck_judge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/collision/shapes/closest.h"

namespace insula {
namespace {

constexpr double trace = 0.1;           // share of neck or sac below which there is no remnant
constexpr SacRemnant::Open all_open{};  // without any clip

}  // namespace

bool NeckJudge::attach(const ShellBody& vessel) {
  vessel_ = &vessel;
  if (!remnant_.attach(vessel.model())) return false;
  const auto& all = remnant_.vertices();
  rim_.clear();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::abs(all[i].height) < SacRemnant::rim_half_width) rim_.push_back(int(i));
  rim_height_ = 0;
  for (int i : rim_) rim_height_ += all[std::size_t(i)].height / double(rim_.size());
  held_.assign(all.size(), 0);
  height_.assign(all.size(), 0);
  cut_.assign(remnant_.edges().size(), 0);
  return !rim_.empty();
}

bool NeckJudge::on_neck(const ClipState& c, const Vec3& neck) const {
  if (c.on_tray || c.holder || c.temporary) return false;
  const Vec3 along = c.blade_tip - c.blade_root;
  return (neck - c.blade_root - closest_on_segment(neck, c.blade_root, c.blade_tip) * along).norm() < near_neck;
}

/// Whether a point lies between the closed blades: beside the clamping line by no more than half the blade's width, and
/// not farther from the line in the direction in which the blades close than closed walls are.
bool NeckJudge::between(const ClipState& c, const Vec3& point) const {
  const Vec3 x = c.local(point);
  std::array<Vec3, 2> ends;
  const std::span<const Vec3> line = c.clamping_line(ends);
  double nearest = 1e300;
  Vec3 offset = Vec3::Zero();
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vec3 a = line[k], along = line[k + 1] - a;
    double t = (x - a).dot(along) / along.squaredNorm();
    const double most = k + 2 == line.size() ? 1 + beyond_tip / along.norm() : 1;
    t = std::clamp(t, 0.0, most);
    const Vec3 d = x - a - t * along;
    if (d.squaredNorm() < nearest) {
      nearest = d.squaredNorm();
      offset = d;
    }
  }
  const double across = offset.dot(c.normal);
  return std::abs(across) <= half_slit && (offset - across * c.normal).norm() <= 0.5 * c.blade_width;
}

bool NeckJudge::passes_between(const ClipState& c, const Vec3& from, const Vec3& to) const {
  const double length = (to - from).norm();
  if (length <= c.blade_width) return false;  // one of its ends would be between them
  const int parts = int(std::ceil(2 * length / c.blade_width));
  for (int k = 1; k < parts; ++k)
    if (between(c, from + double(k) / parts * (to - from))) return true;
  return false;
}

Vec3 NeckJudge::neck() const {
  Vec3 centre = Vec3::Zero();
  for (int i : rim_)
    centre += vessel_->q().segment<3>(3 * remnant_.vertices()[std::size_t(i)].node) / double(rim_.size());
  return centre;
}

SacRemnant::Open NeckJudge::open_past(const std::vector<ClipState>& clips, const Vec3& neck,
                                      const ClipState* without) const {
  const auto& all = remnant_.vertices();
  const auto at = [&](int i) -> Vec3 { return vessel_->q().segment<3>(3 * all[std::size_t(i)].node); };
  const std::vector<SacRemnant::Edge>& edges = remnant_.edges();
  std::fill(held_.begin(), held_.end(), char(0));
  std::fill(cut_.begin(), cut_.end(), char(0));
  for (const ClipState& c : clips) {
    if (&c == without || !on_neck(c, neck)) continue;
    for (std::size_t i = 0; i < all.size(); ++i) held_[i] = held_[i] || between(c, at(int(i)));
    for (std::size_t e = 0; e < edges.size(); ++e)
      cut_[e] = cut_[e] || passes_between(c, at(edges[e][0]), at(edges[e][1]));
  }
  return remnant_.measure(held_, cut_, height_, margin);
}

NeckJudgement NeckJudge::judge(const std::vector<ClipState>& clips, bool sealed) const {
  NeckJudgement out;
  const auto& all = remnant_.vertices();
  const auto at = [&](int i) -> Vec3 { return vessel_->q().segment<3>(3 * all[std::size_t(i)].node); };
  const Vec3 centre = neck();
  double past = -1e9;
  out.gap = 1e9;
  for (const ClipState& c : clips) {
    if (!on_neck(c, centre)) continue;
    ++out.clips;
    out.gap = std::min(out.gap, c.gap);
    const Vec3 along = (c.blade_tip - c.blade_root).normalized();
    double far = -1e9;
    for (int i : rim_) far = std::max(far, along.dot(at(i)));
    past = std::max(past, along.dot(c.blade_tip) - far);
  }
  if (out.clips == 0) {
    out.gap = 0;
    return out;
  }
  out.tip_past_neck = past;
  const Vec3& up = vessel_->model().neck_normal;
  for (std::size_t i = 0; i < all.size(); ++i) height_[i] = (at(int(i)) - centre).dot(up) + rim_height_;
  const SacRemnant::Open open = open_past(clips, centre, nullptr);
  out.neck_open = open.neck;
  out.sac_open = sealed ? open.sac : 1;
  out.grade = sealed ? grade(open) : 5;
  for (const ClipState& c : clips) {
    if (!on_neck(c, centre)) continue;
    const SacRemnant::Open without = out.clips == 1 ? all_open : open_past(clips, centre, &c);
    out.needed += without.neck > open.neck + trace || without.sac > open.sac + trace;
  }
  return out;
}

int NeckJudge::grade(const SacRemnant::Open& open) {
  if (open.sac >= 0.75) return 5;
  if (open.sac > 2 * trace) return open.bleb > 0.5 && open.sac < 0.5 ? 3 : 4;
  return open.neck > 0.5 ? 2 : open.neck > trace ? 1 : 0;
}

}  // namespace insula
