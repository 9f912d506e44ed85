// SPDX-License-Identifier: GPL-3.0-or-later
// Fourier series of a carotid pulse: percussion, tidal and dicrotic wave as bell curves, cut off after six harmonics.
#include "plugins/pressure/waveform.h"

#include <array>
#include <cmath>
#include <numbers>

namespace insula {
namespace {

struct Harmonic {
  double cosine, sine;
};
constexpr std::array<Harmonic, 6> harmonics{{{-0.059755949772, 0.388733563156},
                                             {-0.152724292086, 0.134280201157},
                                             {-0.117595351677, -0.032862145825},
                                             {-0.016026495300, -0.023500777921},
                                             {0.004775329467, -0.031285213719},
                                             {0.009191555823, 0.004088268991}}};

// The series (order 0) and its first two derivatives.
double series(double phase, int order) {
  double sum = 0;
  for (std::size_t k = 0; k < harmonics.size(); ++k) {
    const double w = 2 * std::numbers::pi * double(k + 1), a = w * phase;
    const auto [c, s] = harmonics[k];
    if (order == 0) sum += c * std::cos(a) + s * std::sin(a);
    else if (order == 1) sum += w * (s * std::cos(a) - c * std::sin(a));
    else sum -= w * w * (c * std::cos(a) + s * std::sin(a));
  }
  return sum;
}

// Phase of the extreme value: the best of a grid, refined by Newton's method on the derivative.
double extreme(double sign) {
  constexpr int n = 720;
  int best = 0;
  for (int i = 1; i < n; ++i)
    if (sign * series(double(i) / n, 0) > sign * series(double(best) / n, 0)) best = i;
  double phase = double(best) / n;
  for (int i = 0; i < 20; ++i) phase -= series(phase, 1) / series(phase, 2);
  return phase;
}

}  // namespace

PulseWave::PulseWave() {
  start_ = extreme(-1);
  const double top = extreme(1);
  low_ = series(start_, 0);
  scale_ = 1 / (series(top, 0) - low_);
  mean_ = -low_ * scale_;
  peak_ = top - start_ - std::floor(top - start_);
}

double PulseWave::value(double phase) const { return (series(phase + start_, 0) - low_) * scale_; }

}  // namespace insula
