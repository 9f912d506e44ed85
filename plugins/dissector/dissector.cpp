// SPDX-License-Identifier: GPL-3.0-or-later
/*
# dissector

A micro dissector or arachnoid knife. It is a rigid tool on the virtual coupling, and its blade edges damage and cut
strands. `sharp="never"` makes it blunt. `sharp="button"` cuts only while the device's first button is held.
*/
#include "core/mechanics/instrument.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class Dissector final : public Instrument {
 public:
  Param<Choice> sharp{
      this,
      {.name = "sharp", .fallback = "always", .choices = {"always", "button", "never"}, .doc = "when the blade cuts"}};

  void prepare(PrepareContext& context) override {
    Instrument::prepare(context);
    if (!model().empty() && tool().blade_edges.empty() && !sharp.is("never"))
      error(context, model, "model: this tool has no cutting edge; write sharp=\"never\" or choose another");
  }
  bool cutting() const override {
    return !sharp.is("never") && (sharp.is("always") || state().button1) && !tool().blade_edges.empty();
  }
  double activity() const override { return sharp.is("button") && state().button1 ? 1 : 0; }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(dissector) {
  registry.add<insula::Dissector>("dissector", insula::Kind::instrument,
                                  "micro dissector or knife that cuts strands with its edges");
}
