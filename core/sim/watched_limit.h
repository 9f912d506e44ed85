// SPDX-License-Identifier: GPL-3.0-or-later
// What a rule of an exercise holds against a limit, for hints that come before the rule is broken. A rule that derives
// from WatchesLimits beside ExerciseRule states its limit once, and hints name the rule.
#pragma once
#include <cmath>
#include <vector>

#include "core/registry/channel.h"

namespace insula {

/// One channel and the limit that the rule compares it with.
struct WatchedLimit {
  const ChannelBase* channel = nullptr;  ///< of the rule or of another component; one number
  std::size_t item = 0;                  ///< of a group of channels
  const Component* owner = nullptr;      ///< whose channel it is
  double limit = 0;                      ///< SI, not 0
  bool above = true;                     ///< bad above the limit; else below it
  int hand = -1;                         ///< whose value it is: 0 left, 1 right; -1: no hand's
};

/// How far a value is on the way to its limit, in shares of the limit: 1 at the limit, 1.5 half a limit beyond it.
inline double share_of_limit(double value, double limit, bool above) {
  return 1 + (above ? value - limit : limit - value) / std::abs(limit);
}

class WatchesLimits {
 public:
  virtual ~WatchesLimits() = default;
  /// Called once all rules are declared. The order is always the same.
  virtual std::vector<WatchedLimit> watched_limits() const = 0;
  /// Whether the rule counts at present.
  virtual bool watches_now() const { return true; }
};

}  // namespace insula
