// SPDX-License-Identifier: GPL-3.0-or-later
// The component whose commands docs/bodies-in-plugins.md shows.
#include <charconv>

#include "core/mechanics/constraint.h"
#include "core/registry/registry.h"

namespace insula {

class Pump : public Constraint {
 public:
@SNIPPET@

 private:
  double rate_ = 0;  // beats/min
};

}  // namespace insula
