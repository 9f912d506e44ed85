// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/measured_scene.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "core/mechanics/deformable_body.h"
#include "core/mechanics/rigid_body.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "engine/live/headless.h"

namespace insula::case_builder {
namespace {

/// Median and 95th percentile.
std::pair<double, double> median_and_most(std::vector<double> times) {
  if (times.empty()) return {0, 0};
  std::sort(times.begin(), times.end());
  return {times[times.size() / 2], times[std::size_t(0.95 * double(times.size() - 1))]};
}

bool clip_touches_vessel(const StepReport& r) {
  return std::any_of(r.contacts.begin(), r.contacts.end(), [](const ContactPoint& c) {
    const auto is_clip = [](const Body* b) {
      const auto* rigid = dynamic_cast<const RigidBody*>(b);
      return rigid && rigid->implant();
    };
    const bool vessel = dynamic_cast<const ShellBody*>(c.a) || dynamic_cast<const ShellBody*>(c.b);
    return vessel && (is_clip(c.a) || is_clip(c.b));
  });
}

}  // namespace

MeasuredMotion measure_motion(const fs::path& scene, double longest) {
  Registry registry;
  register_builtin(registry);
  const auto loaded = load_simulation(scene, registry);
  MeasuredMotion out;
  if (!loaded.simulation || !loaded.simulation->exercise() || loaded.simulation->exercise()->motions().empty())
    return out;
  Simulation& s = *loaded.simulation;
  const Motion motion = load_motion(s.exercise()->motions().front()->file());
  HeadlessRun run(s, motion);
  std::vector<double> times;
  double until = longest;
  while (s.time() < until) {
    const auto begin = std::chrono::steady_clock::now();
    run.step();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count() - run.haptic_ms();
    for (const Event& e : s.events())
      if (e.kind == "clip_released") until = std::min(until, s.time() + 0.5);
    if (!clip_touches_vessel(s.report())) continue;
    times.push_back(ms);
    out.rows = std::max(out.rows, s.report().rows);
  }
  out.steps = int(times.size());
  std::tie(out.step_ms, out.max_ms) = median_and_most(std::move(times));
  return out;
}

MeasuredScene measure_scene(const fs::path& scene, int steps) {
  MeasuredScene out;
  out.file = scene.filename().string();
  Registry registry;
  register_builtin(registry);
  const auto loaded = load_simulation(scene, registry);
  if (!loaded.simulation) {
    out.message = loaded.diagnostics.format();
    return out;
  }
  Simulation& s = *loaded.simulation;
  for (const Body* b : s.bodies())
    if (const auto* d = dynamic_cast<const DeformableBody*>(b)) out.nodes += d->nodes();
  out.budget_ms = 1000 * s.h();
  std::vector<double> times;
  for (int i = 0; i < steps; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    s.step();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    out.finite = out.finite && s.report().finite;
    out.rows = std::max(out.rows, s.report().rows);
    if (i == 0) out.standing = standing_of(s);
  }
  std::tie(out.step_ms, out.max_ms) = median_and_most(std::move(times));
  return out;
}

}  // namespace insula::case_builder
