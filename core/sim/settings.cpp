// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a scene's settings.
#include "core/sim/settings.h"

namespace insula {

void ViewSettings::prepare(PrepareContext& context) {
  constexpr double min_m = 1e-6;  // the view needs a direction
  if ((eye() - target()).norm() < min_m)
    context.diagnostics.error(eye.pos(),
                              "eye: the microscope stands in its own target, so it has no direction to look in");
}

}  // namespace insula
