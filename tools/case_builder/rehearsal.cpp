// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/rehearsal.h"

#include <fmt/format.h>

#include <string>

#include "core/base/input_error.h"
#include "engine/live/headless.h"

namespace insula::case_builder {
namespace {

constexpr double after_the_hands = 3;  // s

}  // namespace

LoadedScene::LoadedScene(const fs::path& scene, const char* what) {
  register_builtin(registry_);
  auto loaded = load_simulation(scene, registry_, 1);
  if (!loaded.simulation) throw InputError(std::string(what) + " does not load:\n" + loaded.diagnostics.format());
  simulation_ = std::move(loaded.simulation);
}

Rehearsal::Rehearsal(const fs::path& scene, const char* what, bool to_the_end, const std::function<void(double)>& share)
    : scene_(scene, what) {
  Simulation& s = scene_.simulation();
  const Motion motion = load_motion(s.exercise()->motions().front()->file());
  HeadlessRun run(s, motion);
  const double end = motion.duration() + after_the_hands;
  while (s.time() < end && (to_the_end || s.exercise()->log().state() == ExerciseState::running)) {
    run.step();
    share(s.time() / end);
  }
}

std::string in_words(const FaultState& f) { return fmt::format("{} x \"{}\"", f.count, f.text); }

std::string in_words(const MeasureState& m) { return fmt::format("{} is {:.0f} {}", m.text, m.value, m.unit); }

void tell(std::string& told, const std::string& finding) { told += (told.empty() ? "" : ", ") + finding; }

}  // namespace insula::case_builder
