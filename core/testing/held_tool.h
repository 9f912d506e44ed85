// SPDX-License-Identifier: GPL-3.0-or-later
// A hand that holds a tool somewhere, for tests.
#pragma once
#include "core/mechanics/instrument.h"

namespace insula::test {

/// The tool turned as at its home, with its tip there.
inline HandState held_at(const Instrument& tool, const Vec3& tip, bool button1 = false) {
  HandState hand;
  hand.present = true;
  hand.device = {tip, tool.home_pose().q};
  hand.button1 = button1;
  return hand;
}

}  // namespace insula::test
