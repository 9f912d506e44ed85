// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/dissection_script.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "tools/motions/surgeon.h"

namespace insula::case_builder {
namespace {

constexpr int max_strands = 24;       // what a trainee divides in some minutes
constexpr double step_outward = 0.7;  // mm
constexpr int max_steps = 5;

/// Slower than a skilled hand, quicker than the shipped exercise's.
constexpr Pace pace{.stroke = 0.12,
                    .stroke_per_m = 70,
                    .travel = 0.028,
                    .turn = 3.5,
                    .at_least = 0.2,
                    .enter = 1.6,
                    .until_severed = true};

void write_exercises(const SceneFacts& f, const CaseFolder& folder) {
  for (int k = folder.opening.empty() ? 2 : 1; k <= 4; ++k) write_text(exercise_file(folder, k), exercise(f, k));
}

/// Leaves out a kind of strand for which there is no place. False: that was not what is wrong.
bool leave_out(SceneFacts& f, const std::string& text, std::vector<Note>& notes) {
  for (std::size_t i = 0; i < f.strand_sets.size(); ++i) {
    // Only messages with the line of a strand element concern its set of strands.
    std::string before = exercise(f, 2);
    const std::size_t at = before.find("id=\"to_" + f.strand_sets[i]);
    if (at == std::string::npos) continue;  // its author has left it out
    before.resize(at);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    if (text.find(fmt::format("2_aneurysm_dissection.xml:{}:", line)) == std::string::npos) continue;
    notes.push_back(problem("no_place_for_strands", "There is no place for strands to the " + f.strand_sets[i] + ".",
                            "They were left out; give another ball or max_length in 2_aneurysm_dissection.xml."));
    const std::string gone = "to_" + f.strand_sets[i];
    std::erase_if(f.rules, [&](const RuleChange& c) {
      return c.exercise == 2 && (c.rule == gone || c.rule == "membrane_" + gone);
    });
    f.strand_sets.erase(f.strand_sets.begin() + std::ptrdiff_t(i));
    return true;
  }
  return false;
}

/// The loaded exercise with strands, and the scripted hands that can divide them.
struct LoadedExercise {
  SimulationResult loaded;
  std::unique_ptr<Surgeon> surgeon;
};

/// Chooses the strands so that their number is suitable and the hands reach all of them. Strands join the surfaces in
/// their settled state, so each choice is tested in the running scene.
class StrandChoice {
 public:
  StrandChoice(SceneFacts& f, const CaseFolder& folder, const Registry& registry, std::vector<Note>& notes)
      : f_(f), folder_(folder), registry_(registry), notes_(notes) {}

  LoadedExercise choose() {
    LoadedExercise now;
    for (;;) {
      if (!load(now) || changed_number(now)) continue;
      const int hidden = int(now.surgeon->out_of_reach().size());
      if (hidden == 0 || moved_ == max_steps) {
        tell(int(now.surgeon->strands().size()), hidden);
        return now;
      }
      f_.strand_shift = step_outward * ++moved_;
    }
  }

 private:
  /// Loads the exercise. False if one set of strands did not fit and was left out.
  bool load(LoadedExercise& to) {
    write_exercises(f_, folder_);
    to.surgeon.reset();
    to.loaded = load_simulation(exercise_file(folder_, 2), registry_, 1);
    if (to.loaded.simulation) {
      to.surgeon = std::make_unique<Surgeon>(*to.loaded.simulation);
      return true;
    }
    const std::string text = to.loaded.diagnostics.format();
    if (!leave_out(f_, text, notes_) || f_.strand_sets.empty())
      throw InputError("the exercise with strands does not load:\n" + text);
    return false;
  }
  /// Reduces the share of strands if there are too many. Increases it once if the move outward has left too few.
  bool changed_number(const LoadedExercise& now) {
    const int count = int(now.surgeon->strands().size());
    const bool many = count > max_strands && f_.strand_share == 1,
               few = moved_ > 0 && count > 0 && count < max_strands / 2 && f_.strand_share < 1 && !made_up_;
    if (!many && !few) return false;
    f_.strand_share = std::min(1.0, f_.strand_share * (many ? max_strands : 2 * max_strands / 3) / count);
    made_up_ = made_up_ || few;
    return true;
  }
  void tell(int count, int hidden) {
    notes_.push_back({Note::Kind::fact, fmt::format("{} strands tie the aneurysm down.", count), ""});
    if (hidden > 0)
      notes_.push_back(problem("strands_out_of_reach",
                               fmt::format("{} of them are out of the dissector's reach.", hidden),
                               "Give the strands another ball in 2_aneurysm_dissection.xml, nearer to the surgeon."));
  }

  SceneFacts& f_;
  const CaseFolder& folder_;
  const Registry& registry_;
  std::vector<Note>& notes_;
  int moved_ = 0;  ///< number of steps outward
  bool made_up_ = false;
};

/// Divides the strands with scripted hands and writes their motion. Returns how many strands remain.
int divide_strands(Surgeon& surgeon, const fs::path& motion, Progress& progress) {
  const int count = int(surgeon.strands().size());
  const int standing = surgeon.divide(pace, [&](const Sweep&, int) {
    const int left = int(std::count_if(surgeon.strands().begin(), surgeon.strands().end(),
                                       [](const StrandState& s) { return s.integrity >= 0; }));
    progress.share(1 - double(left) / std::max(1, count));
  });
  surgeon.write(motion);
  return standing;
}

}  // namespace

void spin_strands(SceneFacts& f, const CaseFolder& folder, bool rehearse, std::vector<Note>& notes,
                  Progress& progress) {
  progress.step("spinning strands");
  Registry registry;
  register_builtin(registry);
  const fs::path motion = folder.path / "2_aneurysm_dissection_steady.csv";
  std::error_code ignored;
  fs::remove(motion, ignored);
  f.strand_sets = all_strand_sets(f.approach);
  f.rehearsed = false;
  const LoadedExercise exercise = StrandChoice(f, folder, registry, notes).choose();
  if (!rehearse) return;

  progress.step("rehearsing the dissection");
  const int count = int(exercise.surgeon->strands().size());
  const int standing = divide_strands(*exercise.surgeon, motion, progress);
  f.rehearsed = true;
  write_exercises(f, folder);
  if (standing > 0)
    notes.push_back(problem(
        "strands_left", fmt::format("The scripted hands leave {} of {} strands in exercise 2.", standing, count),
        "They are out of reach from the surgeon's side: give the strands another ball in 2_aneurysm_dissection.xml."));
}

}  // namespace insula::case_builder
