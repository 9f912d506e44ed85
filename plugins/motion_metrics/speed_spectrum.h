// SPDX-License-Identifier: GPL-3.0-or-later
// Spectral arc length of a speed profile: S. Balasubramanian, A. Melendez-Calderon, A. Roby-Brami, E. Burdet, "On the
// analysis of movement smoothness", J. NeuroEng. Rehabil. 12:112, 2015. It is the negative length of the amplitude
// spectrum, divided by its value at 0 Hz, over the frequency divided by the largest frequency. Smoother: nearer to 0.
//
// The spectrum is summed sample by sample, so a movement needs no memory for its samples.
#pragma once
#include <array>

namespace insula {

class SpeedSpectrum {
 public:
  static constexpr double largest_hz = 10;         ///< as in the paper
  static constexpr double least_amplitude = 0.05;  ///< of that at 0 Hz; the spectrum ends where it stays below
  static constexpr double resolution_hz = 0.02;
  static constexpr int lines = int(largest_hz / resolution_hz + 0.5) + 1;

  /// For samples at an interval of h seconds.
  void begin(double h);
  void add(double speed);
  /// NaN without a movement.
  double arc_length() const;

  /// The sums alone, to return to.
  struct Sums {
    std::array<double, lines> re{}, im{};
  };
  const Sums& sums() const { return sums_; }
  static double arc_length(const Sums& sums);

 private:
  double h_ = 0;
  Sums sums_, turn_, phase_;  ///< turn_: of the phase in a sample
};

}  // namespace insula
