// SPDX-License-Identifier: GPL-3.0-or-later
// Two threads from a surface to a tool, each one tension-only row; and the mistakes that an author may make with them.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/sim/simulation.h"
#include "tests/contracts/mistakes.h"

namespace insula::mistakes {
namespace {

enum class Mistake {
  none,
  reeled,
  wrong_sign,
  wrong_lever_arm,
  missing_body,
  unstable_ids,
  foreign_ids,
  rows_twice,
  force_twice,
  pointer_order,
  load_order,
  forgets_reset,
  state_not_in_hash,
  not_finite,
  bounds_swapped,
  negative_compliance,
  length_off,
  pushes,
  no_bound,
  stale_direction,
  allocates,
  not_reproducible,
  wrong_rate,
  stiffness_inverse,
  adds_free_motion,
  no_law,
  says_no_rows,
};

struct Nothing {};

template <Mistake M>
class Thread final : public Constraint, public std::conditional_t<M == Mistake::no_law, Nothing, StatesLaw> {
 public:
  Ref<Surface> surface{this, {.name = "surface", .doc = "surface that the threads are tied to"}};
  Ref<Instrument> tool{this, {.name = "tool", .doc = "tool at their other ends"}};
  Param<Length> length{
      this, {.name = "length", .fallback = "7 mm", .min = "0.1 mm", .max = "1 m", .doc = "length without tension"}};
  Param<Stiffness> stiffness{
      this, {.name = "stiffness", .fallback = "20 N/m", .min = "0.1 N/m", .max = "10 kN/m", .doc = "of each"}};

  void connect(PrepareContext&, Simulation&) override {
    static int loads = 0;
    load_ = loads++;
    fibres_.clear();
    for (int i = 0; i < 3; ++i) {
      fibres_.push_back(std::make_unique<Fibre>());
      Fibre& f = *fibres_.back();
      f.a = surface->points()[std::size_t(7 * i) % surface->points().size()];
      f.b = tool->link_point(0, Vec3(2e-3, 1e-3 * i, 3e-3));
      f.key = i;
    }
    if (is(Mistake::pointer_order)) std::sort(fibres_.begin(), fibres_.end());
  }

  void build(const StepContext& context, ConstraintBuilder& builder) override {
    time_ = context.time;
    for (auto& fibre : fibres_) build(context, builder, *fibre);
    if (is(Mistake::allocates)) scratch_ = std::make_unique<std::array<double, 8>>();
    ++built_;
  }

  bool adds_rows() const override { return !is(Mistake::says_no_rows); }

  void finish(const StepContext&, const ConstraintSolution& solution) override {
    for (auto& f : fibres_) {
      if (f->row >= 0 && solution.lambda[f->row] < 0) f->worn = std::min(0.5, f->worn + 0.01);
      f->last = f->now;  // of the step before
      f->now = between(*f).normalized();
    }
  }

  void reset() override {
    for (auto& f : fibres_) {
      if (!is(Mistake::forgets_reset)) f->worn = 0;
      f->last = f->now = Vec3::UnitZ();
    }
  }
  void append_state(std::vector<double>& out) const override {
    for (const auto& f : fibres_)
      if (!is(Mistake::state_not_in_hash)) out.push_back(f->worn);
  }
  StatedLaw law() const {
    double energy = 0;
    for (const auto& f : fibres_) {
      const double stretch = std::max(0.0, between(*f).norm() - rest());
      energy += 0.5 * stiffness() * (1 - f->worn) * stretch * stretch;
    }
    return StatedLaw::potential(energy);
  }

 private:
  struct Fibre {
    MaterialPoint a, b;
    double worn = 0;
    Vec3 now = Vec3::UnitZ(), last = Vec3::UnitZ();
    int row = -1, key = 0;
  };
  static constexpr bool is(Mistake m) { return M == m; }
  static constexpr double speed = 1e-3;  // m/s, of a thread that is reeled in
  Vec3 between(const Fibre& f) const { return f.a.body->position(f.a) - f.b.body->position(f.b); }
  double rest() const { return length() - (is(Mistake::reeled) || is(Mistake::wrong_rate) ? speed * time_ : 0); }

  std::uint64_t key(const Fibre& f) const {
    if (is(Mistake::unstable_ids)) return std::uint64_t(4 * built_ + f.key);
    if (is(Mistake::load_order)) return std::uint64_t(4 * load_ + f.key);
    if (is(Mistake::rows_twice)) return std::uint64_t(f.key / 2);
    return std::uint64_t(f.key);
  }

  void build(const StepContext&, ConstraintBuilder& builder, Fibre& f) {
    const Vec3 d = between(f);
    Block block;
    block.id = is(Mistake::foreign_ids) ? key(f) : row_id(*this, key(f));
    block.compliance = 1 / (stiffness() * (1 - f.worn));
    if (is(Mistake::stiffness_inverse)) block.compliance = stiffness();
    if (is(Mistake::negative_compliance)) block.compliance *= -1;
    block.upper = 0;
    if (is(Mistake::pushes)) block.lower = 0, block.upper = infinite;
    if (is(Mistake::no_bound)) block.upper = infinite;
    if (is(Mistake::bounds_swapped)) block.lower = 0, block.upper = -infinite;
    f.row = builder.add(block);
    add_row(builder, f, d, f.row);
    if (!is(Mistake::force_twice)) return;
    block.id = row_id(*this, key(f) + 100);
    add_row(builder, f, d, builder.add(block));
  }

  void add_row(ConstraintBuilder& builder, const Fibre& f, const Vec3& d, int row) const {
    Vec3 u = is(Mistake::stale_direction) ? f.last : d.normalized();
    if (is(Mistake::wrong_sign)) u = -u;
    double violation = d.norm() - rest();
    if (is(Mistake::length_off)) violation += 1e-3;
    if (is(Mistake::not_finite) && built_ > 20) violation = std::numeric_limits<double>::quiet_NaN();
    if (is(Mistake::adds_free_motion)) violation += 0.01 + u.dot(f.b.body->expected_displacement(f.b));
    if (is(Mistake::not_reproducible))
      violation += 1e-12 * double(std::chrono::steady_clock::now().time_since_epoch().count() % 1000);
    builder.violation(row, violation);
    if (is(Mistake::reeled)) builder.moves(row, speed);
    builder.point(row, f.a, u);
    const MaterialPoint tip = tool->link_point(0, Vec3::Zero());
    if (!is(Mistake::missing_body)) builder.point(row, is(Mistake::wrong_lever_arm) ? tip : f.b, -u);
  }

  std::vector<std::unique_ptr<Fibre>> fibres_;
  std::unique_ptr<std::array<double, 8>> scratch_;
  double time_ = 0;
  int built_ = 0, load_ = 0;
};

}  // namespace

void add_threads(Registry& registry) {
  const auto add = [&]<Mistake M>(const char* name) {
    registry.add<Thread<M>>(name, Kind::constraint, "threads for tests");
  };
  add.operator()<Mistake::none>("thread");
  add.operator()<Mistake::reeled>("thread_reeled");
  add.operator()<Mistake::wrong_sign>("thread_wrong_sign");
  add.operator()<Mistake::wrong_lever_arm>("thread_wrong_lever_arm");
  add.operator()<Mistake::missing_body>("thread_missing_body");
  add.operator()<Mistake::unstable_ids>("thread_unstable_ids");
  add.operator()<Mistake::foreign_ids>("thread_foreign_ids");
  add.operator()<Mistake::rows_twice>("thread_rows_twice");
  add.operator()<Mistake::force_twice>("thread_force_twice");
  add.operator()<Mistake::pointer_order>("thread_pointer_order");
  add.operator()<Mistake::load_order>("thread_load_order");
  add.operator()<Mistake::forgets_reset>("thread_forgets_reset");
  add.operator()<Mistake::state_not_in_hash>("thread_state_not_in_hash");
  add.operator()<Mistake::not_finite>("thread_not_finite");
  add.operator()<Mistake::bounds_swapped>("thread_bounds_swapped");
  add.operator()<Mistake::negative_compliance>("thread_negative_compliance");
  add.operator()<Mistake::length_off>("thread_length_off");
  add.operator()<Mistake::pushes>("thread_pushes");
  add.operator()<Mistake::no_bound>("thread_no_bound");
  add.operator()<Mistake::stale_direction>("thread_stale_direction");
  add.operator()<Mistake::allocates>("thread_allocates");
  add.operator()<Mistake::not_reproducible>("thread_not_reproducible");
  add.operator()<Mistake::wrong_rate>("thread_wrong_rate");
  add.operator()<Mistake::stiffness_inverse>("thread_stiffness_inverse");
  add.operator()<Mistake::adds_free_motion>("thread_adds_free_motion");
  add.operator()<Mistake::no_law>("thread_no_law");
  add.operator()<Mistake::says_no_rows>("thread_says_no_rows");
}

}  // namespace insula::mistakes
