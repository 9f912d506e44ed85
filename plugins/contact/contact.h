// SPDX-License-Identifier: GPL-3.0-or-later
// Contact among bodies and tools. contact.cpp describes the law and the scene element.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/workers.h"
#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/tissue_collider.h"
#include "core/collision/colliders/tool_collider.h"
#include "core/collision/colliders/tool_pair.h"
#include "core/collision/colliders/vertex_collider.h"
#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/rigid_body.h"
#include "core/mechanics/surface.h"
#include "core/sim/report.h"
#include "plugins/contact/friction_patches.h"

namespace insula {

class Contact final : public Constraint, public StatesLaw {
 public:
  RefList<Body> between{this, {.name = "between", .doc = "bodies and tools that may touch one another, two or more"}};
  Param<Scalar> friction{this,
                         {.name = "friction",
                          .fallback = "0.2",
                          .min = "0",
                          .max = "10",
                          .doc = "Coulomb coefficient; 0 is frictionless"}};
  Param<Length> alarm{this,
                      {.name = "alarm",
                       .fallback = "1 mm",
                       .min = "0.01 mm",
                       .max = "10 mm",
                       .doc = "a tool closer than this is in contact's care"}};
  Param<Length> spacing{this,
                        {.name = "spacing",
                         .fallback = "2 mm",
                         .min = "0.01 mm",
                         .max = "100 mm",
                         .doc = "contacts of a tool are no closer than this unless the surface turns"}};
  Param<int> max_contacts{this,
                          {.name = "max_contacts",
                           .fallback = "8",
                           .min = "1",
                           .max = "100",
                           .doc = "most contacts of a tool with one surface"}};
  Param<Length> max_step_displacement{
      this,
      {.name = "max_step_displacement",
       .fallback = "0.3 mm",
       .min = "0.05 mm",
       .max = "100 mm",
       .doc = "a tool that goes into a wall (a surface with a thickness) moves by no more than this in a step, and one "
              "in a hand along the wall by up to three times as much; the rest follows in the next ones; a tool that "
              "leaves the wall is free, and so is one in a hand that ends the step at most twice as deep",
       .formerly = "max_push"}};
  Param<Length> tissue_max_step_displacement{this,
                                             {.name = "tissue_max_step_displacement",
                                              .fallback = "1.5 mm",
                                              .min = "0.05 mm",
                                              .max = "100 mm",
                                              .doc = "the same for a soft body",
                                              .formerly = "tissue_push"}};
  Param<Choice> contact_geometry{
      this,
      {.name = "contact_geometry",
       .fallback = "triangles",
       .choices = {"triangles", "vertices"},
       .doc = "how tools meet surfaces: by every triangle, for sharp tools; or by vertices, for blades much wider than "
              "the triangles (contacts then stay with their vertices; of a wall, a surface with a thickness, all are "
              "kept out, else one per spacing)",
       .formerly = "by"}};
  Param<Choice> linearized_at{
      this,
      {.name = "linearized_at",
       .fallback = "start",
       .choices = {"start", "end"},
       .doc = "by triangles: where the normals and places of a tool that presses are taken: at the start of the step; "
              "or where tool and surface are expected at its end, which is nearer to the truth where a tool slides "
              "over what turns, and for long steps most",
       .formerly = "taken_at"}};
  Param<bool> curved{
      this,
      {.name = "curved",
       .fallback = "false",
       .doc = "by triangles: whether a tool meets a surface that is curved between its vertices, as the normals there "
              "say, in place of flat triangles; sharp edges stay sharp"}};
  Param<Length> patch{
      this,
      {.name = "patch",
       .fallback = "0 mm",
       .min = "0 mm",
       .max = "20 mm",
       .doc = "by vertices: contacts within this length of a blade share one friction force; 0: each has its own"}};
  Param<Length> max_correction{
      this,
      {.name = "max_correction",
       .fallback = "1 mm",
       .min = "0.001 mm",
       .max = "10 mm",
       .doc = "an overlap of a tool is undone by no more than this in a step: less is gentler on thin walls",
       .formerly = "recovery"}};
  Param<Stiffness> contact_stiffness{this,
                                     {.name = "contact_stiffness",
                                      .fallback = "0 N/m",
                                      .min = "0 N/m",
                                      .max = "1000 kN/m",
                                      .doc = "stiffness of what lies between a tool and the body at one contact, finer "
                                             "than the body's elements (the pia, a pad); 0: nothing, contact is hard",
                                      .formerly = "layer"}};
  Param<Force> max_force{this,
                         {.name = "max_force",
                          .fallback = "0 N",
                          .min = "0 N",
                          .max = "100 N",
                          .doc = "most normal force of one contact of a tool: what is pressed harder goes in, and out "
                                 "again, instead of dragging the tissue along or wedging rigid bodies; 0: any"}};
  Param<Length> tissue_alarm{this,
                             {.name = "tissue_alarm",
                              .fallback = "0.5 mm",
                              .min = "0.01 mm",
                              .max = "10 mm",
                              .doc = "the same distance between two surfaces"}};
  Param<Length> tissue_spacing{
      this,
      {.name = "tissue_spacing",
       .fallback = "4 mm",
       .min = "0.05 mm",
       .max = "100 mm",
       .doc = "contacts of two surfaces are no closer than this; their vertices are sampled at three quarters of it"}};
  Param<Force> tissue_max_force{this,
                                {.name = "tissue_max_force",
                                 .fallback = "0 N",
                                 .min = "0 N",
                                 .max = "100 N",
                                 .doc = "most normal force of one contact of two surfaces: with more they go "
                                        "through one another, so that what has become entangled comes apart; 0: any"}};
  Param<int> tissue_max_contacts{this,
                                 {.name = "tissue_max_contacts",
                                  .fallback = "16",
                                  .min = "1",
                                  .max = "200",
                                  .doc = "most contacts of one surface with another"}};

  void connect(PrepareContext& context, Simulation& simulation) override;
  void detect(const StepContext& context) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void report(StepReport& report) const override;
  void predict_frames(double steps, std::vector<ContactFrame>& out) const override;
  void find_patches(std::vector<PatchCandidate>& out) const override;
  void estimate_cost(CostCounts& out) const override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override { return StatedLaw::unilateral(); }

  /// Two surfaces or tools that may touch, and what was found between them in this step.
  struct Pair {
    RigidBody* tool_a = nullptr;  ///< a is a link of a tool or clip ...
    RigidBody* tool_b = nullptr;
    int link_a = 0, link_b = 0;
    bool in_hand = false;                             ///< a is in a hand or on the tray
    Surface *a = nullptr, *b = nullptr;               ///< ... or a surface
    std::vector<RoundedPiece> pieces_a, pieces_b;     ///< of the tools
    std::unique_ptr<ToolCollider> tool_collider;      ///< tool against surface, by triangles ...
    std::unique_ptr<VertexCollider> vertex_collider;  ///< ... or by the wall's vertices
    std::unique_ptr<TissueCollider> a_on_b, b_on_a;
    ContactSelection selection;
    std::vector<Proximity> contacts;
    std::vector<Proximity> reverse;            ///< of b's vertices on a, before selection
    std::unique_ptr<FrictionPatches> patches;  ///< one friction force for neighbouring contacts, or null
    Pose start;                                ///< of the tool, at the start of the last detected step
    std::optional<Pose> free;                  ///< of its free motion in the same step
    std::optional<ToolMotion> other;  ///< of tool b in the last detected step: its start, and its free pose as the end
    std::optional<Pose> expected;  ///< at the end of that step, for a pressing tool whose contacts are linearised there
    std::vector<int> rows;         ///< first row of each contact
    std::vector<Vec3> forces;      ///< along (normal, tangent, other tangent), N
    bool active() const { return (!tool_a || tool_a->active()) && (!tool_b || tool_b->active()); }
    bool single_piece() const {
      return tool_a && tool_a->link_pieces(link_a).size() == 1 && (!tool_b || tool_b->link_pieces(link_b).size() == 1);
    }
    const Body* body_a() const { return tool_a ? static_cast<const Body*>(tool_a) : &a->body(); }
    const Body* body_b() const { return tool_b ? static_cast<const Body*>(tool_b) : &b->body(); }
    ContactPart part_a() const { return {a, link_a}; }
    ContactPart part_b() const { return {b, link_b}; }
  };
  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  /// The work of one thread at a time: a pair, or one direction of a pair of surfaces.
  struct Search {
    int pair;
    bool reverse;
  };
  bool owns(Simulation& simulation, const Body* a, const Body* b) const;
  void search(const Search& what);
  void expect(Pair& pair, const Pose& free) const;
  static void search_tools(Pair& pair, const Pose& free, const ToolContactSettings& settings);
  void add_pairs(Simulation& simulation, Body* a, Body* b);
  /// The first touch of a tool in the step.
  struct Touch {
    int piece = -1;  ///< -1: none
    double time = 1;
    double overlap_at_end = std::numeric_limits<double>::infinity();  ///< of the piece with the surface, m
    std::size_t count = 0;
    std::array<Vec3, ToolCollider::max_touch_normals>
        normal;  ///< of the `count` contacts that the piece then has, towards the tool
    void add(const Vec3& n) {
      if (count < normal.size()) normal[count++] = n;
    }
    std::span<const Vec3> normals() const { return {normal.data(), count}; }
  };
  Touch first_touch(const Pair& pair) const;
  void limit_motion(ConstraintBuilder& builder, const Pair& pair) const;
  double max_correction_of(const Pair& pair) const;  ///< of an overlap of a tool in a step, m
  int max_contacts_per_piece(const Pair& pair) const;
  double max_contact_force(const Pair& pair) const;  ///< of one contact, N
  bool bounded(const Pair& pair) const { return max_contact_force(pair) < infinite; }
  double compliance(const Pair& pair) const {
    return pair.tool_a && contact_stiffness() > 0 ? 1 / contact_stiffness() : 0.0;
  }  ///< m/N
  void build_patches(ConstraintBuilder& builder, Pair& pair);
  /// Adds the rows of one contact: the normal, and two tangents if there is friction. Returns the first.
  int add_contact(ConstraintBuilder& builder, const Pair& pair, const Proximity& x) const;
  void add_row(ConstraintBuilder& builder, int row, const Pair& pair, const Proximity& x, const Vec3& direction) const;

  std::vector<Pair> pairs_;
  std::vector<Search> searches_;
  Workers* workers_ = nullptr;
  std::uint64_t next_key_ = 0;
  double collision_horizon_ = 0;  ///< in this step, in steps
};

}  // namespace insula
