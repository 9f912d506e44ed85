// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the messages on a channel counts: the newest of the sender that started last.
#pragma once
#include <cstdint>

namespace insula {

class ArrivalOrder {
 public:
  /// After this silence a sender that started earlier, or an earlier number, is believed: with the gate's ramp-in,
  /// feeling is back within a second.
  static constexpr std::int64_t silence_ns = 500'000'000;
  /// Numbers lost in one go that need no explanation.
  static constexpr std::int64_t far = 1000;

  /// Whether a message that arrives now counts; then it is the newest. False: out of order, doubled, or of a sender
  /// that was replaced. A later sender, or a number far ahead, is believed when it goes on: one damaged message must
  /// not shut out all that are whole.
  bool take(std::int64_t session, std::int64_t sequence, std::int64_t now_ns) {
    const Place place{session, sequence};
    // A clock that went back says nothing of how long it was silent.
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

  std::int64_t session() const { return newest_.session; }  ///< of the sender that counts; -1: none yet

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
