// SPDX-License-Identifier: GPL-3.0-or-later
#include "haptic_server/soft_guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/bus/plausible.h"

namespace insula {
namespace {

/// Energy below which the force fades, J.
constexpr double fading_J = 0.5 * SoftGuide::energy_J;

double raised_cosine(double share) noexcept { return 0.5 * (1 - std::cos(std::numbers::pi * share)); }

bool in_range(const GuideWish& w) noexcept {
  return w.direction.allFinite() && std::abs(w.direction.squaredNorm() - 1) < 1e-3 && w.force_N > 0 &&
         w.force_N <= limits::guide_N && w.duration_s >= limits::guide_s[0] && w.duration_s <= limits::guide_s[1];
}

}  // namespace

double SoftGuide::profile(double t, double duration_s) noexcept {
  if (!(t > 0) || !(t < duration_s)) return 0;
  return raised_cosine(std::min({1.0, t / fade_s, (duration_s - t) / fade_s}));
}

double SoftGuide::fade_out(double t) noexcept { return t <= 0 ? 1 : t >= fade_s ? 0 : raised_cosine(1 - t / fade_s); }

void SoftGuide::take(const GuideWish& wish) noexcept {
  if (wish.number == 0 || (wish.session == last_session_ && wish.number <= last_number_)) return;
  last_session_ = wish.session;
  last_number_ = wish.number;
  if (active_ || resting_s_ < pause_s || !in_range(wish)) return;
  wish_ = wish;
  active_ = true;
  stopped_ = placed_ = false;
  since_s_ = stopped_s_ = resting_s_ = 0;
  left_ = energy_J;
  force_.setZero();
}

Vec3 SoftGuide::advance(double dt, bool fresh, bool live, const Vec3& device_m) noexcept {
  const double step = dt > 0 ? dt : 0;
  resting_s_ = std::min(pause_s, resting_s_ + step);
  if (!active_) return Vec3::Zero();
  if (placed_) left_ = std::clamp(left_ - force_.dot(device_m - last_), 0.0, energy_J);
  last_ = device_m;
  placed_ = true;
  since_s_ += step;
  stopped_ = stopped_ || !fresh;
  if (stopped_) stopped_s_ += step;
  active_ = live && device_m.allFinite() && since_s_ < wish_.duration_s && stopped_s_ < fade_s;
  const double size =
      wish_.force_N * profile(since_s_, wish_.duration_s) * fade_out(stopped_s_) * std::min(1.0, left_ / fading_J);
  force_ = active_ ? Vec3(size * wish_.direction) : Vec3(Vec3::Zero());
  return force_;
}

}  // namespace insula
