// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/input_error.h"
#include "engine/session/session_files.h"
#include "engine/session/session_format.h"
#include "engine/session/solver_devices.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

/// A folder for the restored scene.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::random_device random;
    do path_ = fs::temp_directory_path() / fmt::format("insula_rerun_{:08x}", random());
    while (!fs::create_directory(path_));
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

double change(double now, double before) {
  return std::abs(now - before) / std::max({std::abs(now), std::abs(before), 1e-12});
}

class Comparison {
 public:
  Comparison(RerunResult& result, double tolerance) : result_(result), tolerance_(tolerance) {}

  void compare(const Simulation& simulation, const insula_lcm::session_step_t& step) {
    if (!step.hashed) return;
    ++result_.compared;
    bool same = std::int64_t(simulation.state_hash()) == step.state_hash;
    if (!same && !result_.same_instructions) {
      simulation.body_sums(sums_);
      double largest = change(simulation.energy(), step.energy_J);
      if (sums_.size() != step.body_sum.size()) largest = INFINITY;
      else
        for (std::size_t i = 0; i < sums_.size(); ++i) largest = std::max(largest, change(sums_[i], step.body_sum[i]));
      result_.largest_change = std::max(result_.largest_change, largest);
      same = largest <= tolerance_;
    }
    if (same) return;
    if (++result_.different == 1) result_.first_different_s = double(step.number) * simulation.h();
  }

 private:
  RerunResult& result_;
  double tolerance_;
  std::vector<double> sums_;
};

}  // namespace

RerunResult rerun(SessionReader& session, const Registry& registry, const RerunSettings& settings,
                  const std::function<void(const Simulation&)>& after,
                  const std::function<void(const Simulation&)>& at_end) {
  std::vector<fs::path> places = settings.places;
  if (const std::string folder = session.about("scene_folder"); !folder.empty()) places.push_back(folder);
  const ScratchFolder scratch;
  const fs::path scene = restore_scene_files(session.container(), places, scratch.path());
  const double step_s = session.step_s();
  if (!(step_s >= 0 && step_s < 1)) throw InputError("the recording's step is out of range");
  const session::RepeatedSolvers solvers = session::repeat_solvers(session.container().descriptions().at("session"));
  LoadResult loaded = load_scene_edited_with_exercise_of(settings.rules, scene, registry, solvers.edits, step_s);
  std::unique_ptr<Simulation> made;
  if (loaded.scene) made = std::make_unique<Simulation>(std::move(loaded.scene), loaded.diagnostics, settings.threads);
  if (!made || !loaded.diagnostics.ok())
    throw InputError(std::string(settings.rules.empty() ? "the recorded scene has" : "with these rules the scene has") +
                     " errors:\n" + loaded.diagnostics.format());
  Simulation& simulation = *made;

  RerunResult result;
  result.missing_devices = solvers.missing;
  result.same_instructions =
      session.about("instruction_set") == session::instruction_set() && result.missing_devices.empty();
  if (result.same_instructions && session.about("start_hash") != session::hex(simulation.state_hash())) {
    result.broken = "the scene begins in another state than the recorded one: it was recorded by another version";
    return result;
  }
  simulation.repeat_factors();
  Comparison comparison(result, settings.tolerance);
  std::int64_t last = 0;
  session.steps([&](const insula_lcm::session_step_t& step) {
    if (step.number != last && step.number != last + 1) {
      result.broken = fmt::format("steps {} to {} are missing in the recording", last + 1, step.number - 1);
      return false;
    }
    if (step.number == last + 1) {
      last = step.number;
      for (const auto& input : step.input) simulation.give(input_of(input));
      simulation.step();
      ++result.steps;
      if (after) after(simulation);
    }
    comparison.compare(simulation, step);
    return true;
  });
  if (at_end && result.steps > 0) at_end(simulation);
  if (result.broken.empty() && session.damaged() > 0)
    result.broken = fmt::format("{} messages of the recording are not valid", session.damaged());
  if (result.broken.empty() && !session.container().damage().empty())
    result.broken = "the recording is damaged: " + session.container().damage().front();
  return result;
}

}  // namespace insula
