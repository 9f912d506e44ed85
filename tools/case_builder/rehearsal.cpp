// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/rehearsal.h"

#include <string>

#include "core/base/input_error.h"
#include "engine/live/headless.h"

namespace insula::case_builder {
namespace {

constexpr double after_the_hands = 3;  // s

}  // namespace

Rehearsal::Rehearsal(const fs::path& scene, const char* what, bool to_the_end,
                     const std::function<void(double)>& share) {
  register_builtin(registry_);
  auto loaded = load_simulation(scene, registry_, 1);
  if (!loaded.simulation) throw InputError(std::string(what) + " does not load:\n" + loaded.diagnostics.format());
  simulation_ = std::move(loaded.simulation);
  Simulation& s = *simulation_;
  const Motion motion = load_motion(s.exercise()->motions().front()->file());
  HeadlessRun run(s, motion);
  const double end = motion.duration() + after_the_hands;
  while (s.time() < end && (to_the_end || s.exercise()->log().state() == ExerciseState::running)) {
    run.step();
    share(s.time() / end);
  }
}

}  // namespace insula::case_builder
