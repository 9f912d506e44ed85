// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/opening_play.h"

#include <fmt/format.h>

#include "core/sim/channel_sum.h"
#include "tools/case_builder/rehearsal.h"

namespace insula::case_builder {
namespace {

/// What went wrong, in words; empty: it was done without a fault.
std::string complaint(const fs::path& scene, Progress& progress) {
  const Rehearsal played(scene, "the opening of the fissure", false, [&](double done) { progress.share(done); });
  const Simulation& s = played.simulation();
  std::string out;
  if (s.exercise()->log().state() != ExerciseState::done)
    out = fmt::format("{:.0f} of {:.0f} strands stand at the end", channel_sum(s, "standing"), channel_sum(s, "total"));
  for (const FaultState& f : s.exercise()->log().faults())
    if (f.count > 0) tell(out, in_words(f));
  return out;
}

}  // namespace

void try_opening(SceneFacts& f, const CaseFolder& folder, bool rehearse, std::vector<Note>& notes, Progress& progress) {
  const fs::path scene = exercise_file(folder, 1);
  const auto write = [&](bool hands) {
    f.opened = hands;
    write_text(scene, exercise(f, 1));
  };
  write(rehearse);
  if (rehearse) {
    progress.step("playing the opening");
    const std::string wrong = complaint(scene, progress);
    if (wrong.empty()) return;
    notes.push_back(
        problem("opening_motion_fails",
                "The scripted hands of exercise 1 are those of the shipped lobes; in this fissure: " + wrong + ".",
                "They were left out. Open it by hand."));
    write(false);
  }
  std::error_code ignored;
  fs::remove(folder.path / (f.approach.opening.file + "_steady.csv"), ignored);
}

}  // namespace insula::case_builder
