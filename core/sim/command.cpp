// SPDX-License-Identifier: GPL-3.0-or-later
// Commands between two steps: tool exchange, commands of components, messages.
#include "core/base/text.h"
#include "core/sim/motion.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

// Removes the first word from `text` and returns it.
std::string_view take_word(std::string_view& text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  std::size_t n = 0;
  while (n < text.size() && !blank(text[n])) ++n;
  const std::string_view word = text.substr(0, n);
  text.remove_prefix(n);
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  return word;
}

}  // namespace

std::string Simulation::command(std::string_view verb, std::string_view argument) {
  if (!stepping_) {
    SimulationInput& input = note(SimulationInput::Kind::command);
    input.verb = verb.substr(0, longest_argument);
    input.argument = argument.substr(0, longest_argument + 1);  // one more: too long is refused again
  }
  std::string why;
  if (argument.size() > longest_argument) why = "the argument is too long";
  else if (verb == "exchange") why = exchange(argument);
  else if (verb == "ask") why = ask(argument);
  else if (verb == "message") why = argument.empty() ? "a message needs text" : "";
  else why = "unknown command " + in_quotes(verb);
  const std::string what(argument.substr(0, longest_argument));
  if (why.empty())
    commanded_.push_back({verb == "message" ? "message" : "command", std::string(verb), what, 0, context_.time});
  else commanded_.push_back({"refused", std::string(verb.substr(0, 40)), why, 0, context_.time});
  return why;
}

std::string Simulation::exchange(std::string_view argument) {
  const std::string_view side = take_word(argument), name = take_word(argument);
  const int hand = side == "left" ? 0 : side == "right" ? 1 : -1;
  if (hand < 0 || name.empty()) return "exchange needs a hand and a tool, such as \"right applier\"";
  auto* wanted = scene_->find_as<Instrument>(name);
  std::vector<std::string> ids;
  for (const Instrument* i : instruments_)
    if (i->hand_index() == hand) ids.push_back(i->id);
  if (!wanted || wanted->hand_index() != hand) {
    const std::string near = nearest_name(std::string(name), ids);
    return "no tool " + in_quotes(name) + " for the " + std::string(side) + " hand" + did_you_mean(near);
  }
  if (wanted->active()) return {};
  Instrument* held = instrument_of(hand);
  Pose device = wanted->home_pose();
  if (held) {
    // A tool in contact cannot be exchanged, since its successor would start inside the tissue.
    for (const ContactPoint& c : report_.contacts)
      if ((c.a == held || c.b == held) && c.normal_force > 0)
        return "draw the instrument out of the field before you exchange it";
    if (std::string why = held->why_kept(); !why.empty()) return why;
    device = held->device();
    held->lay_down();
  }
  wanted->take_up(device);
  return {};
}

std::string Simulation::ask(std::string_view argument) {
  const std::string_view id = take_word(argument), name = take_word(argument);
  Component* component = scene_->find(id);
  if (!component) return "nothing in the scene is called " + in_quotes(id);
  std::vector<std::string> names;
  for (const CommandInfo& c : component->commands()) {
    if (c.name == name) return component->run_command(name, argument);
    names.push_back(c.name);
  }
  const std::string near = nearest_name(std::string(name), names);
  return in_quotes(id) + " has no command " + in_quotes(name) + did_you_mean(near);
}

}  // namespace insula
