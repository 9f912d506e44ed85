// SPDX-License-Identifier: GPL-3.0-or-later
// What a run was asked to do since it was loaded or reset, in order. The engine is a function of it: a simulation of
// the same scene that does the same has the same bits. So this is a saved state, of a few bytes for each step.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/mechanics/instrument.h"
#include "core/sim/motion.h"

namespace insula::python {

/// Functions that the operations of a history are given to, in order.
struct Replay {
  std::function<void(int hand, const HandState&)> set_hand;
  std::function<void(std::string verb, std::string argument)> command;
  std::function<void(std::uint64_t seed)> draw_complications;
  std::function<void(Motion motion)> follow;  ///< an empty motion: hands are free again
  std::function<void()> step;
};

class History {
 public:
  History() = default;
  /// Bytes of bytes().
  explicit History(std::string bytes) : bytes_(std::move(bytes)) {}

  void clear() { bytes_.clear(); }
  void set_hand(int hand, const HandState& state);
  void command(std::string_view verb, std::string_view argument);
  void draw_complications(std::uint64_t seed);
  void follow(const Motion& motion);
  void step();

  const std::string& bytes() const { return bytes_; }
  /// Whether `other` begins with all of this.
  bool begins(const History& other) const { return other.bytes_.starts_with(bytes_); }
  /// Calls the functions for what comes after the first `from` bytes. Throws InputError if the bytes are damaged.
  void replay(const Replay& to, std::size_t from = 0) const;

 private:
  std::string bytes_;
};

}  // namespace insula::python
