// SPDX-License-Identifier: GPL-3.0-or-later
// Modules, tasks and warm-ups.
#include "training/curriculum/checker.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/text.h"
#include "core/scene/read_params.h"

namespace insula {
namespace {

std::int64_t in_ms(double seconds) { return std::llround(1000 * seconds); }

/// "a -> b -> a", the middle of a long circle left out.
std::string circle_text(std::vector<std::string> ids) {
  constexpr std::size_t most = 12;
  ids.push_back(ids.front());
  if (ids.size() > most) {
    ids.erase(ids.begin() + most / 2, ids.end() - most / 2);
    ids.insert(ids.begin() + most / 2, "...");
  }
  return joined(ids, " -> ");
}

}  // namespace

void CurriculumChecker::error(const CurriculumElement& element, const ParamBase& param, const std::string& text) {
  reader_.report(element, param.given() ? param.pos() : element.pos, param.name() + ": " + text);
}

std::string CurriculumChecker::suggestion(const std::string& name, const std::vector<std::string>& names) {
  if (names.empty() || !suggestions_.afford(names.size())) return {};
  const std::string near = nearest_name(name, names);
  return near.empty() ? " (there are: " + first_names(names) + ")" : did_you_mean(near);
}

Curriculum CurriculumChecker::check(const CurriculumRoot& root) {
  Curriculum out;
  out.title = root.title();
  out.text = root.text();
  const auto modules = root.children_of<ModuleElement>();
  for (const ModuleElement* m : modules) out.modules.push_back(module(*m));
  for (const WarmUpElement* w : root.children_of<WarmUpElement>()) out.warm_ups.push_back(warm_up(*w));
  if (modules.empty() && !reader_.failed(root)) reader_.report(root, root.pos, "<curriculum> needs a <module>");
  circles(modules);
  return out;
}

Module CurriculumChecker::module(const ModuleElement& from) {
  Module out{from.id, from.title(), from.text(), {}, from.in_order(), {}};
  for (const ModuleElement* m : from.needs())
    if (m) out.needs.push_back(m->id);
  const auto tasks = from.children_of<TaskElement>();
  for (const TaskElement* t : tasks) out.tasks.push_back(task(*t));
  if (tasks.empty() && !reader_.failed(from)) reader_.report(from, from.pos, "<module> needs a <task>");
  return out;
}

void CurriculumChecker::circles(const std::vector<ModuleElement*>& modules) {
  enum class Seen { no, on_the_way, done };
  std::map<const ModuleElement*, Seen> seen;
  for (const ModuleElement* start : modules) {
    if (seen[start] != Seen::no) continue;
    std::vector<std::pair<const ModuleElement*, std::size_t>> way{{start, 0}};  // with the next requirement to follow
    seen[start] = Seen::on_the_way;
    while (!way.empty()) {
      auto& [at, next] = way.back();
      if (next == at->needs().size()) {
        seen[at] = Seen::done;
        way.pop_back();
        continue;
      }
      const ModuleElement* other = at->needs()[next++];
      if (!other || seen[other] == Seen::done) continue;
      if (seen[other] == Seen::no) {
        seen[other] = Seen::on_the_way;
        way.emplace_back(other, 0);
        continue;
      }
      std::vector<std::string> ids;
      for (auto step = way.rbegin(); step != way.rend(); ++step) {
        ids.push_back(step->first->id);
        if (step->first == other) break;
      }
      std::reverse(ids.begin(), ids.end());
      error(*other, other->needs, "modules require each other in a circle: " + circle_text(std::move(ids)));
    }
  }
}

Task CurriculumChecker::task(const TaskElement& from) {
  Task out;
  out.id = from.id;
  out.title = from.title();
  out.text = from.text();
  out.mode = from.mode.is("test") ? TaskMode::test : TaskMode::practice;
  out.guide = from.guide();
  out.seeds = from.seeds();
  if (from.mode.is("test") && from.guide.given() && from.guide())
    error(from, from.guide, "a test is without help; leave it out, or let mode be \"practice\"");
  const SceneFacts* known = facts(from, from.scene);
  if (known) out.scene = scene_key(from.scene());
  if (known && !out.seeds.empty() && !known->has_complications)
    diagnostics_.warning(from.seeds.pos(), "seeds: the scene has no complications that a seed would draw");
  const auto gates = from.children_of<GateElement>();
  const std::filesystem::path scene = as_named(from, from.scene);
  for (const GateElement* g : gates) out.gates.push_back(gate(*g, known, scene));
  if (gates.empty() && !reader_.failed(from))
    reader_.report(from, from.pos, "<task> needs a gate: <gate_goals>, <gate_faults> or <gate_metric>");
  for (const RepetitionElement* r : from.children_of<RepetitionElement>()) {
    Repetition repetition{{}, in_ms(r->grace()), r->keep_on()};
    for (const double s : r->after()) repetition.after_ms.push_back(in_ms(s));
    out.repetition = repetition;
  }
  return out;
}

WarmUp CurriculumChecker::warm_up(const WarmUpElement& from) {
  WarmUp out{{}, {}, from.text(), from.times()};
  const bool names_task = !from.task.ids().empty(), names_scene = !from.scene.empty();
  if (names_task == names_scene && !reader_.failed(from))
    reader_.report(from, from.pos,
                   "<warm_up> needs either a task or a scene" + std::string(names_task ? ", not both" : ""));
  if (const TaskElement* task = from.task.get()) {
    out.task = task->id;
    if (!reader_.failed(*task)) out.scene = scene_key(task->scene());
  } else if (names_scene && facts(from, from.scene)) {
    out.scene = scene_key(from.scene());
  }
  return out;
}

std::filesystem::path CurriculumChecker::as_named(const CurriculumElement& from, const Param<File>& file) {
  const auto named = (std::filesystem::path(from.part->shown).parent_path() / file.text()).lexically_normal();
  std::error_code error;  // one that was found among the shipped files keeps its whole path
  return std::filesystem::equivalent(named, file(), error) ? named : file();
}

const SceneFacts* CurriculumChecker::facts(const CurriculumElement& from, const Param<File>& scene) {
  if (scene.empty()) return nullptr;  // not found, which has been reported
  const std::filesystem::path file = as_named(from, scene);
  const SceneFacts& facts = sources_.scene(file);
  if (!facts.diagnostics.ok()) {
    error(from, scene, in_quotes(scene.text()) + " has errors of its own");
    if (!reported_.insert(file).second) return nullptr;
    for (const Diagnostic& d : facts.diagnostics.all())
      if (d.severity == Severity::error) diagnostics_.error(d.pos, d.text);
    return nullptr;
  }
  if (!facts.has_exercise) {
    error(from, scene, in_quotes(scene.text()) + " has no <exercise>, so nothing in it can be passed");
    return nullptr;
  }
  return &facts;
}

}  // namespace insula
