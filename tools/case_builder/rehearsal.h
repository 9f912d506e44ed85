// SPDX-License-Identifier: GPL-3.0-or-later
// An exercise of the case, played with its first motion.
#pragma once
#include <functional>
#include <memory>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

class Rehearsal {
 public:
  /// Plays the exercise until three seconds after its hands, so that goals may still be held. to_the_end: goes on after
  /// the exercise is over. share: gets how much is done, 0..1. Throws InputError if the scene does not load; `what`
  /// names it.
  Rehearsal(const fs::path& scene, const char* what, bool to_the_end, const std::function<void(double)>& share);
  /// As it is at the end.
  const Simulation& simulation() const { return *simulation_; }

 private:
  Registry registry_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace insula::case_builder
