// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/motion_metrics/speed_spectrum.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace insula {

void SpeedSpectrum::begin(double h) {
  if (h != h_)
    for (std::size_t k = 0; k < lines; ++k) {
      const double angle = -2 * std::numbers::pi * resolution_hz * double(k) * h;
      turn_.re[k] = std::cos(angle);
      turn_.im[k] = std::sin(angle);
    }
  h_ = h;
  sums_ = {};
  phase_.re.fill(1);
  phase_.im.fill(0);
}

void SpeedSpectrum::add(double speed) {
  for (std::size_t k = 0; k < lines; ++k) {
    const double re = phase_.re[k], im = phase_.im[k];
    sums_.re[k] += speed * re;
    sums_.im[k] += speed * im;
    phase_.re[k] = re * turn_.re[k] - im * turn_.im[k];
    phase_.im[k] = re * turn_.im[k] + im * turn_.re[k];
  }
}

double SpeedSpectrum::arc_length() const { return arc_length(sums_); }

double SpeedSpectrum::arc_length(const Sums& sums) {
  const double at_zero = std::hypot(sums.re[0], sums.im[0]);
  if (!(at_zero > 0)) return std::numeric_limits<double>::quiet_NaN();
  const auto amplitude = [&](std::size_t k) { return std::hypot(sums.re[k], sums.im[k]) / at_zero; };
  std::size_t last = lines - 1;
  while (last > 1 && amplitude(last) < least_amplitude) --last;
  double length = 0, before = 1;
  for (std::size_t k = 1; k <= last; ++k) {
    const double now = amplitude(k);
    length += std::hypot(1 / double(last), now - before);
    before = now;
  }
  return -length;
}

}  // namespace insula
