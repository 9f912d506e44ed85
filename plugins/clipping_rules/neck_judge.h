// SPDX-License-Identifier: GPL-3.0-or-later
// The remnant of a clipped aneurysm, computed from the shape of the wall and the line of the blades.
//
// Sindou, Acevedo, Turjman 1998 grade the remnant: I less than half of the neck, II more than half of the neck, III a
// lobe of the sac, IV less than three quarters of the sac, V more. Here 0 means that there is no remnant.
// - neck: the ring of wall vertices at the neck plane. A vertex is left open when it is farther from the blades than
//   half their width and `margin`.
// - sac: the share of the sac's wall that lies between the neck and the blades. A clipped dome leans to any side. The
//   rest position of the wall that the blades hold therefore decides this.
// - lobe: the bleb lies on the near side of the blades while most of the sac does not.
#pragma once
#include <vector>

#include "core/mechanics/shell_body.h"
#include "plugins/clip/clip_state.h"

namespace insula {

struct NeckJudgement {
  int grade = 5;         ///< 0..5
  double neck_open = 1;  ///< share of the neck ring that remains open
  double sac_open = 1;   ///< share of the sac's wall that remains
  double tip_past_neck =
      0;           ///< distance of the blades' tips beyond the far side of the neck, m; negative: they do not reach it
  double gap = 0;  ///< slit between the blades that close best, m
  int clips = 0;   ///< clips on the neck
};

class NeckJudge {
 public:
  double margin = 0.6e-3;   ///< m
  double near_neck = 6e-3;  ///< a clip whose blades are farther from the neck does not count, m

  /// False if the vessel has no aneurysm (no neck, or no region "sac").
  bool attach(const ShellBody& vessel);
  /// `sealed`: no blood passes the neck. Allocates nothing and has no side effects.
  NeckJudgement judge(const std::vector<ClipState>& clips, bool sealed) const;

 private:
  struct Patch {
    int node;
    double area;    ///< at rest, m2
    double height;  ///< at rest, above the neck plane, m
  };
  const ShellBody* vessel_ = nullptr;
  std::vector<Patch> ring_, sac_;
  std::vector<Patch> bleb_, held_;  ///< held_: all that blades may hold, with the neck
  double ring_area_ = 0, sac_area_ = 0;
  Vec3 up_ = Vec3::UnitZ();  ///< towards the dome
};

}  // namespace insula
