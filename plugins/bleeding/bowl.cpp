// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/bleeding/bowl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insula {

double Bowl::capacity() const { return 0.5 * std::numbers::pi * radius * radius * depth; }
double Bowl::height(double v) const { return v > 0 ? depth * std::sqrt(std::min(1.0, v / capacity())) : 0; }
double Bowl::volume(double h) const {
  const double x = std::clamp(h / depth, 0.0, 1.0);
  return capacity() * x * x;
}

bool Bowl::covers(double v, const Vec3& p) const {
  const double high = height_of(p);
  return v > 0 && high < height(v) && (p - origin - high * up).norm() <= radius;
}

double suction_takes(const Bowl& bowl, double volume, const std::vector<Instrument*>& tubes, const SuctionRates& rates,
                     double h) {
  double taken = 0;
  for (const Instrument* tube : tubes) {
    if (!tube->active()) continue;
    if (!bowl.covers(volume, tube->pose().p)) continue;
    taken += h * rates.working * std::max(rates.idle, tube->activity());
  }
  return taken;
}

std::vector<Instrument*> suction_tubes(const std::vector<Instrument*>& instruments) {
  std::vector<Instrument*> out;
  for (Instrument* i : instruments)
    if (i->element == "suction") out.push_back(i);
  return out;
}

}  // namespace insula
