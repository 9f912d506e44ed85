// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of all forces that a real haptic server sends.
#pragma once
#include "tests/process/watcher.h"

namespace insula::testing {

/// The simulated arm's largest change of force (haptic_server's profile of a Phantom Omni): all of it within 50 ms.
inline constexpr double slew_N_s = 66;

/// For all samples: within one run of the server no two samples differ by more than the limit for the time between
/// them, and each run starts at zero.
inline void expect_slew_limit(const std::vector<Sample>& samples) {
  int steps = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& b = samples[i];
    if (i == 0 || samples[i - 1].session != b.session) {
      // The first sample of a run may be some ticks old.
      for (const Vec3& f : b.force) EXPECT_LE(i == 0 ? 0.0 : f.norm(), slew_N_s * 0.1);
      continue;
    }
    const Sample& a = samples[i - 1];
    ASSERT_GE(b.time_us, a.time_us);
    const double limit = slew_N_s * double(b.time_us - a.time_us) * 1e-6 + slew_N_s * 1e-3;  // and one tick
    for (int hand = 0; hand < 2; ++hand) {
      ASSERT_TRUE(b.force[hand].allFinite());
      EXPECT_LE((b.force[hand] - a.force[hand]).norm(), limit) << "sample " << i;
      EXPECT_LE(b.force[hand].norm(), 3.3 + 1e-9);
    }
    ++steps;
  }
  EXPECT_GT(steps, 20);
}

}  // namespace insula::testing
