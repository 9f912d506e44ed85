// SPDX-License-Identifier: GPL-3.0-or-later
// A kind of event that a component may emit (core/sim/events.h), declared as parameters are so that the reference lists
// it:   EventKind torn{this, {.name = "torn", .doc = "a fibre broke", .value = "its tension, N", .bad = true}};
#pragma once
#include <string>
#include <string_view>

namespace insula {

class Component;

struct EventSpec {
  std::string_view name;
  std::string_view doc;         ///< one line
  std::string_view value = {};  ///< meaning of Event::value, with its unit; empty: none
  bool bad = false;             ///< reports show it as undesired
  bool listed = true;           ///< false: too frequent for the report's list
};

class EventKind {
 public:
  /// Throws std::logic_error for a wrong declaration.
  EventKind(Component* owner, EventSpec spec);
  EventKind(const EventKind&) = delete;
  EventKind& operator=(const EventKind&) = delete;
  const EventSpec& spec() const { return spec_; }
  std::string name() const { return std::string(spec_.name); }

 private:
  EventSpec spec_;
};

}  // namespace insula
