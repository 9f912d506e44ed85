// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a written motion through both simulated arms and says what came of it.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "core/base/input_error.h"
#include "core/registry/registry.h"
#include "core/sim/channel_sum.h"
#include "engine/live/headless.h"

namespace insula {

namespace fs = std::filesystem;

inline std::unique_ptr<Simulation> load(const fs::path& scene) {
  Registry registry;
  register_builtin(registry);
  SimulationResult loaded = load_simulation(scene, registry, 1);
  if (!loaded.simulation) throw InputError(loaded.diagnostics.format());
  return std::move(loaded.simulation);
}

/// Plays a motion as `insula run` does and says what came of it.
inline void play(const fs::path& scene, const fs::path& file) {
  const auto s = load(scene);
  const Motion motion = load_motion(file);
  HeadlessRun run(*s, motion);
  double press[2] = {0, 0};
  std::string events;
  while (s->time() < motion.duration() + 0.5) {
    run.step();
    for (const ToolReport& t : s->report().tools)
      if (t.hand >= 0) press[t.hand] = std::max(press[t.hand], t.contact_force);
    for (const Event& e : s->events())
      if (e.kind == "rupture" || e.kind == "strand_torn")
        events += fmt::format("  {:.2f} s {} {} {:.3f}\n", e.time, e.kind, e.text, e.value);
  }
  std::printf("%s: %.1f s, %.0f of %.0f strands stand, largest contact force left %.3f N, right %.3f N\n%s",
              file.c_str(), motion.duration(), channel_sum(*s, "standing"), channel_sum(*s, "total"), press[0],
              press[1], events.c_str());
  if (!s->exercise()) return;
  for (const GoalState& g : s->exercise()->log().goals())
    std::printf("  goal %s %s %.1f s\n", g.id.c_str(), g.done ? "reached at" : "open", g.time);
  for (const FaultState& f : s->exercise()->log().faults()) std::printf("  fault %s %d\n", f.id.c_str(), f.count);
}

}  // namespace insula
