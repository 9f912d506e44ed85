// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/real_time.h"

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/rehearsal.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/wall.h"
#include "tools/workbench/written_rates.h"

namespace insula::case_builder {
namespace {

constexpr int least_vertices = 900, in_steps_of = 50, most_times = 3;

/// With every contact of a tool at its limit, all of them on the walls.
SceneWork at_its_limits(SceneWork w) {
  const int more = w.max_rows - w.expected_rows;
  for (BodyWork& b : w.bodies) {
    if (!b.wall) continue;
    b.compliance_flops +=
        usual_compliance_flops(b.rows + more, b.solver, b.nodes) - usual_compliance_flops(b.rows, b.solver, b.nodes);
    b.rows += more;
  }
  w.expected_sweeps *= double(w.max_rows) / std::max(1, w.expected_rows);
  w.expected_rows = w.max_rows;
  return w;
}

}  // namespace

SceneWork work_of_clipping(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  progress.stage("scenes", 1);
  progress.step("counting the work of a step");
  LoadedScene scene(write_draft(folder, project, o), "exercise 3");
  scene.simulation().step();
  return count_work(scene.simulation());
}

Pace usual_pace() { return {server_core, 2, 0.5}; }

bool keeps_pace(const SceneWork& work, const Pace& pace) {
  const CostEstimate usual = estimate(work, pace.rates, pace.cores),
                     worst = estimate(at_its_limits(work), pace.rates, pace.cores);
  return usual.step_ms <= 1000 * pace.of_step * work.h && worst.step_ms + worst.refactor_ms <= 1000 * work.h;
}

SceneWork with_coarser_walls(SceneWork w, double share) {
  // A factor of a surface's mesh has n log n entries, and takes n^1.5 flops.
  const double entries = std::pow(share, 1.1), flops = std::pow(share, 1.5);
  for (BodyWork& b : w.bodies) {
    if (!b.wall) continue;
    const int less = b.nodes - int(std::lround(share * b.nodes));
    b.nodes -= less;
    b.elements = int(std::lround(share * b.elements));
    b.solver.factor_entries = std::int64_t(entries * double(b.solver.factor_entries));
    b.solver.factor_flops *= flops;
    b.compliance_flops *= entries;
    w.surface_vertices -= less;
    w.wall_vertices -= less;
  }
  return w;
}

std::optional<int> coarser_wall(const SceneWork& work, int vertices, const Pace& pace) {
  if (keeps_pace(work, pace)) return std::nullopt;
  for (int fewer = (vertices - 1) / in_steps_of * in_steps_of; fewer >= least_vertices; fewer -= in_steps_of)
    if (keeps_pace(with_coarser_walls(work, double(fewer) / vertices), pace)) return fewer;
  return std::nullopt;
}

bool keep_real_time(const CaseFolder& folder, const fs::path& project, Options& o, const Pace& pace,
                    Progress& progress) {
  const std::optional<int> at_first = o.coarser;
  for (int k = 0; k < most_times && !o.keep_vertices; ++k) {
    const std::optional<int> fewer =
        coarser_wall(work_of_clipping(folder, project, o, progress), o.wall_vertices(), pace);
    if (!fewer) break;
    const Options before = o;
    o.coarser = fewer;
    try {
      run_wall(folder, o, progress);
      run_place(folder, project, o, progress);
    } catch (const InputError&) {  // so coarse a wall crosses itself, or has no place
      o = before;
      run_wall(folder, o, progress);
      break;
    }
  }
  return o.coarser != at_first;
}

}  // namespace insula::case_builder
