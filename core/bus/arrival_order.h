// SPDX-License-Identifier: GPL-3.0-or-later
// Selects the valid messages of a channel: the newest ones of the sender that started last.
#pragma once
#include <cstdint>

namespace insula {

class ArrivalOrder {
 public:
  /// After this silence a sender that started earlier, or an earlier number, is accepted. With the gate's ramp-in,
  /// forces are back within a second.
  static constexpr std::int64_t silence_ns = 500'000'000;
  /// Largest jump of the sequence number that is accepted at once.
  static constexpr std::int64_t far = 1000;

  /// Whether a message that arrives now is valid. It is then the newest. False: out of order, repeated, or from a
  /// sender that was replaced. A later sender, or a number far ahead, is accepted with its second message. One damaged
  /// message then cannot block all others.
  bool take(std::int64_t session, std::int64_t sequence, std::int64_t now_ns) {
    const Place place{session, sequence};
    // If the clock went back, the length of the silence is unknown.
    const bool silence = now_ns_ == 0 || now_ns - now_ns_ > silence_ns || now_ns < now_ns_;
    if (!silence && !follows(newest_, place)) {
      if (session < newest_.session || (session == newest_.session && sequence <= newest_.sequence)) return false;
      const bool goes_on = follows(candidate_, place);
      candidate_ = place;
      if (!goes_on) return false;
    }
    newest_ = place;
    now_ns_ = now_ns;
    return true;
  }

  std::int64_t session() const { return newest_.session; }  ///< of the accepted sender; -1: none yet

 private:
  struct Place {
    std::int64_t session = -1, sequence = 0;
  };
  static bool follows(const Place& a, const Place& b) {
    return a.session == b.session && b.sequence > a.sequence && b.sequence - a.sequence <= far;
  }
  Place newest_, candidate_;
  std::int64_t now_ns_ = 0;
};

}  // namespace insula
