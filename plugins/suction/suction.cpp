// SPDX-License-Identifier: GPL-3.0-or-later
/*
# suction

A suction tube. Its wall pushes tissue by contact. While the device's first button is held, the nearest tissue within
`capture` of the opening is drawn onto it and held. One row along the tube and two across hold it rigidly. They yield
plastically at

    along  F = suction * area of the opening,     across  grip * F

so the hand feels no more than the vacuum can pull. Tissue that is drawn farther than `release` from the opening is
lost.
*/
#include <cmath>

#include "core/constraint/stated_law.h"
#include "core/mechanics/instrument.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

class Suction final : public Instrument, public StatesLaw {
 public:
  Param<Pressure> suction{this,
                          {.name = "suction",
                           .fallback = "15 kPa",
                           .min = "0 Pa",
                           .max = "90 kPa",
                           .doc = "vacuum at the opening while the button is held"}};
  Param<Length> capture{this,
                        {.name = "capture",
                         .fallback = "1.5 mm",
                         .min = "0 mm",
                         .max = "10 mm",
                         .doc = "tissue closer than this to the opening is taken"}};
  Param<Length> release{this,
                        {.name = "release",
                         .fallback = "3 mm",
                         .min = "0 mm",
                         .max = "20 mm",
                         .doc = "tissue farther than this is lost"}};
  Param<Scalar> grip{this,
                     {.name = "grip",
                      .fallback = "0.6",
                      .min = "0",
                      .max = "2",
                      .doc = "hold across the opening over the hold along the tube"}};

  void join(PrepareContext&, Simulation& simulation) override {
    for (Surface* s : simulation.surfaces())
      if (s->body().blocks() > 0) surfaces_.push_back(s);
  }
  bool cutting() const override { return false; }
  double activity() const override { return state().button1 ? 1 : 0; }
  void reset() override {
    Instrument::reset();
    held_ = {};
  }

  void build(const StepContext&, ConstraintBuilder& builder) override {
    if (!state().button1 || suction() <= 0) {
      held_ = {};
      return;
    }
    if (held_.body && (held_.body->position(held_) - pose().p).norm() > release()) held_ = {};
    if (!held_.body) take();
    if (!held_.body) return;
    const double force = max_force();
    const Mat3 axes = pose().q.toRotationMatrix();
    // The tube's side of the rows is its point at the held tissue: no net moment, and the exact derivative as d turns
    // with it.
    const Vec3 at = held_.body->position(held_);
    const MaterialPoint own = point(at);
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = axes.col((k + 2) % 3);  // the tube's axis first
      const double limit = k == 0 ? force : grip() * force;
      Block block;
      block.id = row_id(*this, std::uint64_t(k));
      block.role = BlockRole::grip;
      block.lower = -limit;
      block.upper = limit;
      const int row = builder.add(block);
      builder.violation(row, d.dot(at - pose().p));
      builder.point(row, held_, d);
      builder.point(row, own, -d);
    }
  }

  // Rigid holds that slip at their limit: limit times displacement.
  StatedLaw law() const override {
    if (!held_.body) return StatedLaw::potential(0);
    const Vec3 d = (pose().q.conjugate() * (held_.body->position(held_) - pose().p)).cwiseAbs();
    return StatedLaw::potential(max_force() * (d.z() + grip() * (d.x() + d.y())));
  }

  void append_state(std::vector<double>& out) const override {
    Instrument::append_state(out);
    out.push_back(held_.body ? held_.body->index : -1);
  }

 private:
  /// Of the vacuum on the opening, N.
  double max_force() const {
    const double radius = tool().tip_inner_radius > 0 ? tool().tip_inner_radius : 0.0007;
    return suction() * 3.14159265358979323846 * radius * radius;
  }
  // The surface vertex nearest to the opening, in front of it.
  void take() {
    double best = capture();
    for (const Surface* s : surfaces_)
      for (std::size_t i = 0; i < s->positions().size(); ++i) {
        const double d = (s->positions()[i] - pose().p).norm();
        if (d < best) {
          best = d;
          held_ = s->points()[i];
        }
      }
  }

  std::vector<Surface*> surfaces_;
  MaterialPoint held_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(suction) {
  registry.add<insula::Suction>("suction", insula::Kind::instrument,
                                "suction tube that holds tissue at its opening while a button is pressed");
}
