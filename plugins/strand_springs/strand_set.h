// SPDX-License-Identifier: GPL-3.0-or-later
// State of arachnoid strands for rules and tools of this family of plugins. The page, reports and general rules do not
// need it. They read channels and drawables.
#pragma once
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

struct StrandState {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  ///< end points, scene frame
  double integrity = 1;                     ///< 1 whole, 0 about to be severed, -1 severed
  double tension = 0;                       ///< N
};

/// A component that holds strands.
class StrandSet {
 public:
  virtual ~StrandSet() = default;
  virtual int strand_count() const = 0;
  virtual StrandState strand(int i) const = 0;  ///< present state
  /// Whether a strand is severed, without its end points, which cost more.
  virtual bool severed(int i) const { return strand(i).integrity < 0; }
  /// The largest share of the tension at which a strand tears, worn as it is; null: none tears.
  virtual const ChannelBase* load_channel() const { return nullptr; }
};

/// All sets of a scene in document order.
class Strands {
 public:
  Strands() = default;
  explicit Strands(const Simulation& simulation) : sets_(simulation.scene().all<StrandSet>()) {}
  /// The present strands of all sets. Allocates while their number grows.
  const std::vector<StrandState>& now() {
    states_.clear();
    for (const StrandSet* set : sets_)
      for (int i = 0; i < set->strand_count(); ++i) states_.push_back(set->strand(i));
    return states_;
  }
  int total() const {
    int n = 0;
    for (const StrandSet* set : sets_) n += set->strand_count();
    return n;
  }
  int left() const {
    int n = 0;
    for (const StrandSet* set : sets_)
      for (int i = 0; i < set->strand_count(); ++i) n += !set->severed(i);
    return n;
  }
  /// One a strand, in the order of now(); allocates while their number grows.
  const std::vector<char>& severed() {
    severed_.clear();
    for (const StrandSet* set : sets_)
      for (int i = 0; i < set->strand_count(); ++i) severed_.push_back(set->severed(i));
    return severed_;
  }

 private:
  std::vector<StrandSet*> sets_;
  std::vector<StrandState> states_;
  std::vector<char> severed_;
};

}  // namespace insula
