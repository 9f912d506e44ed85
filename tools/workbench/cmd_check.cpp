// SPDX-License-Identifier: GPL-3.0-or-later
// insula check FILE...: scenes and curricula
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "core/mechanics/deformable_body.h"
#include "core/scene/loader.h"
#include "core/sim/settings.h"
#include "core/sim/simulation.h"
#include "engine/authoring/curriculum_sources.h"
#include "engine/live/scene_devices.h"
#include "tools/workbench/cost_model.h"
#include "tools/workbench/workbench.h"
#include "training/curriculum/loader.h"

namespace insula {
namespace {

/// What a step will cost on this machine, and what to do when it is too much.
std::string cost_text(const std::string& file, Simulation& simulation, const CostRates& rates) {
  simulation.step();  // rows that stand
  const SceneWork work = count_work(simulation);
  const int threads = simulation.workers().threads();
  const CostEstimate e = estimate(work, rates, threads);
  std::string out =
      fmt::format("  needs about {:.{}f} ms a step of {:.1f} ms on {} thread{}, at {} rows of {}; most of it is {}\n",
                  e.step_ms, e.step_ms < 10 ? 1 : 0, 1000 * work.h, threads, threads == 1 ? "" : "s",
                  work.expected_rows, work.max_rows, e.most);
  if (e.refactor_ms > 0.25 * e.step_ms)
    out += fmt::format("  and {:.1f} ms more in a step that makes a kept factor anew\n", e.refactor_ms);
  if (e.step_ms <= 1000 * work.h) return out;
  out += fmt::format("{}: warning: too slow for this machine by a factor of {:.1f}: it would run slower than life\n",
                     file, e.step_ms / (1000 * work.h));
  for (const std::string& a : e.advice) out += "  " + a + "\n";
  return out;
}

/// One scene: loaded, and put together as for a run, since some mistakes show only there. `good` gets the simulation
/// and the time, s, for which the scene wants to settle.
void put_together(const std::filesystem::path& file, const Registry& registry, Diagnostics& diagnostics, bool settle,
                  const std::function<void(Simulation&, double)>& good) {
  auto loaded = load_scene(file, registry);
  diagnostics = std::move(loaded.diagnostics);
  if (!loaded.scene) return;
  check_scene_devices(*loaded.scene, diagnostics);
  double settling = 0;
  for (SettleSettings* s : loaded.scene->all<SettleSettings>()) {
    settling = s->time();
    if (!settle) s->time.set(0);
  }
  try {
    Simulation simulation(std::move(loaded.scene), diagnostics);
    if (diagnostics.ok()) good(simulation, settling);
  } catch (const std::exception& e) {
    diagnostics.error({file.generic_string(), 0, 0}, e.what());
  }
  diagnostics.sort_by_position();
}

/// Returns the lines to print.
std::string check_one(const std::filesystem::path& file, const Registry& registry, Diagnostics& diagnostics,
                      std::optional<CostRates>& rates, bool settle) {
  std::string lines;
  put_together(file, registry, diagnostics, settle, [&](Simulation& simulation, double settling) {
    const Scene& scene = simulation.scene();
    const auto& components = scene.components();
    const auto bodies =
        std::count_if(components.begin(), components.end(), [](const Component* c) { return c->kind == Kind::body; });
    lines = fmt::format("{}: ok, {} components, {} bodies, content {:016x}\n", file.generic_string(), components.size(),
                        bodies, scene.content_hash());
    if (settling > 0 && !settle) {
      lines += fmt::format("  settles for {:.3g} s first; with --settle it does so, and the cost of a step is told\n",
                           settling);
    } else if (!scene.all<DeformableBody>().empty()) {
      if (!rates) rates = measure_rates(registry);
      lines += cost_text(file.generic_string(), simulation, *rates);
    }
  });
  return diagnostics.ok() ? lines : std::string();
}

/// One curriculum, with the scenes and bands that it names.
std::string check_curriculum(const std::filesystem::path& file, CurriculumFiles& sources, Diagnostics& diagnostics) {
  auto loaded = load_curriculum(file, sources);
  diagnostics = std::move(loaded.diagnostics);
  if (!loaded.curriculum) return {};
  std::size_t tasks = 0, gates = 0;
  for (const Module& module : loaded.curriculum->modules)
    for (const Task& task : module.tasks) {
      ++tasks;
      gates += task.gates.size();
    }
  return fmt::format("{}: ok, a curriculum of {} module{}, {} task{}, {} gate{}, content {:016x}\n",
                     file.generic_string(), loaded.curriculum->modules.size(),
                     loaded.curriculum->modules.size() == 1 ? "" : "s", tasks, tasks == 1 ? "" : "s", gates,
                     gates == 1 ? "" : "s", loaded.curriculum->content_hash);
}

}  // namespace

int cmd_check(const CommandContext& context, const std::vector<std::filesystem::path>& files, bool settle) {
  int status = 0;
  std::optional<CostRates> rates;
  CurriculumFiles sources(context.registry);
  for (const auto& file : files) {
    Diagnostics diagnostics;
    const std::string lines = is_curriculum_file(file) ? check_curriculum(file, sources, diagnostics)
                                                       : check_one(file, context.registry, diagnostics, rates, settle);
    context.err << diagnostics.format();
    if (lines.empty()) status = 2;
    context.out << lines;
  }
  return status;
}

int cmd_check_json(const CommandContext& context, const std::vector<std::filesystem::path>& files) {
  auto problems = nlohmann::ordered_json::array();
  bool ok = true;
  CurriculumFiles sources(context.registry);
  for (const auto& file : files) {
    Diagnostics diagnostics;
    if (is_curriculum_file(file)) check_curriculum(file, sources, diagnostics);
    else put_together(file, context.registry, diagnostics, false, [](Simulation&, double) {});
    ok = ok && diagnostics.ok();
    for (const Diagnostic& d : diagnostics.all())
      problems.push_back({{"severity", d.severity == Severity::error ? "error" : "warning"},
                          {"file", d.pos.file},
                          {"line", d.pos.line},
                          {"column", d.pos.column},
                          {"text", d.text},
                          {"nearest", proposed_name(d.text)}});
  }
  context.out << nlohmann::ordered_json{{"ok", ok}, {"problems", problems}}.dump(
                     1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
  return ok ? 0 : 2;
}

}  // namespace insula
