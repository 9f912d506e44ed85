// SPDX-License-Identifier: GPL-3.0-or-later
// Grades a remnant.
#include "plugins/clipping_rules/neck_judge.h"

#include <algorithm>
#include <cmath>

#include "core/collision/shapes/closest.h"

namespace insula {
namespace {

constexpr double ring_half_width = 0.5e-3;

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  return (x - a - closest_on_segment(x, a, b) * (b - a)).norm();
}

}  // namespace

bool NeckJudge::attach(const ShellBody& vessel) {
  vessel_ = &vessel;
  const WallModel& m = vessel.model();
  const int sac = vessel.region("sac"), bleb = vessel.region("bleb"), neck = vessel.region("neck");
  if (!(m.neck_diameter > 0) || sac < 0) return false;
  up_ = m.neck_normal;
  std::vector<double> area(m.wall.vertices.size(), 0.0);
  for (const auto& t : m.wall.triangles) {
    const Vec3 &a = m.wall.vertices[std::size_t(t[0])], &b = m.wall.vertices[std::size_t(t[1])],
               &c = m.wall.vertices[std::size_t(t[2])];
    for (int v : t) area[std::size_t(v)] += (b - a).cross(c - a).norm() / 6;
  }
  ring_.clear();
  sac_.clear();
  bleb_.clear();
  held_.clear();
  ring_area_ = sac_area_ = 0;
  for (int i = 0; i < int(area.size()); ++i) {
    const Vec3 d = m.wall.vertices[std::size_t(i)] - m.neck_centre;
    const double height = d.dot(up_), beside = (d - height * up_).norm();
    if (std::abs(height) < ring_half_width && beside < m.neck_diameter) {
      ring_.push_back({i, area[std::size_t(i)], height});
      ring_area_ += area[std::size_t(i)];
    }
    const int r = m.vertex_region[std::size_t(i)];
    if (r == sac || r == bleb) {
      sac_.push_back({i, area[std::size_t(i)], height});
      sac_area_ += area[std::size_t(i)];
    }
    if (r == bleb) bleb_.push_back({i, area[std::size_t(i)], height});
    if (r == sac || r == bleb || r == neck) held_.push_back({i, area[std::size_t(i)], height});
  }
  return ring_area_ > 0 && sac_area_ > 0;
}

NeckJudgement NeckJudge::judge(const std::vector<ClipState>& clips, bool sealed) const {
  NeckJudgement out;
  const auto at = [this](int node) -> Vec3 { return vessel_->q().segment<3>(3 * node); };
  Vec3 centre = Vec3::Zero();
  for (const Patch& p : ring_) centre += p.area / ring_area_ * at(p.node);
  const auto on_neck = [&](const ClipState& c) {
    return !c.on_tray && !c.holder && !c.temporary &&
           distance_to_segment(centre, c.blade_root, c.blade_tip) < near_neck;
  };
  double height = -1e9, far = -1e9;
  out.gap = 1e9;
  for (const ClipState& c : clips) {
    if (!on_neck(c)) continue;
    ++out.clips;
    out.gap = std::min(out.gap, c.gap);
    const Vec3 along = (c.blade_tip - c.blade_root).normalized();
    // Rest position of the wall between the blades. The blades nearest to the sac's base determine the remnant.
    double sum = 0, share = 0;
    for (const Patch& p : held_)
      if (distance_to_segment(at(p.node), c.blade_root, c.blade_tip) < 0.5 * c.blade_width + 0.3e-3) {
        sum += p.area * p.height;
        share += p.area;
      }
    const double h = share > 0 ? sum / share - 0.5 * c.blade_width : 1e9;
    height = out.clips == 1 ? h : std::min(height, h);
    double reach = -1e9;
    for (const Patch& p : ring_) reach = std::max(reach, along.dot(at(p.node)));
    far = std::max(far, along.dot(c.blade_tip) - reach);
  }
  if (out.clips == 0) {
    out.gap = 0;
    return out;
  }
  out.tip_past_neck = far;
  out.neck_open = out.sac_open = 0;
  for (const Patch& p : ring_) {
    bool closed = false;
    for (const ClipState& c : clips)
      closed = closed || (on_neck(c) &&
                          distance_to_segment(at(p.node), c.blade_root, c.blade_tip) < 0.5 * c.blade_width + margin);
    if (!closed) out.neck_open += p.area / ring_area_;
  }
  for (const Patch& p : sac_)
    if (p.height > 0 && p.height < height) out.sac_open += p.area / sac_area_;
  std::size_t lobe = 0;
  for (const Patch& p : bleb_) lobe += p.height < height;
  constexpr double trace = 0.1;  // share of ring or sac below which there is no remnant
  if (!sealed) {
    out.sac_open = 1;
    out.grade = 5;
  } else if (out.sac_open >= 0.75) {
    out.grade = 5;
  } else if (out.sac_open > trace) {
    out.grade = !bleb_.empty() && 2 * lobe > bleb_.size() && out.sac_open < 0.5 ? 3 : 4;
  } else {
    out.grade = out.neck_open > 0.5 ? 2 : out.neck_open > trace ? 1 : 0;
  }
  return out;
}

}  // namespace insula
