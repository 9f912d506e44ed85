// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/perceptible_forces.h"

#include <algorithm>

namespace insula {

PerceptibleForces perceptible_forces(const RunRecorder& recorder, int hand) {
  PerceptibleForces out;
  std::vector<double> touch;
  double before = 0;
  for (const auto& s : recorder.samples()) {
    const double force = double(s.hand_force_N[std::size_t(hand)]), h = double(s.time_s) - before;
    before = double(s.time_s);
    out.largest_N = std::max(out.largest_N, force);
    if (force <= PerceptibleForces::touch_N) continue;
    out.touching_s += h;
    touch.push_back(force);
  }
  if (touch.empty()) return out;
  out.median_N = percentile(touch, 0.5);
  for (std::size_t d = 0; d < known_frictions.size(); ++d) {
    const double friction = known_frictions[d].friction_N;
    out.above[d].time_share =
        double(std::count_if(touch.begin(), touch.end(), [&](double f) { return f > friction; })) /
        double(touch.size());
    out.above[d].range_share = std::max(0.0, 1 - friction / out.largest_N);
    out.above[d].scale = friction / out.median_N;
  }
  return out;
}

}  // namespace insula
