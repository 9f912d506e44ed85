// SPDX-License-Identifier: GPL-3.0-or-later
// Which hint speaks, and when. At most one cue is given in a pause, the one that is worst among the urgent ones, if
// any. A hint speaks once, and again after what it watches has come back by a tenth.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace insula {

/// A hint in one step.
struct HintNow {
  double share = std::nan("");  ///< of the way to the limit; NaN: not known
  double warning = 1;           ///< share from which it holds
  double hold = 0;              ///< s, for which it must hold
  bool urgent = true;           ///< a fault is near; else it can wait for those
};

class CueChoice {
 public:
  /// pause: least time between two cues, s.
  CueChoice(std::size_t hints, double pause) : memory_(hints), pause_(pause) {}

  /// After a step that ended at `time` and took h, s: the hint that speaks; -1: none. Of two that are equally bad it is
  /// the first. Does not allocate.
  int choose(const std::vector<HintNow>& now, double time, double h) {
    int best = -1;
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      Memory& m = memory_[i];
      const HintNow& hint = now[i];
      const bool above = hint.share >= hint.warning;
      m.held = above ? m.held + h : 0;
      if (!(hint.share >= 0.9 * hint.warning)) m.armed = true;
      m.holds = above && m.held >= hint.hold - tolerance;
      if (m.holds && m.armed && (best < 0 || worse(hint, now[std::size_t(best)]))) best = int(i);
    }
    if (best < 0 || time - last_ < pause_ - tolerance) return -1;
    last_ = time;
    memory_[std::size_t(best)].armed = false;
    return best;
  }
  bool holds(std::size_t hint) const { return memory_[hint].holds; }
  void reset() {
    memory_.assign(memory_.size(), {});
    last_ = never;
  }

 private:
  static bool worse(const HintNow& a, const HintNow& b) { return a.urgent != b.urgent ? a.urgent : a.share > b.share; }
  static constexpr double tolerance = 1e-9, never = -std::numeric_limits<double>::infinity();
  struct Memory {
    double held = 0;  ///< s
    bool armed = true, holds = false;
  };
  std::vector<Memory> memory_;
  double pause_, last_ = never;
};

}  // namespace insula
