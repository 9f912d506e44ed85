// SPDX-License-Identifier: GPL-3.0-or-later
// Fibres of the arachnoid between two bodies, as compliant rows.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/sim/simulation.h"
#include "plugins/strand_springs/strand_set.h"

namespace insula {

class StrandSprings : public Constraint, public StrandSet, public StatesLaw {
 public:
  static constexpr std::string_view kind_name = "strand_springs";

  Ref<Surface> from{this, {.name = "from", .fallback = "", .doc = "surface where the strands start"}};
  Ref<Surface> to{this, {.name = "to", .fallback = "", .doc = "surface where they end"}};
  Param<AreaDensity> density{this,
                             {.name = "density",
                              .fallback = "10 1/cm2",
                              .min = "0 1/cm2",
                              .max = "10000 1/cm2",
                              .doc = "strands per area of the start surface that faces the other one"}};
  Param<Length> max_length{this,
                           {.name = "max_length",
                            .fallback = "3 mm",
                            .min = "0.01 mm",
                            .max = "50 mm",
                            .doc = "no strand is longer at rest"}};
  Param<Vec<Length>> centre{
      this, {.name = "centre", .fallback = "0 0 0 m", .doc = "centre of the ball that strands start in"}};
  Param<Length> radius{
      this, {.name = "radius", .fallback = "10 m", .min = "0.1 mm", .max = "10 m", .doc = "radius of that ball"}};
  Param<Choice> created_at{
      this,
      {.name = "created_at",
       .fallback = "at_rest",
       .choices = {"at_rest", "settled"},
       .doc = "when the strands are spun: between the surfaces at rest, or as they lie once the scene has settled",
       .formerly = "made"}};
  Param<int> seed{
      this, {.name = "seed", .fallback = "1", .min = "0", .max = "2147483647", .doc = "start of the random choice"}};
  Param<Stiffness> stiffness{
      this,
      {.name = "stiffness", .fallback = "20 N/m", .min = "0.001 N/m", .max = "100000 N/m", .doc = "of a whole strand"}};
  Param<Scalar> slack{this,
                      {.name = "slack",
                       .fallback = "1.1",
                       .min = "0.5",
                       .max = "3",
                       .doc = "length without tension over the length at the start"}};
  Param<Choice> load_direction{this,
                               {.name = "load_direction",
                                .fallback = "tension",
                                .choices = {"tension", "both"},
                                .doc = "a fibre carries tension only; both: a two-sided spring",
                                .formerly = "carries"}};
  Param<Force> cut_force{this,
                         {.name = "cut_force",
                          .fallback = "0.03 N",
                          .min = "0 N",
                          .max = "5 N",
                          .doc = "force with which a strand resists a blade that cuts it"}};
  Param<Length> cut_length{this,
                           {.name = "cut_length",
                            .fallback = "1 mm",
                            .min = "0.01 mm",
                            .max = "50 mm",
                            .doc = "travel of the blade through a strand that parts it"}};
  Param<Length> reach{this,
                      {.name = "reach",
                       .fallback = "0.5 mm",
                       .min = "0.01 mm",
                       .max = "5 mm",
                       .doc = "distance at which an edge touches a strand"}};
  Param<Force> strength{this,
                        {.name = "strength",
                         .fallback = "0 N",
                         .min = "0 N",
                         .max = "100 N",
                         .doc = "tension that tears a whole strand; 0: it does not tear"}};

  Channel<Scalar> standing{
      this, {.name = "standing", .doc = "strands that are not parted", .min = "0", .shown = Shown::vital, .digits = 0}};
  Channel<Scalar> total{
      this, {.name = "total", .doc = "strands at the start", .min = "0", .shown = Shown::none, .digits = 0}};
  Channel<Force> tension{
      this, {.name = "tension", .doc = "largest tension of a strand", .min = "0 N", .display = "mN", .digits = 1}};
  Channel<Scalar> load{
      this,
      {.name = "load",
       .doc = "largest share of the tension at which a strand tears, worn as it is; strands under a blade do not tear",
       .min = "0",
       .shown = Shown::none,
       .display = "%",
       .digits = 0}};
  Polylines fibres{this,
                   {.name = "fibres",
                    .doc = "the strands",
                    .material = "arachnoid",
                    .value = "1 whole, 0 about to be severed, negative: parted",
                    .radius = "0.15 mm"}};
  EventKind cut{this,
                {.name = "strand_cut",
                 .doc = "a blade parted a strand",
                 .value = "force of the blade or tension, N",
                 .listed = false}};
  EventKind torn{this,
                 {.name = "strand_torn",
                  .doc = "a strand was pulled beyond its strength",
                  .value = "its tension, N",
                  .bad = true}};

  /// Adds one strand between two points (positions at rest in the scene frame); its rest length is slack times their
  /// distance.
  void add_strand(const MaterialPoint& a, const MaterialPoint& b);

  void connect(PrepareContext& context, Simulation& simulation) override;
  void settled(PrepareContext& context) override;
  void detect(const StepContext& context) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override;

  int count() const { return int(strands_.size()); }
  int strands_left() const;
  double integrity(int i) const { return 1 - strands_[std::size_t(i)].damage; }
  int strand_count() const override { return count(); }
  StrandState strand(int i) const override;
  bool severed(int i) const override { return strands_[std::size_t(i)].severed; }
  const ChannelBase* load_channel() const override { return strength() > 0 ? &load : nullptr; }
  /// Where a strand begins and ends.
  const MaterialPoint& beginning(int i) const { return strands_[std::size_t(i)].a; }
  const MaterialPoint& ending(int i) const { return strands_[std::size_t(i)].b; }
  /// Calls this whenever the strands have been spun or taken away, outside of steps.
  void when_spun(std::function<void()> call) { when_spun_.push_back(std::move(call)); }

 protected:
  double largest_load() const;
  struct Strand {
    MaterialPoint a, b;
    double rest = 0;    ///< length without tension, m
    double damage = 0;  ///< 0 whole ... 1 severed
    bool severed = false;
    double tension = 0;  ///< N
    int row = -1;
    // The blade that touches the strand in this step.
    int blade_row = -1;
    Instrument* blade = nullptr;
    MaterialPoint blade_point;
    double along = 0;                ///< 0 at a, 1 at b
    Vec3 blade_away = Vec3::Zero();  ///< from the blade's edge to the strand, m
    double blade_gap = 0;            ///< what the blade still goes until it is within `reach`, m
    Vec3 push = Vec3::Zero();
  };
  /// A strand has been spun between two vertices of `from` and `to`.
  virtual void spun(int /*from_vertex*/, int /*to_vertex*/) {}
  /// A strand has parted: its state, and the event.
  virtual void part(const StepContext& context, Strand& s, const EventKind& what, double value);
  const std::vector<Strand>& strands() const { return strands_; }

 private:
  /// Cutting edges in the scene frame, and a ball around them.
  struct Blade {
    Instrument* tool = nullptr;
    bool cutting = false;
    std::vector<std::array<Vec3, 2>> edges;
    Vec3 middle = Vec3::Zero();
    double radius = 0;
    double advance = 0;  ///< of the edges in so many steps of free motion, m
    void place(double steps);
  };
  void generate(PrepareContext& context);
  void find_blade(Strand& s, double steps) const;
  void tell_spun() const {
    for (const auto& call : when_spun_) call();
  }

  std::vector<Strand> strands_;
  std::vector<std::function<void()>> when_spun_;
  std::vector<Blade> blades_;  ///< of all instruments
};

}  // namespace insula
