// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of a thin wall with itself. self_contact.cpp describes the law and the scene element.
#pragma once
#include <memory>
#include <vector>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/self_collider.h"
#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/sim/report.h"
#include "plugins/contact/contact.h"

namespace insula {

class SelfContact final : public Constraint, public StatesLaw {
 public:
  Ref<Surface> on{this, {.name = "on", .doc = "surface of the wall: its triangles are the wall's middle"}};
  Param<Length> thickness{this,
                          {.name = "thickness",
                           .fallback = "0.3 mm",
                           .min = "0.01 mm",
                           .max = "5 mm",
                           .doc = "of the wall: two middles come no closer than this"}};
  Param<Scalar> friction{
      this,
      {.name = "friction",
       .fallback = "0",
       .min = "0",
       .max = "10",
       .doc = "Coulomb coefficient of wall on wall; 0 is frictionless and takes one row a contact instead of three"}};
  Param<Stiffness> contact_stiffness{
      this,
      {.name = "contact_stiffness",
       .fallback = "0 N/m",
       .min = "0 N/m",
       .max = "1000 kN/m",
       .doc = "stiffness at one contact of the two walls against being pressed thinner; 0: they never are",
       .formerly = "layer"}};
  Param<Length> alarm{this,
                      {.name = "alarm",
                       .fallback = "0.5 mm",
                       .min = "0.01 mm",
                       .max = "10 mm",
                       .doc = "walls with less than this between them are in contact's care"}};
  Param<Choice> sides{this,
                      {.name = "sides",
                       .fallback = "inner",
                       .choices = {"inner", "outer", "both"},
                       .doc = "which sides may touch: inner ones across the lumen, outer ones, both"}};
  Param<Length> spacing{this,
                        {.name = "spacing",
                         .fallback = "0.7 mm",
                         .min = "0.05 mm",
                         .max = "100 mm",
                         .doc = "contacts are no closer than this; vertices are sampled at three quarters of it"}};
  Param<int> max_contacts{this,
                          {.name = "max_contacts",
                           .fallback = "36",
                           .min = "1",
                           .max = "200",
                           .doc = "most contacts of the wall with itself, besides the supports"}};
  Param<int> max_supports{this,
                          {.name = "max_supports",
                           .fallback = "24",
                           .min = "0",
                           .max = "200",
                           .doc = "most places pressed by a tool that are supported by the wall behind them"}};

  void connect(PrepareContext& context, Simulation& simulation) override;
  void detect(const StepContext& context) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void report(StepReport& report) const override;
  void estimate_cost(CostCounts& out) const override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override { return StatedLaw::unilateral(); }

  const std::vector<Proximity>& contacts() const { return contacts_; }
  int rows() const { return int(supports_.size() + rows_.size() * (friction() > 0 ? 3 : 1)); }
  const std::vector<Vec3>& forces() const { return forces_; }  ///< along (normal, tangent, other tangent), N

 private:
  /// Largest correction of overlapping walls in a step, m. Walls with a contact stiffness separate by a force that is
  /// already bounded.
  double max_correction() const { return (contact_stiffness() > 0 ? 1.0 : 0.3) * thickness(); }
  void add_row(ConstraintBuilder& builder, int row, const Proximity& x, const Vec3& d) const;

  /// Two points of the wall that lie behind each other in the direction in which a tool presses.
  struct Support {
    int triangle, behind;
    Vec3 bary, behind_bary, normal;
    double gap;
    std::uint64_t id;
    int row;
    double force;
  };
  void find_supports();

  std::vector<const Contact*> touches_;
  std::vector<Support> supports_;
  std::vector<std::pair<std::uint64_t, const Proximity*>> pressed_;  ///< contacts of a tool, by key
  Workers* workers_ = nullptr;
  std::unique_ptr<SelfCollider> collider_;
  ContactSelection selection_;
  std::vector<Proximity> contacts_;
  std::vector<int> rows_;
  std::vector<Vec3> forces_;
  std::uint64_t next_key_ = 0;
};

}  // namespace insula
