// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/opening_play.h"
#include "core/sim/channel_sum.h"

#include <fmt/format.h>

#include "core/base/input_error.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "engine/live/headless.h"

namespace insula::case_builder {
namespace {

constexpr double after_the_hands = 3;  // s, that goals may still be held

/// What went wrong, in words; empty: it was done without a fault.
std::string complaint(const fs::path& scene, Progress& progress) {
  Registry registry;
  register_builtin(registry);
  const auto loaded = load_simulation(scene, registry, 1);
  if (!loaded.simulation) throw InputError("the opening of the fissure does not load:\n" + loaded.diagnostics.format());
  Simulation& s = *loaded.simulation;
  const Motion motion = load_motion(s.exercise()->motions().front()->file());
  HeadlessRun run(s, motion);
  const double end = motion.duration() + after_the_hands;
  while (s.time() < end && s.exercise()->log().state() == ExerciseState::running) {
    run.step();
    progress.share(s.time() / end);
  }
  std::string out;
  if (s.exercise()->log().state() != ExerciseState::done)
    out = fmt::format("{:.0f} of {:.0f} strands stand at the end", channel_sum(s, "standing"), channel_sum(s, "total"));
  for (const FaultState& f : s.exercise()->log().faults())
    if (f.count > 0) out += fmt::format("{}{} x \"{}\"", out.empty() ? "" : ", ", f.count, f.text);
  return out;
}

}  // namespace

void try_opening(SceneFacts& f, const CaseFolder& folder, bool rehearse, std::vector<Note>& notes, Progress& progress) {
  const fs::path scene = exercise_files(folder)[0];
  const auto write = [&](bool hands) {
    f.opened = hands;
    write_text(scene, exercise(f, 1));
  };
  write(rehearse);
  if (rehearse) {
    progress.step("playing the opening");
    const std::string wrong = complaint(scene, progress);
    if (wrong.empty()) return;
    notes.push_back({Note::Kind::problem,
                     "The scripted hands of exercise 1 are those of the shipped lobes; in this fissure: " + wrong + ".",
                     "They were left out. Open it by hand."});
    write(false);
  }
  std::error_code ignored;
  fs::remove(folder.path / "1_sylvian_fissure_steady.csv", ignored);
}

}  // namespace insula::case_builder
