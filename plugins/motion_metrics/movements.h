// SPDX-License-Identifier: GPL-3.0-or-later
// The movements of a hand. A movement begins when the hand gets faster than a limit, and ends when it has been slower
// for a pause. Each one is judged for itself, since smoothness depends on duration and size.
#pragma once
#include <cstdint>

#include "plugins/motion_metrics/differences.h"
#include "plugins/motion_metrics/speed_spectrum.h"

namespace insula {

/// Sums over all movements, with the one that goes on.
struct MovementFigures {
  std::int64_t count = 0;
  double duration_s = 0, path_m = 0;
  double direct_m = 0;  ///< from the start to the end of each
  /// Sums over the movements that are long enough to be judged.
  std::int64_t judged = 0;
  double log_jerk = 0;    ///< log dimensionless jerk
  double arc_length = 0;  ///< spectral arc length
};

class Movements {
 public:
  static constexpr double least_judged_s = 0.2;  ///< duration of a movement that is judged for smoothness
  /// A longer movement is judged in pieces, since the spectrum resolves no slower change.
  static constexpr double longest_s = 10;

  /// speed: limit, m/s. pause: s.
  void limits(double speed, double pause);
  void add(const Differences& hand, double h);
  void reset();
  MovementFigures figures() const;

 private:
  /// One movement up to its last fast sample.
  struct Sums {
    double duration_s = 0, path_m = 0, peak_speed = 0;
    double jerk2 = 0;  ///< integral of the squared jerk, m2/s5
    Vec3 end = Vec3::Zero();
  };
  static void judge(const Sums& sums, const Vec3& start, const SpeedSpectrum::Sums& spectrum, MovementFigures& out);
  void end();

  double speed_limit_ = 0.005, pause_s_ = 0.2;
  bool moving_ = false;
  double slow_s_ = 0;  ///< since the last fast sample
  Vec3 start_ = Vec3::Zero();
  Sums now_, fast_;  ///< up to the last sample, and up to the last fast one
  SpeedSpectrum spectrum_;
  SpeedSpectrum::Sums fast_spectrum_;
  MovementFigures finished_;
};

}  // namespace insula
