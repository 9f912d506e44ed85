// SPDX-License-Identifier: GPL-3.0-or-later
// The course of arterial pressure over one heartbeat: steep rise, systolic peak, dicrotic notch and wave, slow decay.
#pragma once

namespace insula {

/// Six harmonics, scaled so that the minimum is 0 (at phase 0, the start of systole) and the maximum is 1.
class PulseWave {
 public:
  PulseWave();
  double value(double phase) const;      ///< 0..1; periodic with period 1
  double mean() const { return mean_; }  ///< mean of a beat: exactly the constant term
  double peak() const { return peak_; }  ///< phase of the greatest value

 private:
  double start_ = 0, low_ = 0, scale_ = 1, mean_ = 0, peak_ = 0;
};

}  // namespace insula
