// SPDX-License-Identifier: GPL-3.0-or-later
// An exercise of the case, loaded and played, and what its log says in words.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/registry/registry.h"
#include "core/sim/exercise.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// On one thread, so that several can run at a time.
class LoadedScene {
 public:
  /// Throws InputError if the scene does not load; `what` names it.
  LoadedScene(const fs::path& scene, const char* what);
  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }

 private:
  Registry registry_;
  std::unique_ptr<Simulation> simulation_;
};

/// Played with its first motion.
class Rehearsal {
 public:
  /// Plays the exercise until three seconds after its hands, so that goals may still be held. to_the_end: goes on after
  /// the exercise is over. share: gets how much is done, 0..1. Throws InputError if the scene does not load; `what`
  /// names it.
  Rehearsal(const fs::path& scene, const char* what, bool to_the_end, const std::function<void(double)>& share);
  /// As it is at the end.
  const Simulation& simulation() const { return scene_.simulation(); }

 private:
  LoadedScene scene_;
};

/// "2 x "Too much force on the vessel"", "Neck remnant is 40 %".
std::string in_words(const FaultState& fault);
std::string in_words(const MeasureState& measure);
/// Adds a finding to a list of them in words.
void tell(std::string& told, const std::string& finding);

}  // namespace insula::case_builder
