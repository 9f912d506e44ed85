// SPDX-License-Identifier: GPL-3.0-or-later
/*
# cerebrospinal_fluid

Clear fluid that stands in a cistern or a fissure. It fills a bowl, a paraboloid as in <bleeding>, up to `level`. The
cisterns around refill it at the rate `refill` while it is lower than that. With V the volume in the bowl,

    dV/dt = refill (while height < level) - suction,      height = depth sqrt(V / V_full)

A suction tube whose tip is below the surface takes `suction_rate` while its button is held, and `idle_suction` of it
otherwise. The fluid has no weight and carries no load: it is drawn, and its height is a channel.

The choroid plexus forms about 0.35 ml a minute. Cisterns that have been opened give much more for some minutes.
*/
#include <algorithm>

#include "core/mechanics/constraint.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "plugins/bleeding/bowl.h"

namespace insula {
namespace {

class CerebrospinalFluid final : public Constraint {
 public:
  static constexpr std::string_view kind_name = "cerebrospinal_fluid";

  Param<Vec<Length>> origin{this, {.name = "origin", .doc = "bottom of the bowl"}};
  Param<Vec<Scalar>> up{this, {.name = "up", .fallback = "0 0 1", .doc = "out of the field, against gravity"}};
  Param<Length> radius{
      this, {.name = "radius", .fallback = "8 mm", .min = "1 mm", .max = "200 mm", .doc = "of the bowl at its rim"}};
  Param<Length> depth{
      this,
      {.name = "depth", .fallback = "12 mm", .min = "1 mm", .max = "200 mm", .doc = "of the bowl from bottom to rim"}};
  Param<Length> level{this,
                      {.name = "level",
                       .fallback = "6 mm",
                       .min = "0 mm",
                       .max = "200 mm",
                       .doc = "height over the bottom at the start, to which it fills again"}};
  Param<FlowRate> refill{this,
                         {.name = "refill",
                          .fallback = "3 ml/min",
                          .min = "0 ml/min",
                          .max = "500 ml/min",
                          .doc = "that comes from the cisterns around"}};
  Param<FlowRate> suction_rate{this,
                               {.name = "suction_rate",
                                .fallback = "45 ml/min",
                                .min = "0 ml/min",
                                .max = "2000 ml/min",
                                .doc = "that a suction tube takes while its tip is in the fluid"}};
  Param<Scalar> idle_suction{this,
                             {.name = "idle_suction",
                              .fallback = "0.1",
                              .min = "0",
                              .max = "1",
                              .doc = "share of that which it takes with its vent open"}};
  Param<MaterialName> material{
      this, {.name = "material", .fallback = "cerebrospinal_fluid", .doc = "look of the fluid in the viewer"}};

  Channel<Length> height{this,
                         {.name = "height",
                          .doc = "of the fluid over the bottom",
                          .min = "0 m",
                          .shown = Shown::none,
                          .display = "mm",
                          .digits = 1}};
  Plane pool{this,
             {.name = "pool",
              .doc = "surface of the fluid",
              .material = "cerebrospinal_fluid",
              .value = "height over the bottom",
              .unit = "m"}};

  void prepare(PrepareContext& context) override {
    if (up().norm() < 1e-9) return error(context, up, "must be a direction");
    if (level() > depth()) error(context, level, "is above depth, the rim of the bowl");
    pool.set_material(material());
    bowl_ = {radius(), depth(), origin(), up().normalized()};
    reset();
  }
  void connect(PrepareContext&, Simulation& simulation) override { tubes_ = suction_tubes(simulation.instruments()); }
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }

  void finish(const StepContext& context, const ConstraintSolution&) override {
    const double taken = suction_takes(bowl_, volume_, tubes_, {suction_rate(), idle_suction()}, context.h);
    const double full = bowl_.volume(level());
    volume_ = std::clamp(volume_ + context.h * refill() - taken, 0.0, full);
  }
  void publish() override {
    const double high = bowl_.height(volume_);
    height.set(high);
    pool.set(bowl_.origin + high * bowl_.up, bowl_.up, high > 0 ? radius() : 0, high);
  }
  void reset() override { volume_ = bowl_.volume(level()); }
  void append_state(std::vector<double>& out) const override { out.push_back(volume_); }

 private:
  Bowl bowl_;
  std::vector<Instrument*> tubes_;
  double volume_ = 0;  ///< m3
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(cerebrospinal_fluid) {
  registry.add_material({"cerebrospinal_fluid", "fluid", {0.88, 0.92, 0.90, 0.6}, 0.05, 0, 1});
  registry.add<insula::CerebrospinalFluid>("cerebrospinal_fluid", insula::Kind::constraint,
                                           "clear fluid that stands in a fissure, and what suction takes of it");
}
