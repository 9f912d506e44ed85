// SPDX-License-Identifier: GPL-3.0-or-later
// insula people progress: a person's standing in a curriculum.
#include <fmt/ostream.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "engine/authoring/curriculum_sources.h"
#include "engine/command_line/people.h"
#include "engine/reports/attempts.h"
#include "training/curriculum/evaluate.h"
#include "training/curriculum/loader.h"
#include "training/store/data_folder.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;

struct Now {
  std::int64_t ms = 0;            ///< UTC
  std::chrono::minutes offset{};  ///< of local time
};

Now now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm local{};
  localtime_r(&seconds, &local);
  return {1000 * std::int64_t(seconds), std::chrono::minutes(local.tm_gmtoff / 60)};
}

Json task_json(const TaskProgress& t) {
  Json gates = Json::array();
  for (const GateProgress& g : t.gates)
    gates.push_back({{"text", g.text}, {"in_a_row", g.in_a_row}, {"needed", g.needed}, {"met", g.met}});
  const auto known = [](const auto& value) { return value ? Json(*value) : Json(); };
  return {{"id", t.id},
          {"standing", standing_name(t.standing)},
          {"locked_by", t.locked_by},
          {"gates", std::move(gates)},
          {"attempts", t.attempts},
          {"attempts_to_level", known(t.attempts_to_level)},
          {"passed_ms", known(t.passed_ms)},
          {"due_ms", known(t.due_ms)},
          {"why", t.why.text}};
}

Json progress_json(const Progress& p) {
  Json modules = Json::array();
  for (const ModuleProgress& m : p.modules) {
    Json tasks = Json::array();
    for (const TaskProgress& t : m.tasks) tasks.push_back(task_json(t));
    modules.push_back({{"id", m.id},
                       {"standing", standing_name(m.standing)},
                       {"locked_by", m.locked_by},
                       {"tasks", std::move(tasks)}});
  }
  return {{"passed", p.passed},
          {"next", {{"task", p.next.task}, {"scene", p.next.scene}, {"why", p.next.why.text}}},
          {"modules", std::move(modules)}};
}

void print(std::ostream& out, const Curriculum& curriculum, const Progress& p) {
  fmt::print(out, "{}\n", curriculum.title);
  for (std::size_t i = 0; i < p.modules.size(); ++i) {
    fmt::print(out, "\n{:<8} {}\n", standing_name(p.modules[i].standing), curriculum.modules[i].title);
    for (std::size_t k = 0; k < p.modules[i].tasks.size(); ++k) {
      const TaskProgress& t = p.modules[i].tasks[k];
      fmt::print(out, "  {:<8} {} ({} attempt{})\n", standing_name(t.standing), curriculum.modules[i].tasks[k].title,
                 t.attempts, t.attempts == 1 ? "" : "s");
      for (const GateProgress& g : t.gates)
        fmt::print(out, "           {} {} of {}: {}\n", g.met ? "x" : "-", g.in_a_row, g.needed, g.text);
    }
  }
  fmt::print(out, "\nnext: {}\n", p.next.why.text);
  if (!p.next.scene.empty()) fmt::print(out, "      insula play {}\n", p.next.scene);
}

}  // namespace

int cmd_people_progress(const CommandContext& context, const PeopleOptions& o) {
  CurriculumFiles sources(context.registry);
  const CurriculumResult loaded = load_curriculum(o.curriculum, sources);
  fmt::print(context.err, "{}", loaded.diagnostics.format());
  if (!loaded.curriculum) return 2;
  const training::Store store(training::data_folder(o.data).store());
  if (!store.find(o.pseudonym)) {
    fmt::print(context.err, "error: nobody has the pseudonym {}\n", in_quotes(o.pseudonym));
    return 2;
  }
  const Now at = now();
  const Progress progress = evaluate(*loaded.curriculum, attempts_of(store, o.pseudonym), at.ms, at.offset);
  if (o.json) fmt::print(context.out, "{}\n", progress_json(progress).dump(2));
  else print(context.out, *loaded.curriculum, progress);
  return 0;
}

}  // namespace insula
