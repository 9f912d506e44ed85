// SPDX-License-Identifier: GPL-3.0-or-later
// What a session is for. A person chooses it on the start page or on the command line, and it decides whose result a
// report is.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace insula {

enum class SessionMode {
  waiting,        ///< nobody has chosen yet: time stands still
  demonstration,  ///< simulated hands follow a motion; the result is nobody's
  practice,       ///< a trainee tries, with targets shown
  test,           ///< a trainee is tested, without help
};

inline constexpr std::array<std::string_view, 4> session_mode_names{"waiting", "demonstration", "practice", "test"};

constexpr std::string_view name_of(SessionMode mode) { return session_mode_names[std::size_t(mode)]; }

/// The mode of this name; none if there is no such mode.
constexpr std::optional<SessionMode> session_mode(std::string_view name) {
  for (std::size_t i = 0; i < session_mode_names.size(); ++i)
    if (session_mode_names[i] == name) return SessionMode(i);
  return std::nullopt;
}

/// What pages are told of the session beside its exercise.
struct SessionNote {
  SessionMode mode = SessionMode::practice;
  std::string report = {};      ///< path of the last report that was written; empty: none
  std::string recording = {};   ///< file that the session is recorded into; empty: none
  bool soft_guide = false;      ///< the trainee has chosen a soft force with each hint
  int guided = -1;              ///< hand that one draws now: 0 left, 1 right; -1: none
  std::string unrecorded = {};  ///< why it is not recorded although it should be; empty: all is well
};

}  // namespace insula
