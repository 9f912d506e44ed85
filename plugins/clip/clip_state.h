// SPDX-License-Identifier: GPL-3.0-or-later
// State of clips for rules and tools of this family of plugins. The page, reports and general rules do not need it.
// They read channels.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

struct ClipState {
  const Body* clip = nullptr;
  const Body* holder = nullptr;  ///< the applier that holds it; null: released or on the tray
  bool on_tray = true;
  bool temporary = false;
  double opening = 0;                                        ///< rad
  double force = 0;                                          ///< of the blades on what is between them, N
  double gap = 0;                                            ///< between the blades at their middle, m
  Vec3 blade_root = Vec3::Zero(), blade_tip = Vec3::Zero();  ///< line midway between the blades, scene frame, m
  Pose pose;                                                 ///< of the clip's frame
  std::span<const Vec3> blade_line;                          ///< from root to tip, clip's frame, m; empty: straight
  Vec3 normal = Vec3::UnitX();                               ///< unit, of the clamping faces, clip's frame
  double blade_width = 0;                                    ///< m
  /// A point of the scene in the clip's frame, m.
  Vec3 local(const Vec3& p) const { return pose.q.conjugate() * (p - pose.p); }
  /// The clamping line from root to tip, clip's frame, m. `ends` holds it if it is straight.
  std::span<const Vec3> clamping_line(std::array<Vec3, 2>& ends) const {
    if (!blade_line.empty()) return blade_line;
    ends = {local(blade_root), local(blade_tip)};
    return ends;
  }
  int applications = 0;  ///< number of times it was released in the field
  /// It lies in the field, or an applier holds it shut on something. Blades that meet only each other press less.
  bool is_on() const {
    constexpr double pressing_N = 0.05;
    return !on_tray && (!holder || force > pressing_N);
  }
};

/// A component that is a clip.
class ClipSource {
 public:
  virtual ~ClipSource() = default;
  virtual ClipState clip_state() const = 0;  ///< present state
};

/// All clips of a scene in document order.
class Clips {
 public:
  Clips() = default;
  explicit Clips(const Simulation& simulation) : sources_(simulation.scene().all<ClipSource>()) {}
  /// Present states. Allocates only the first time.
  const std::vector<ClipState>& now() {
    states_.clear();
    for (const ClipSource* s : sources_) states_.push_back(s->clip_state());
    return states_;
  }

 private:
  std::vector<ClipSource*> sources_;
  std::vector<ClipState> states_;
};

}  // namespace insula
