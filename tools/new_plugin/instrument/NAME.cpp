// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

A probe that marks places: while the device's first button is held, an event "@name@" tells where the tip is, first at
once and then each time that it has gone on by `spacing`. The tool itself, its coupling to the hand and its contacts are
the base class's.
*/
#include <cstdio>

#include "core/mechanics/instrument.h"
#include "core/registry/registry.h"
#include "core/sim/events.h"

namespace insula {
namespace {

class @Name@ final : public Instrument {
 public:
  Param<Length> spacing{this,
                        {.name = "spacing",
                         .fallback = "1 mm",
                         .min = "0.01 mm",
                         .max = "100 mm",
                         .doc = "least distance between two marks of one line"}};

  // After the step's motion: the only place where an instrument tells events.
  void finish(const StepContext& context, const ConstraintSolution&) override {
    if (!state().button1) {
      drawing_ = false;
      return;
    }
    const Vec3 tip = pose().p;
    if (drawing_ && (tip - last_).norm() < spacing()) return;
    drawing_ = true;
    last_ = tip;
    ++marks_;
    char text[80];
    std::snprintf(text, sizeof text, "marked at %.1f %.1f %.1f mm", 1000 * tip.x(), 1000 * tip.y(), 1000 * tip.z());
    context.events->emit({"@name@", id, text, double(marks_), context.time + context.h, hand_index()});
  }
  double activity() const override { return drawing_ ? 1 : 0; }

  // State beyond the base class's: back to the start, and into the hash.
  void reset() override {
    Instrument::reset();
    drawing_ = false;
    marks_ = 0;
    last_.setZero();
  }
  void append_state(std::vector<double>& out) const override {
    Instrument::append_state(out);
    out.insert(out.end(), {double(marks_), drawing_ ? 1.0 : 0.0, last_.x(), last_.y(), last_.z()});
  }

 private:
  bool drawing_ = false;
  int marks_ = 0;
  Vec3 last_ = Vec3::Zero();  // m
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::instrument, "@doc@"); }
