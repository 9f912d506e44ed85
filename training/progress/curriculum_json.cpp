// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/progress/curriculum_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/input_error.h"

namespace insula::training {
namespace {

using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;

constexpr std::array<const char*, 3> gate_kinds{"goals", "faults", "metric"};

template <class T>
Ordered known(const std::optional<T>& value) {
  return value ? Ordered(*value) : Ordered();
}

template <class T>
std::optional<T> optional_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional<T>(json.get<T>());
}

}  // namespace

Ordered gate_json(const Gate& g) {
  return {{"kind", gate_kinds[std::size_t(g.kind)]},
          {"faults", g.faults},
          {"fault_texts", g.fault_texts},
          {"most_faults", g.most_faults},
          {"metric", g.metric},
          {"hand", g.hand},
          {"at_least", known(g.at_least)},
          {"at_most", known(g.at_most)},
          {"unit", g.unit},
          {"metric_text", g.metric_text},
          {"group", g.group},
          {"text", g.text},
          {"in_a_row", g.in_a_row},
          {"within_ms", g.within_ms}};
}

namespace {

Gate gate_of(const Json& j) {
  Gate g;
  const std::string kind = j.at("kind");
  const auto found = std::find(gate_kinds.begin(), gate_kinds.end(), kind);
  if (found == gate_kinds.end()) throw InputError(fmt::format("a curriculum has a gate of the kind \"{}\"", kind));
  g.kind = Gate::Kind(found - gate_kinds.begin());
  g.faults = j.at("faults"), g.most_faults = j.at("most_faults"), g.metric = j.at("metric"), g.hand = j.at("hand");
  g.at_least = optional_of<double>(j.at("at_least")), g.at_most = optional_of<double>(j.at("at_most"));
  g.fault_texts = j.at("fault_texts"), g.metric_text = j.at("metric_text"), g.group = j.at("group");
  g.unit = j.at("unit"), g.text = j.at("text"), g.in_a_row = j.at("in_a_row"), g.within_ms = j.at("within_ms");
  return g;
}

Ordered task_json(const Task& t) {
  Ordered gates = Ordered::array();
  for (const Gate& g : t.gates) gates.push_back(gate_json(g));
  Ordered repetition;
  if (const auto& r = t.repetition)
    repetition = {{"after_ms", r->after_ms}, {"grace_ms", r->grace_ms}, {"keep_on", r->keep_on}};
  return {{"id", t.id},
          {"title", t.title},
          {"text", t.text},
          {"scene", t.scene},
          {"mode", t.mode == TaskMode::test ? "test" : "practice"},
          {"guide", t.guide},
          {"seeds", t.seeds},
          {"gates", gates},
          {"repetition", repetition}};
}

Task task_of(const Json& j) {
  Task t;
  t.id = j.at("id"), t.title = j.at("title"), t.text = j.at("text"), t.scene = j.at("scene");
  t.mode = j.at("mode") == "test" ? TaskMode::test : TaskMode::practice;
  t.guide = j.at("guide"), t.seeds = j.at("seeds").get<std::vector<int>>();
  for (const Json& g : j.at("gates")) t.gates.push_back(gate_of(g));
  if (const Json& r = j.at("repetition"); !r.is_null())
    t.repetition = Repetition{r.at("after_ms").get<std::vector<std::int64_t>>(), r.at("grace_ms"), r.at("keep_on")};
  return t;
}

Ordered progress_of(const Task& task, const TaskProgress& p) {
  Ordered gates = Ordered::array();
  for (std::size_t k = 0; k < p.gates.size(); ++k)
    gates.push_back({{"condition", gate_json(task.gates.at(k))},
                     {"in_a_row", p.gates[k].in_a_row},
                     {"needed", p.gates[k].needed},
                     {"met", p.gates[k].met}});
  return {{"id", p.id},
          {"title", task.title},
          {"text", task.text},
          {"scene", task.scene},
          {"start", mode_to_start(task.mode, task.guide)},
          {"standing", standing_name(p.standing)},
          {"locked_by", p.locked_by},
          {"gates", std::move(gates)},
          {"attempts", p.attempts},
          {"runs", p.runs},
          {"attempts_to_level", known(p.attempts_to_level)},
          {"passed_ms", known(p.passed_ms)},
          {"due_ms", known(p.due_ms)},
          {"missed_ms", known(p.missed_ms)},
          {"seed", known(p.next_seed)},
          {"why", p.why.key}};
}

}  // namespace

const char* mode_to_start(TaskMode mode, bool guide) { return mode == TaskMode::test || !guide ? "test" : "practice"; }

Ordered curriculum_json(const Curriculum& c) {
  Ordered modules = Ordered::array(), warm_ups = Ordered::array();
  for (const Module& m : c.modules) {
    Ordered tasks = Ordered::array();
    for (const Task& t : m.tasks) tasks.push_back(task_json(t));
    modules.push_back({{"id", m.id},
                       {"title", m.title},
                       {"text", m.text},
                       {"needs", m.needs},
                       {"in_order", m.in_order},
                       {"tasks", std::move(tasks)}});
  }
  for (const WarmUp& w : c.warm_ups)
    warm_ups.push_back({{"task", w.task}, {"scene", w.scene}, {"text", w.text}, {"times", w.times}});
  return {{"title", c.title},
          {"text", c.text},
          {"modules", std::move(modules)},
          {"warm_ups", std::move(warm_ups)},
          {"content_hash", c.content_hash}};
}

Curriculum curriculum_of(const Json& j) {
  try {
    Curriculum c;
    c.title = j.at("title"), c.text = j.at("text"), c.content_hash = j.at("content_hash");
    for (const Json& m : j.at("modules")) {
      Module module;
      module.id = m.at("id"), module.title = m.at("title"), module.text = m.at("text");
      module.needs = m.at("needs").get<std::vector<std::string>>(), module.in_order = m.at("in_order");
      for (const Json& t : m.at("tasks")) module.tasks.push_back(task_of(t));
      c.modules.push_back(std::move(module));
    }
    for (const Json& w : j.at("warm_ups"))
      c.warm_ups.push_back({w.at("task"), w.at("scene"), w.at("text"), w.at("times")});
    return c;
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("this is no curriculum: {}", e.what()));
  }
}

Ordered progress_json(const Curriculum& c, const Progress& p) {
  Ordered modules = Ordered::array();
  for (std::size_t m = 0; m < p.modules.size(); ++m) {
    const Module& module = c.modules.at(m);
    Ordered tasks = Ordered::array();
    for (std::size_t t = 0; t < p.modules[m].tasks.size(); ++t)
      tasks.push_back(progress_of(module.tasks.at(t), p.modules[m].tasks[t]));
    modules.push_back({{"id", module.id},
                       {"title", module.title},
                       {"text", module.text},
                       {"standing", standing_name(p.modules[m].standing)},
                       {"locked_by", p.modules[m].locked_by},
                       {"tasks", std::move(tasks)}});
  }
  constexpr std::array<const char*, 4> kinds{"nothing", "warm_up", "repetition", "task"};
  const Recommendation& n = p.next;
  return {{"title", c.title},
          {"text", c.text},
          {"passed", p.passed},
          {"next",
           {{"kind", kinds[std::size_t(n.kind)]},
            {"task", n.task},
            {"scene", n.scene},
            {"start", mode_to_start(n.mode, n.guide)},
            {"seed", known(n.seed)},
            {"why", n.why.key},
            {"left", n.left}}},
          {"modules", std::move(modules)}};
}

}  // namespace insula::training
