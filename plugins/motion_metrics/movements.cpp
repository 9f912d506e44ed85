// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/motion_metrics/movements.h"

#include <algorithm>
#include <cmath>

namespace insula {

void Movements::limits(double speed, double pause) {
  speed_limit_ = speed;
  pause_s_ = pause;
}

void Movements::add(const Differences& hand, double h) {
  if (!hand.has_velocity()) return end();
  const double speed = hand.speed();
  const bool fast = speed > speed_limit_;
  if (!moving_) {
    if (!fast) return;
    moving_ = true;
    start_ = hand.position() - h * hand.velocity();
    now_ = {};
    spectrum_.begin(h);
  }
  now_.duration_s += h;
  now_.path_m += h * speed;
  now_.peak_speed = std::max(now_.peak_speed, speed);
  if (hand.has_jerk()) now_.jerk2 += h * hand.jerk().squaredNorm();
  now_.end = hand.position();
  spectrum_.add(speed);
  slow_s_ = fast ? 0 : slow_s_ + h;
  if (fast) {
    fast_ = now_;
    fast_spectrum_ = spectrum_.sums();
  }
  if (slow_s_ > pause_s_ - 1e-9 || now_.duration_s > longest_s) end();
}

void Movements::end() {
  if (moving_) judge(fast_, start_, fast_spectrum_, finished_);
  moving_ = false;
  slow_s_ = 0;
}

/// Log dimensionless jerk: Balasubramanian et al. 2015, equation 6: -ln(T^3 / v_peak^2 * integral of |jerk|^2).
void Movements::judge(const Sums& s, const Vec3& start, const SpeedSpectrum::Sums& spectrum, MovementFigures& out) {
  ++out.count;
  out.duration_s += s.duration_s;
  out.path_m += s.path_m;
  out.direct_m += (s.end - start).norm();
  if (s.duration_s < least_judged_s - 1e-9 || !(s.jerk2 > 0)) return;
  ++out.judged;
  out.log_jerk -= std::log(s.duration_s * s.duration_s * s.duration_s / (s.peak_speed * s.peak_speed) * s.jerk2);
  out.arc_length += SpeedSpectrum::arc_length(spectrum);
}

void Movements::reset() {
  moving_ = false;
  slow_s_ = 0;
  finished_ = {};
}

MovementFigures Movements::figures() const {
  MovementFigures out = finished_;
  if (moving_) judge(fast_, start_, fast_spectrum_, out);
  return out;
}

}  // namespace insula
