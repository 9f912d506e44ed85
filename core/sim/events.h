// SPDX-License-Identifier: GPL-3.0-or-later
// Things that happen once, in the order in which they happened.
#pragma once
#include <string>
#include <vector>

namespace insula {

struct Event {
  /// "goal", "goal_lost", "fault", "message", "end", "reopened", "reset", "warning", or one that a component declares
  std::string kind;
  std::string id;    ///< of the component, goal or fault
  std::string text;  ///< for the trainee
  double value = 0;  ///< SI; its meaning depends on the kind
  double time = 0;   ///< simulated time, s
  int hand = -1;     ///< hand whose tool caused it: 0 left, 1 right; -1: none or not known
};

class EventSink {
 public:
  void emit(Event e) { events_.push_back(std::move(e)); }
  const std::vector<Event>& events() const { return events_; }
  void clear() { events_.clear(); }

 private:
  std::vector<Event> events_;
};

}  // namespace insula
