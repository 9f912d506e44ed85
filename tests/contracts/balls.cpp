// SPDX-License-Identifier: GPL-3.0-or-later
// A ball at a tool's tip that keeps a vertex of a surface out, as a contact does; and mistakes that only that form
// allows.
#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/sim/simulation.h"
#include "tests/contracts/mistakes.h"

namespace insula::mistakes {
namespace {

enum class Mistake {
  none,
  with_friction,
  stale_direction,
  stale_direction_far,
  negative_friction,
  attracts,
  pulls,
  wrong_sign,
  wrong_side
};

template <Mistake M>
class Ball final : public Constraint, public StatesLaw {
 public:
  Ref<Surface> surface{this, {.name = "surface", .doc = "surface whose first vertex is kept out"}};
  Ref<Instrument> tool{this, {.name = "tool", .doc = "tool that carries the ball"}};
  Param<Length> radius{this,
                       {.name = "radius", .fallback = "5 mm", .min = "0.1 mm", .max = "1 m", .doc = "of the ball"}};

  void connect(PrepareContext&, Simulation&) override {
    vertex_ = surface->points()[0];
    for (const MaterialPoint& p : surface->points())
      if (surface->body().position(p).squaredNorm() < surface->body().position(vertex_).squaredNorm()) vertex_ = p;
    centre_ = tool->link_point(0, Vec3(1e-3, 0, 1e-3));
    reset();
  }
  void build(const StepContext&, ConstraintBuilder& builder) override {
    const Vec3 d = vertex_.body->position(vertex_) - centre_.body->position(centre_);
    const double less = is(Mistake::stale_direction_far) ? 4.5e-3 : 0;  // m: the ball is small and the gap wide
    Vec3 n = is(Mistake::stale_direction) || is(Mistake::stale_direction_far) ? last_ : d.normalized();
    double gap = d.norm() - radius() + less;
    if (is(Mistake::wrong_sign)) n = -n;
    if (is(Mistake::wrong_side)) {
      n = -n;
      gap = -gap;
    }
    Block block;
    block.id = row_id(*this, 0);
    block.lower = 0;
    if (is(Mistake::attracts)) block.lower = -infinite;
    if (is(Mistake::pulls)) block.lower = -infinite, block.upper = 0;
    const bool friction = is(Mistake::negative_friction) || is(Mistake::with_friction);
    if (friction) block.law = LawKind::friction, block.friction = is(Mistake::with_friction) ? 0.2 : -0.2;
    const int row = builder.add(block);
    builder.violation(row, gap);
    const Vec3 t = n.unitOrthogonal(), both[3] = {n, t, n.cross(t)};
    for (int k = 0; k < block.rows(); ++k) {
      builder.point(row + k, vertex_, both[k]);
      // At the vertex: no net moment.
      builder.point(row + k, tool->point(vertex_.body->position(vertex_)), -both[k]);
    }
  }
  void reset() override { last_ = (vertex_.body->position(vertex_) - centre_.body->position(centre_)).normalized(); }
  StatedLaw law() const override { return StatedLaw::unilateral(); }

 private:
  static constexpr bool is(Mistake m) { return M == m; }
  MaterialPoint vertex_, centre_;
  Vec3 last_ = Vec3::UnitZ();  ///< of the start
};

}  // namespace

void add_balls(Registry& registry) {
  const auto add = [&]<Mistake M>(const char* name) {
    registry.add<Ball<M>>(name, Kind::constraint, "ball for tests");
  };
  add.operator()<Mistake::none>("ball");
  add.operator()<Mistake::with_friction>("ball_with_friction");
  add.operator()<Mistake::stale_direction>("ball_stale_direction");
  add.operator()<Mistake::stale_direction_far>("ball_stale_direction_far");
  add.operator()<Mistake::negative_friction>("ball_negative_friction");
  add.operator()<Mistake::attracts>("ball_attracts");
  add.operator()<Mistake::pulls>("ball_pulls");
  add.operator()<Mistake::wrong_sign>("ball_wrong_sign");
  add.operator()<Mistake::wrong_side>("ball_wrong_side");
}

}  // namespace insula::mistakes
