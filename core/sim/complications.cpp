// SPDX-License-Identifier: GPL-3.0-or-later
// The random draw, and the start of complications that are due.
#include "core/sim/complications.h"

#include <algorithm>

#include "core/base/random.h"
#include "core/base/text.h"
#include "core/sim/simulation.h"

namespace insula {

void Complication::prepare(PrepareContext& context) {
  if (to() < from()) error(context, to, "comes before from");
  if (split_blanks(command()).size() < 2)
    error(context, command, "needs the id of a component and one of its commands, such as \"bleeding rupture\"");
}

void Complications::prepare(PrepareContext&) { list_ = children_of<Complication>(); }

void Complications::connect(PrepareContext& context, const Simulation& simulation) {
  for (const Complication* c : list_) {
    const auto words = split_blanks(c->command());
    const Component* target = simulation.scene().find(words[0]);
    if (!target) {
      std::vector<std::string> ids;
      for (const Component* other : simulation.scene().components())
        if (!other->commands().empty()) ids.push_back(other->id);
      const std::string near = nearest_name(words[0], ids);
      c->error(context, c->command, "no component has the id " + in_quotes(words[0]) + did_you_mean(near));
      continue;
    }
    std::vector<std::string> names;
    for (const CommandInfo& info : target->commands()) names.push_back(info.name);
    if (std::find(names.begin(), names.end(), words[1]) != names.end()) continue;
    const std::string near = nearest_name(words[1], names);
    c->error(context, c->command,
             "<" + target->element + "> has no command " + in_quotes(words[1]) +
                 (!near.empty()   ? did_you_mean(near)
                  : names.empty() ? "; it has none"
                                  : " (it has: " + joined(names) + ")"));
  }
}

void Complications::draw(std::uint64_t wanted, const Simulation& simulation) {
  drawn_from_ = wanted != 0 ? wanted : std::uint64_t(seed() != 0 ? seed() : simulation.scene().seed());
  drawn_.clear();
  for (const Complication* c : list_) {
    // The name gives each complication a stream of its own, so another complication does not change its draw.
    Fnv1a name;
    name.add(c->id);
    Random random(drawn_from_, name.value() >> 1);
    DrawnComplication d;
    d.id = c->id;
    d.command = c->command();
    d.probability = c->probability();
    // uniform() is below 1, so probability 1 always happens and 0 never does. Both numbers are drawn, so that a changed
    // probability does not change the time.
    d.happens = random.uniform() < c->probability();
    d.time = random.uniform(c->from(), c->to());
    drawn_.push_back(std::move(d));
  }
}

void Complications::act(Simulation& simulation) {
  for (DrawnComplication& d : drawn_) {
    if (!d.happens || d.begun || simulation.time() < d.time - 1e-9) continue;
    d.begun = true;
    simulation.announce({"complication", d.id, d.command, d.time, simulation.time()});
    d.refused = simulation.command("ask", d.command);
  }
}

}  // namespace insula
