// SPDX-License-Identifier: GPL-3.0-or-later
// insula texts: what persons read of scenes and curricula, for those who translate it.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>
#include <set>

#include "core/base/spoken.h"
#include "engine/authoring/curriculum_sources.h"
#include "engine/command_line/play.h"
#include "engine/live/frame.h"
#include "training/curriculum/loader.h"

namespace insula {
namespace {

using TextList = nlohmann::ordered_json;

/// "flow.blood_loss" is read as "flow blood loss".
std::string spoken_name(std::string name) {
  std::replace(name.begin(), name.end(), '.', ' ');
  return spoken(std::move(name));
}

/// Each text once, with what it is at its first place.
class TextCollector {
 public:
  void add(const char* kind, const std::string& text) {
    if (!text.empty() && seen_.insert(text).second) list_.push_back({{"text", text}, {"kind", kind}});
  }
  const TextList& list() const { return list_; }

 private:
  std::set<std::string> seen_;
  TextList list_ = TextList::array();
};

/// A text that ends in a name, "Largest force on: left rail", is two: with "{name}" for the name, and the name. The
/// page joins the translations (viewer/page/src/languages/said.ts).
void add_with_name(TextCollector& to, const char* kind, const std::string& text) {
  static const std::regex with_name("(.*: )([a-z][a-z0-9 ]*)");
  std::smatch parts;
  if (!std::regex_match(text, parts, with_name)) return to.add(kind, text);
  to.add(kind, parts.str(1) + "{name}");
  to.add("name", parts.str(2));
}

void collect_exercise(TextCollector& to, const Exercise& exercise) {
  to.add("exercise", exercise.title());
  to.add("exercise", exercise.text());
  const ExerciseLog& log = exercise.log();
  for (const GoalState& g : log.goals()) to.add("goal", g.text);
  for (const FaultState& f : log.faults()) {
    to.add("fault", f.text);
    to.add("advice", f.advice);
  }
  for (const TimerState& t : log.timers()) to.add("timer", t.text);
  for (const MeasureState& m : log.measures()) {
    add_with_name(to, "measure", m.text);
    to.add("limit", m.limit);
  }
  for (const MetricValue& m : exercise.metrics()) add_with_name(to, "metric", m.text);
}

/// A tool's title as a page has it: with and without its hand.
void collect_tool(TextCollector& to, const RigidBody& body) {
  const auto* instrument = dynamic_cast<const Instrument*>(&body);
  const std::string title = spoken_name(body.tool().name);
  to.add("tool", title);
  to.add("tool", spoken_name(body.element));
  if (instrument && title.starts_with(instrument->hand() + " "))
    to.add("tool", title.substr(instrument->hand().size() + 1));
  for (const std::string& tag : body.tags()) to.add("tool", tag);
  for (const BodyProperty& p : body.properties()) to.add("tool", p.text);
}

void collect_channels(TextCollector& to, const ChannelTable& channels) {
  for (const ChannelEntry& e : channels.entries()) {
    to.add("component", spoken_name(e.component->id));
    const std::string name = e.channel->name(e.item);
    const std::string begin = e.group() + ".";
    to.add("group", spoken_name(e.group()));
    to.add("channel", spoken_name(name.starts_with(begin) ? name.substr(begin.size()) : name));
  }
}

/// What authors write for persons.
void collect_parameters(TextCollector& to, const Scene& scene) {
  for (const Component* c : scene.components())
    for (const ParamBase* p : c->params()) {
      const auto* text = dynamic_cast<const Param<std::string>*>(p);
      const bool read = p->name() == "text" || p->name() == "advice" || p->name() == "title" || p->name() == "label";
      if (text && read) to.add("text", (*text)());
    }
}

void collect_events(TextCollector& to, const Scene& scene) {
  for (const Component* c : scene.components())
    for (const EventKind* e : c->event_kinds()) to.add("event", spoken_name(e->name()));
}

void collect_commands(TextCollector& to, const Scene& scene) {
  for (const Component* c : scene.components())
    for (const CommandInfo& command : c->commands()) {
      to.add("component", spoken_name(c->id));
      to.add("command", spoken_name(command.name));
      to.add("explanation", command.doc);
    }
}

bool collect_curriculum(TextCollector& to, const std::filesystem::path& file, const CommandContext& context) {
  CurriculumFiles sources(context.registry);
  const CurriculumResult loaded = load_curriculum(file, sources);
  context.err << loaded.diagnostics.format();
  if (!loaded.curriculum) return false;
  const auto add = [&](const std::string& text) { to.add("curriculum", text); };
  add(loaded.curriculum->title), add(loaded.curriculum->text);
  for (const Module& module : loaded.curriculum->modules) {
    add(module.title), add(module.text);
    for (const Task& task : module.tasks) add(task.title), add(task.text);
  }
  return true;
}

}  // namespace

int cmd_texts(const CommandContext& context, const std::vector<std::filesystem::path>& files) {
  TextCollector texts;
  int status = 0;
  for (const auto& file : files) {
    if (is_curriculum_file(file)) {
      if (!collect_curriculum(texts, file, context)) status = 2;
      continue;
    }
    const SimulationResult loaded = load_simulation(file, context.registry);
    context.err << loaded.diagnostics.format();
    if (!loaded.simulation) {
      status = 2;
      continue;
    }
    const Simulation& simulation = *loaded.simulation;
    texts.add("title", simulation.scene().title());
    if (const Exercise* exercise = simulation.exercise()) collect_exercise(texts, *exercise);
    for (const RigidBody* body : picture_tools(simulation)) collect_tool(texts, *body);
    collect_channels(texts, simulation.channels());
    collect_parameters(texts, simulation.scene());
    collect_commands(texts, simulation.scene());
    collect_events(texts, simulation.scene());
  }
  context.out << texts.list().dump(1, ' ', false, TextList::error_handler_t::replace) << '\n';
  return status;
}

}  // namespace insula
