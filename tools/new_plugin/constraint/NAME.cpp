// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

A spring from the vertex of a surface nearest to `at` (at rest) to an anchor that never moves: one two-sided row

    delta = |x - anchor| - length,   delta + lambda / k = 0
*/
#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class @Name@ final : public Constraint, public StatesLaw {
 public:
  Ref<Surface> surface{this, {.name = "surface", .doc = "surface that it is tied to"}};
  Param<Vec<Length>> at{this, {.name = "at", .doc = "the vertex nearest to this place at rest is tied"}};
  Param<Vec<Length>> anchor{this, {.name = "anchor", .doc = "other end"}};
  Param<Length> length{this, {.name = "length", .min = "0.1 mm", .max = "1 m", .doc = "length without force"}};
  Param<Stiffness> stiffness{
      this, {.name = "stiffness", .fallback = "20 N/m", .min = "0.1 N/m", .max = "10 kN/m", .doc = "of the spring"}};

  // Once, when all components are there: find what the rows need every step, and report what does not fit.
  void connect(PrepareContext& context, Simulation&) override {
    const auto& vertices = surface->rest().vertices;
    std::size_t best = 0;
    for (std::size_t i = 1; i < vertices.size(); ++i)
      if ((vertices[i] - at()).squaredNorm() < (vertices[best] - at()).squaredNorm()) best = i;
    end_ = surface->points()[best];
    if ((vertices[best] - anchor()).norm() < 1e-6)
      error(context, anchor, "lies on the surface: the spring has no direction");
  }

  // Every step: rows, with their violation at its start (m) and the direction that each end moves it along.
  void build(const StepContext&, ConstraintBuilder& builder) override {
    const Vec3 d = end_.body->position(end_) - anchor();
    const double now = d.norm();
    if (now < 1e-9) return;
    Block block;
    block.id = row_id(*this, 0);  // the same in every step: the solver starts from the last step's force
    block.compliance = 1 / stiffness();
    const int row = builder.add(block);
    builder.violation(row, now - length());
    builder.point(row, end_, d / now);
  }

  // What the rows must do, said once more as an energy. The contract tests compare the two; no step reads it.
  StatedLaw law() const override {
    const double stretch = (end_.body->position(end_) - anchor()).norm() - length();
    return StatedLaw::potential(0.5 * stiffness() * stretch * stretch);
  }

 private:
  MaterialPoint end_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::constraint, "@doc@"); }
