// SPDX-License-Identifier: GPL-3.0-or-later
// The remnant of a clipped aneurysm, computed from the shape of the wall and the blades.
//
// Sindou, Acevedo, Turjman 1998 grade the remnant: I less than half of the neck, II more than half of the neck, III a
// lobe of the sac, IV less than three quarters of the sac, V more. Here 0 means that there is no remnant.
// - A vertex of the wall is held when it lies between the blades of a closed clip. An edge longer than a blade is wide
//   may pass between them while its ends do not.
// - sac_remnant.h says what blood still reaches. The share of the neck counts what rises above `margin`.
// - lobe: blood reaches most of the bleb, but not most of the sac.
//
// Several clips are judged together: what one of them leaves open, another may close. A clip is needed when the same
// judgement without it finds more open. Of two clips that hold the same folds, neither is.
#pragma once
#include <vector>

#include "core/mechanics/shell_body.h"
#include "plugins/clip/clip_state.h"
#include "plugins/clipping_rules/sac_remnant.h"

namespace insula {

struct NeckJudgement {
  int grade = 5;         ///< 0..5
  double neck_open = 1;  ///< share of the neck's circumference above which a remnant is left
  double sac_open = 1;   ///< share of the sac's wall that blood reaches
  double tip_past_neck =
      0;           ///< distance of the blades' tips beyond the far side of the neck, m; negative: they do not reach it
  double gap = 0;  ///< slit between the blades that close best, m
  int clips = 0;   ///< clips on the neck
  int needed = 0;  ///< those of them without which blood would reach more of neck or sac, by a tenth or more
};

class NeckJudge {
 public:
  double margin = 0.5e-3;       ///< height of a remnant that does not count, as angiography does not show it, m
  double near_neck = 6e-3;      ///< a clip whose blades are farther from the neck does not count, m
  double beyond_tip = 0.75e-3;  ///< the fold of the wall just beyond the tips is closed too, m
  double half_slit = 0.5e-3;    ///< a vertex farther than this from the middle of the slit is not closed, m

  /// False if the vessel has no aneurysm (no neck, or no region "sac").
  bool attach(const ShellBody& vessel);
  Vec3 neck() const;  ///< present middle of the rim at the neck's plane, scene frame, m
  /// `sealed`: no blood passes the neck. Allocates nothing and has no side effects. With several clips on the neck it
  /// measures once for each of them and once for all.
  NeckJudgement judge(const std::vector<ClipState>& clips, bool sealed) const;

 private:
  bool on_neck(const ClipState& clip, const Vec3& neck) const;
  bool between(const ClipState& clip, const Vec3& point) const;
  bool passes_between(const ClipState& clip, const Vec3& from, const Vec3& to) const;
  static int grade(const SacRemnant::Open& open);
  /// What blood reaches past the clips on the neck, without that one of them.
  SacRemnant::Open open_past(const std::vector<ClipState>& clips, const Vec3& neck, const ClipState* without) const;
  const ShellBody* vessel_ = nullptr;
  SacRemnant remnant_;
  std::vector<int> rim_;   ///< indices of the remnant's vertices at the neck's plane
  double rim_height_ = 0;  ///< of the rim's middle above the neck's plane at rest, m
  mutable std::vector<char> held_, cut_;
  mutable std::vector<double> height_;
};

}  // namespace insula
