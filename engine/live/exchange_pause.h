// SPDX-License-Identifier: GPL-3.0-or-later
// Pause of a hand's force while its tool is exchanged. The two tools have different couplings, and the new one may
// touch something that the old one did not. So the hand's tool is removed from the haptic problem for a while. The
// safety gate treats this as a lost source: the force fades to zero, and in again when the tool is back.
#pragma once
#include <array>

#include "core/sim/simulation.h"

namespace insula {

class ExchangePause {
 public:
  /// One or two steps longer than the 50 ms in which a gate fades a force to zero.
  static constexpr double pause_s = 0.09;

  /// After a step: the hands (0 left, 1 right) that exchanged their tools a moment ago.
  std::array<bool, 2> hands(const Simulation& simulation) {
    std::array<bool, 2> out{};
    for (int h = 0; h < 2; ++h) {
      Hand& hand = hands_[std::size_t(h)];
      const Instrument* tool = simulation.instrument_of(h);
      // A reset restores the first tools. Its hands need no pause.
      if (simulation.time() < last_) hand = {};
      if (hand.tool && tool != hand.tool) hand.since = simulation.time();
      hand.tool = tool;
      out[std::size_t(h)] = simulation.time() < hand.since + pause_s;
    }
    last_ = simulation.time();
    return out;
  }

 private:
  struct Hand {
    const Instrument* tool = nullptr;
    double since = -infinite;  ///< of the last exchange, s
  };
  std::array<Hand, 2> hands_;
  double last_ = -infinite;
};

}  // namespace insula
