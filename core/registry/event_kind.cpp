// SPDX-License-Identifier: GPL-3.0-or-later
// Checking the declaration of a kind of event.
#include "core/registry/event_kind.h"

#include <stdexcept>

#include "core/registry/component.h"

namespace insula {

EventKind::EventKind(Component* owner, EventSpec spec) : spec_(spec) {
  const auto bad = [&](const char* why) {
    throw std::logic_error("event \"" + std::string(spec_.name) + "\" is declared wrongly: " + why);
  };
  if (!owner) bad("it has no owner");
  if (spec_.name.empty() || spec_.name.size() > 64 || spec_.name.find_first_of(" \t") != std::string_view::npos)
    bad("it needs a name of one word");
  if (spec_.doc.empty()) bad("it has no doc");
  for (const EventKind* other : owner->event_kinds())
    if (other->spec().name == spec_.name) bad("the component has it twice");
  owner->event_kinds_.push_back(this);
}

}  // namespace insula
