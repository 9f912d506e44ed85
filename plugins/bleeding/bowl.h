// SPDX-License-Identifier: GPL-3.0-or-later
// Fluid that stands in the operating field, and what suction tubes take of it.
#pragma once
#include <vector>

#include "core/mechanics/instrument.h"

namespace insula {

/// The field as a bowl, a paraboloid of `radius` at the height `depth`. Its area grows with height as fluid fills it.
struct Bowl {
  double radius = 0.015, depth = 0.02;  ///< m
  Vec3 origin = Vec3::Zero();           ///< bottom, scene frame, m
  Vec3 up = Vec3::UnitZ();              ///< unit, against gravity
  double capacity() const;              ///< m3, to the rim
  double height(double volume) const;   ///< of the fluid's surface above the bottom, m
  double volume(double height) const;   ///< m3
  double height_of(const Vec3& p) const { return (p - origin).dot(up); }  ///< of a point above the bottom, m
  bool covers(double volume, const Vec3& p) const;  ///< whether the fluid `volume` stands over this point
};

constexpr double full_jet = 1e-6;  ///< m3/s: a rate of bleeding that is drawn as the strongest jet

/// How much suction tubes take from a bowl.
struct SuctionRates {
  double working = 0;  ///< m3/s of a tube whose button is held, tip in the fluid
  double idle = 0;     ///< share of that with the vent open, 0..1
};

/// Volume that the tubes in hand take in the time `h`, m3, from the fluid `volume` in the bowl.
double suction_takes(const Bowl& bowl, double volume, const std::vector<Instrument*>& tubes, const SuctionRates& rates,
                     double h);

/// The suction tubes among a scene's instruments, in the order of the document.
std::vector<Instrument*> suction_tubes(const std::vector<Instrument*>& instruments);

}  // namespace insula
