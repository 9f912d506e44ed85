// SPDX-License-Identifier: GPL-3.0-or-later
/*
# retractor

A brain spatula: a blunt flat blade that holds a lobe aside by contact alone. With `hand="none"` a table-mounted arm
holds it at home; `coupling` is then the stiffness of the arm.
*/
#include "core/mechanics/instrument.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class Retractor final : public Instrument {
 public:
  bool cutting() const override { return false; }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(retractor) {
  registry.add<insula::Retractor>("retractor", insula::Kind::instrument, "blunt brain spatula, in a hand or on a table-mounted arm");
}
