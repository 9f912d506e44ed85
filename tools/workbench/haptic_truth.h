// SPDX-License-Identifier: GPL-3.0-or-later
// How true the servo's force is: against the full engine stepped at 1 kHz, on the same path of the devices.
//
// Both hands' devices go where a motion says, whatever the force, so that everything compared has the same input. The
// engine at rate R steps with h = 1/R; its step n ends at n h with the devices where they are then. Its problem reaches
// the servo `latency` later (one step, if the engine only just keeps up), and the servo solves it every millisecond
// until the next one.
#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "core/haptics/haptic_update.h"
#include "core/sim/motion.h"
#include "core/sim/simulation.h"
#include "haptic_server/servo.h"

namespace insula {

/// Force on each hand at the end of every millisecond, N, scene frame.
struct ForceTrace {
  std::array<std::vector<Vec3>, 2> force;
  /// Largest change in a tick beyond what the servo's own problem would have changed in it, mid-contact, N: what new
  /// problems jump by.
  std::array<double, 2> jump{0, 0};
  void add(const Vec3& left, const Vec3& right) {
    force[0].push_back(left);
    force[1].push_back(right);
  }
};

/// One step's problem as it goes over the wire, and what the engine itself made of the forces.
struct RecordedStep {
  HapticUpdate update;
  double pose_s = 0;  ///< simulated time of the devices' poses: the end of the step
  std::array<Vec3, 2> force{Vec3::Zero(), Vec3::Zero()};
};

/// The engine stepped at 1 kHz over `duration_s` of the motion. Throws InputError, as record_steps does, when the
/// engine refuses a command of the motion: what is measured would be something else.
ForceTrace reference_forces(Simulation& simulation, const Motion& motion, double duration_s);
/// Its problems at the rate of the simulation's own step, condensed, encoded and decoded as on the bus. Contacts are
/// turned to where tools are so long after the step (core/haptics/contact_frame_prediction.h); negative: as they were
/// in it. `patches`: with surface patches (core/haptics/surface_patch_builder.h).
std::vector<RecordedStep> record_steps(Simulation& simulation, const Motion& motion, double duration_s,
                                       double prediction_horizon_s = -1, bool patches = false);

enum class Rendering { servo, held, diagonal, hindsight };

struct ReplaySettings {
  Rendering rendering = Rendering::servo;
  ServoSettings servo;
  double latency_s = 0;
  /// Share of a step by which a problem may come later still, drawn anew for each (the same for the same run).
  double jitter = 0;
};

/// What the hands are given every millisecond. `held`: the engine's force until the next; `diagonal`: the servo with
/// the diagonal of W alone, each row for itself; `hindsight`: the engine's forces joined by straight lines, as one who
/// knows the next could.
ForceTrace replay(const std::vector<RecordedStep>& steps, const Motion& motion, double duration_s,
                  const ReplaySettings& settings);

struct TruthOfHand {
  double peak_N = 0;   ///< of the reference
  double rms = 0;      ///< of the error while either feels anything, over the peak
  double worst = 0;    ///< largest error over the peak
  double onset_s = 0;  ///< largest delay of a contact's onset, from nothing over 2 % of the peak; negative: early
  int onsets = 0;
  bool counts() const { return peak_N > 2e-3; }  ///< there was something to feel
};
/// `time_s,` then reference and rendered force of either hand, N.
void write_traces(const std::filesystem::path& file, const ForceTrace& reference, const ForceTrace& rendered);
TruthOfHand compare(const std::vector<Vec3>& reference, const std::vector<Vec3>& rendered);

}  // namespace insula
