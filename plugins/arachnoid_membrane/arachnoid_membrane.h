// SPDX-License-Identifier: GPL-3.0-or-later
// Thin membranes between neighbouring arachnoid strands, which tools tent, tear and cut.
#pragma once
#include <array>
#include <vector>

#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/sim/simulation.h"
#include "plugins/arachnoid_membrane/bilinear_patch.h"
#include "plugins/arachnoid_membrane/neighbours.h"
#include "plugins/arachnoid_membrane/tool_outline.h"
#include "plugins/strand_springs/strand_springs.h"

namespace insula {

class ArachnoidMembrane final : public Constraint, public StatesLaw {
 public:
  static constexpr int points = 5;  ///< of a drawn piece

  Ref<StrandSprings> strands{this, {.name = "strands", .doc = "strands between whose neighbours it is spanned"}};
  Param<Length> span{this,
                     {.name = "span",
                      .fallback = "4 mm",
                      .min = "0.1 mm",
                      .max = "50 mm",
                      .doc = "strands farther apart than this at either end are no neighbours"}};
  Param<Stiffness> stiffness{this,
                             {.name = "stiffness",
                              .fallback = "15 N/m",
                              .min = "0.001 N/m",
                              .max = "10000 N/m",
                              .doc = "force on a tool over the depth of the tent, of a whole piece"}};
  Param<Force> strength{this,
                        {.name = "strength",
                         .fallback = "0.02 N",
                         .min = "0.0001 N",
                         .max = "10 N",
                         .doc = "force of a tool that tears a whole piece; none ever carries more"}};
  Param<Length> tear_depth{this,
                           {.name = "tear_depth",
                            .fallback = "2.5 mm",
                            .min = "0.1 mm",
                            .max = "3 mm",
                            .doc = "depth of a tent that tears a piece"}};
  Param<Length> cut_length{this,
                           {.name = "cut_length",
                            .fallback = "1 mm",
                            .min = "0.01 mm",
                            .max = "50 mm",
                            .doc = "travel of an edge along a piece that parts it"}};
  Param<Length> reach{this,
                      {.name = "reach",
                       .fallback = "0.3 mm",
                       .min = "0.01 mm",
                       .max = "5 mm",
                       .doc = "distance at which an edge touches a piece"}};

  Channel<Scalar> whole_pieces{this,
                               {.name = "whole_pieces",
                                .doc = "pieces of the membrane that hold",
                                .min = "0",
                                .shown = Shown::none,
                                .digits = 0}};
  Channel<Scalar> pieces{
      this, {.name = "pieces", .doc = "pieces at the start", .min = "0", .shown = Shown::none, .digits = 0}};
  Channel<Force> push{this,
                      {.name = "push",
                       .doc = "largest force of a piece on a tool",
                       .min = "0 N",
                       .shown = Shown::none,
                       .display = "mN",
                       .digits = 1}};
  Polylines sheets{
      this,
      {.name = "sheets",
       .doc = "the pieces, each as the tip of its tent (without a tent a point of the piece), both ends of "
              "one strand, and both ends of its neighbour",
       .material = "arachnoid_membrane",
       .value = "of the tip: 1 whole, 0 about to part, negative: parted; of the ends: the same of the strand",
       .radius = "0.05 mm",
       .points_per_line = points}};
  EventKind torn{
      this,
      {.name = "membrane_torn", .doc = "a tool tore a piece of membrane", .value = "its force, N", .listed = false}};
  EventKind cut{this,
                {.name = "membrane_cut",
                 .doc = "an edge parted a piece of membrane",
                 .value = "force of the tool on it, N",
                 .listed = false}};

  void connect(PrepareContext& context, Simulation& simulation) override;
  void detect(const StepContext& context) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override;

  /// Spans pieces between the strands that stand now. Strands call it when they have been spun.
  void weave();
  int count() const { return int(pieces_.size()); }
  int pieces_left() const;
  double integrity(int piece) const { return 1 - pieces_[std::size_t(piece)].damage; }
  bool holds(int piece) const { return pieces_[std::size_t(piece)].holds; }
  StrandPair pair(int piece) const { return pieces_[std::size_t(piece)].pair; }
  /// Force on a tool at the end of the last step, N.
  double force(int piece, int tool = 0) const { return tent(std::size_t(piece), std::size_t(tool)).force; }

 private:
  /// What a tool does to a piece. Only `side` outlives the step.
  struct Tent {
    int side = 0;  ///< of the patch on which the tool is, 1: where its normal points to; 0: unknown
    bool near = false;
    int side_now = 0;
    Vec3 direction = Vec3::Zero();  ///< of the force on the tool, unit
    MaterialPoint point;            ///< of the tool, deepest in the patch
    std::array<double, 4> weight{};
    double gap = 0;  ///< at the start of the step, m; negative: the tent's depth
    int row = -1;
    double depth = 0, force = 0;  ///< at the end of the step, m, N
    // The edge that touches it.
    bool edge = false;
    MaterialPoint edge_point;
    BilinearPatch::Foot edge_foot;
    Vec3 edge_at = Vec3::Zero();
  };
  struct Piece {
    StrandPair pair;
    std::array<MaterialPoint, 4> corner;
    std::vector<int> neighbours;  ///< pieces that share a strand
    bool holds = true;
    double damage = 0;  ///< 0 whole ... 1 parted
  };
  /// The ball of a tool that is deepest in a patch from the side on which the tool is.
  struct Deepest {
    int side = 0;
    double gap = 0;
    const ToolOutline::Ball* ball = nullptr;
    BilinearPatch::Foot foot;
  };

  /// A piece where its corners are now.
  struct Placed {
    BilinearPatch patch;
    BilinearPatch::Bounds bounds;
    double from, to;  ///< the part across it that still spans
    bool spans(double s, double t) const { return s >= from && s <= to && t >= 0 && t <= 1; }
  };

  BilinearPatch patch(const Piece& piece) const;
  Placed place(const Piece& piece) const;
  static Deepest deepest_from(int side, const Placed& piece, const ToolOutline& tool);
  static Deepest deepest(const Placed& piece, const ToolOutline& tool, int side);
  void find_edge(const Placed& piece, const ToolOutline& tool, Tent& tent) const;
  static void touch(const Placed& piece, const ToolOutline& tool, Tent& tent);
  void remember_side(std::size_t piece, std::size_t tool);
  double travel(const Piece& piece, const ToolOutline& tool, const Tent& tent) const;
  void part(const StepContext& context, Piece& piece, const EventKind& what, const ToolOutline& tool, double force);
  void follow_strands(Piece& piece) const;
  double yield(const Piece& piece) const { return strength() * (1 - piece.damage); }
  double rigidity(const Piece& piece) const { return stiffness() * (1 - piece.damage); }
  std::size_t index(std::size_t piece, std::size_t tool) const { return piece * tools_.size() + tool; }
  Tent& tent(std::size_t piece, std::size_t tool) { return tents_[index(piece, tool)]; }
  const Tent& tent(std::size_t piece, std::size_t tool) const { return tents_[index(piece, tool)]; }

  std::vector<ToolOutline> tools_;  ///< of the hands
  std::vector<Piece> pieces_;
  std::vector<Tent> tents_;  ///< tools_.size() a piece
};

}  // namespace insula
