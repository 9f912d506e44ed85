// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/soft_guiding.h"

#include "core/sim/exercise.h"

namespace insula {

namespace {

/// The cue that was given in this step; null: none.
const Cue* new_cue(const Simulation& simulation) {
  const GivesCues* tutor = simulation.exercise() ? tutor_of(*simulation.exercise()) : nullptr;
  if (!tutor || tutor->cues().empty()) return nullptr;
  const Cue& last = tutor->cues().back();
  return last.time > simulation.time() - 0.5 * simulation.h() ? &last : nullptr;
}

}  // namespace

const std::optional<HandGuiding>& SoftGuiding::step(const Simulation& simulation, SessionMode mode) {
  const Cue* cue = new_cue(simulation);
  const double time = simulation.time(), since = time - began_s_;
  const bool may = chosen_ && mode == SessionMode::practice && simulation.exercise() &&
                   simulation.exercise()->log().state() == ExerciseState::running;
  if (!may || since < 0 || since >= duration_s) now_.reset();
  if (may && cue && cue->cause.hand >= 0 && !cue->cause.away.isZero(0)) {
    now_ = HandGuiding{++number_, cue->cause.hand, cue->cause.away};
    began_s_ = time;
  }
  return now_;
}

}  // namespace insula
