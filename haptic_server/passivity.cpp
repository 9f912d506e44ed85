// SPDX-License-Identifier: GPL-3.0-or-later
#include "haptic_server/passivity.h"

#include <algorithm>
#include <cmath>

namespace insula {

void PassivityObserver::observe(const Vec3& force_N, const Vec3& device_m) noexcept {
  constexpr int enough_air = 50;
  const Vec3 swept = placed_ ? Vec3(device_m - last_) : Vec3(Vec3::Zero());
  last_ = device_m;
  placed_ = true;
  if (force_N.isZero(0)) {
    if (++in_air_ >= enough_air) given_ = 0;
    return;
  }
  in_air_ = 0;
  const double work = force_N.dot(swept);
  if (!std::isfinite(work)) return;
  given_ += work;
  max_given_ = std::max(max_given_, given_);
}

}  // namespace insula
