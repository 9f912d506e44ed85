// SPDX-License-Identifier: GPL-3.0-or-later
#include "haptic_server/force_output.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insula {
namespace {

constexpr double over = 5;  ///< a transient ends after this many decay times

bool finite(const Vec3& v) { return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()); }

double strength(const Transient& t, double since_s) {
  return t.decay_s > 0 && since_s < over * t.decay_s ? t.amplitude_N * std::exp(-since_s / t.decay_s) : 0;
}

}  // namespace

void ForceOutput::start_transient(const Vec3& direction, const Transient& transient) noexcept {
  const double size = direction.norm();
  if (!settings_.transients || !(size > 0) || !finite(direction) ||
      !(transient.amplitude_N > strength(sounding_, since_s_)))
    return;
  sounding_ = transient;
  along_ = direction / size;
  since_s_ = 0;
}

Vec3 ForceOutput::apply(const DeviceProfile& device, double dt, const Vec3& force_N, const Vec3& v, const Vec3& up,
                        bool live) noexcept {
  if (!live) {
    sounding_ = {};
    return force_N;
  }
  Vec3 out = settings_.force_scale * force_N;
  if (device.weight_N > 0) out += device.weight_N * up;
  // Acts along the motion of the hand, and is zero at rest. It is only a share of the arm's friction, so that the arm
  // never drives itself.
  const double speed = v.norm();
  if (device.friction_N > 0 && speed > 0 && finite(v))
    out += settings_.friction_share * device.friction_N * std::min(1.0, speed / slow_m_s) / speed * v;
  if (const double now = strength(sounding_, since_s_); now > 0) {
    out += now * std::sin(2 * std::numbers::pi * sounding_.frequency_Hz * since_s_) * along_;
    since_s_ += dt;
  }
  return out;
}

bool Onset::met(double dt, double force_N) noexcept {
  constexpr double touch_N = 5e-3, apart_s = 0.05;
  if (!(force_N > touch_N)) {
    out_of_touch_s_ += dt;
    return false;
  }
  const bool first = out_of_touch_s_ >= apart_s;
  out_of_touch_s_ = 0;
  return first;
}

double hardness(const ConstraintProblem& p, int hand, const std::vector<double>& lambda) noexcept {
  double max_N = 0, out = 0;
  for (const ToolTerms& tool : p.tools) {
    if (tool.hand != hand) continue;
    for (const Block& b : p.blocks) {
      // Contacts press with their first row. Rows that only pull, or connect, do not count.
      if (b.law == LawKind::patch || (b.law == LawKind::box && b.lower < 0)) continue;
      const std::size_t r = std::size_t(b.row);
      if (r >= lambda.size() || !(lambda[r] > max_N)) continue;
      double own = 0;
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) own += tool.jacobian(b.row, i) * tool.compliance(i, j) * tool.jacobian(b.row, j);
      const double all = p.w_at(b.row, b.row);
      if (!(own > 0) || !(all > 0)) continue;
      max_N = lambda[r];
      out = std::clamp(own / all, 0.0, 1.0);
    }
  }
  return out;
}

Transient impact_transient(double speed_m_s, double hardness) {
  constexpr double per_speed = 6;  // N s/m: about 0.3 N for a quick tap on bone
  const double hard =
      std::max(0.0, 2 * hardness - 1);  // tissue at least as compliant as the coupling causes no transient
  return {std::clamp(per_speed * speed_m_s * hard, 0.0, 0.5), 220, 0.008};
}

}  // namespace insula
