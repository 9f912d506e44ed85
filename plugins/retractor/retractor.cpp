// SPDX-License-Identifier: GPL-3.0-or-later
/*
# retractor

A brain spatula: a blunt flat blade that holds a lobe aside by contact alone. With `hand="none"` a table-mounted arm
holds it at home, and `coupling` is the stiffness of the arm. The arm can bring it there while the scene settles
(`<settle>`). It starts at home + `approach`, moves in a straight line during `approach_time`, and is at home `rest`
before the exercise begins.
*/
#include <algorithm>

#include "core/mechanics/instrument.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class Retractor final : public Instrument {
 public:
  Param<Vec<Length>> approach{
      this, {.name = "approach", .fallback = "0 0 0 m", .doc = "where the arm starts, relative to home"}};
  Param<Duration> approach_time{this,
                                {.name = "approach_time",
                                 .fallback = "1.5 s",
                                 .min = "0.1 s",
                                 .max = "60 s",
                                 .doc = "how long the arm takes to home"}};
  Param<Duration> rest{this,
                       {.name = "rest",
                        .fallback = "1 s",
                        .min = "0 s",
                        .max = "60 s",
                        .doc = "time at home before the exercise begins"}};

  bool cutting() const override { return false; }
  Pose arm_pose(double time) const override {
    Pose p = home_pose();
    const double left = std::clamp((-rest() - time) / approach_time(), 0.0, 1.0);
    // Smooth at both ends.
    p.p += left * left * (3 - 2 * left) * approach();
    return p;
  }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(retractor) {
  registry.add<insula::Retractor>("retractor", insula::Kind::instrument,
                                  "blunt brain spatula, in a hand or on a table-mounted arm");
}
