// SPDX-License-Identifier: GPL-3.0-or-later
/*
# brain_relaxation

The volume of the brain, which the anaesthetist and the surgeon change: mannitol draws water out of it, hyperventilation
lets its vessels narrow, and drained fluid lets it sink. A slack brain gives way to a retractor. A complication lets it
swell.

    <brain_relaxation id="brain" on="frontal temporal"/>

Each measure i has an effect e_i on the volume, and comes and goes with its time constant t_i:

    dx_i/dt = (a_i - x_i) / t_i,    a_i = 1 while it is in force, else 0      solved exactly over each step
    dV/V = sum of e_i x_i,          natural stretch a = (1 + dV/V)^(1/3)

The bodies' force models take the stretch as that of their stress-free configuration (ForceModel::set_natural_stretch).
Free tissue changes its volume by dV/V without stress. Tissue that is held on all sides gets the pressure
E / (1 - 2 nu) (a - 1) instead.

The bodies of a scene are a part of the brain, and the rest moves with it. The effects are therefore larger than those
of tissue alone. Mannitol takes about 1 % of the volume of healthy brain. Hyperventilation changes the volume of blood
by 0.04 ml/100 g for each mmHg of carbon dioxide (Grubb et al. 1974). The times are shorter than in an operation, where
mannitol needs a quarter of an hour.
*/
#include <array>
#include <cmath>

#include "core/base/text.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "core/registry/surgeon_requests.h"
#include "core/sim/events.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

class BrainRelaxation final : public Constraint, public TakesSurgeonRequests {
 public:
  static constexpr std::string_view kind_name = "brain_relaxation";

  RefList<SoftBody> on{this, {.name = "on", .doc = "bodies of tissue that shrink and swell"}};
  Param<Scalar> mannitol{
      this,
      {.name = "mannitol", .fallback = "0.03", .min = "0", .max = "0.2", .doc = "volume that it takes, as a share"}};
  Param<Duration> mannitol_time{
      this,
      {.name = "mannitol_time", .fallback = "60 s", .min = "0.1 s", .max = "3600 s", .doc = "time constant of that"}};
  Param<Scalar> hyperventilation{this,
                                 {.name = "hyperventilation",
                                  .fallback = "0.01",
                                  .min = "0",
                                  .max = "0.2",
                                  .doc = "volume that it takes, as a share"}};
  Param<Duration> hyperventilation_time{this,
                                        {.name = "hyperventilation_time",
                                         .fallback = "30 s",
                                         .min = "0.1 s",
                                         .max = "3600 s",
                                         .doc = "time constant of that"}};
  Param<Scalar> drainage{this,
                         {.name = "drainage",
                          .fallback = "0.03",
                          .min = "0",
                          .max = "0.2",
                          .doc = "volume by which drained cerebrospinal fluid lets the brain sink, as a share"}};
  Param<Duration> drainage_time{
      this,
      {.name = "drainage_time", .fallback = "20 s", .min = "0.1 s", .max = "3600 s", .doc = "time constant of that"}};
  Param<Scalar> swelling{this,
                         {.name = "swelling",
                          .fallback = "0.05",
                          .min = "0",
                          .max = "0.2",
                          .doc = "volume that a swelling brain gains, as a share"}};
  Param<Duration> swelling_time{
      this,
      {.name = "swelling_time", .fallback = "20 s", .min = "0.1 s", .max = "3600 s", .doc = "time constant of that"}};

  Channel<Scalar> volume_change{this,
                                {.name = "volume_change",
                                 .doc = "of the brain: below 0 it is slack, above 0 it swells",
                                 .min = "-0.6",
                                 .max = "0.2",
                                 .shown = Shown::vital,
                                 .display = "%",
                                 .digits = 1,
                                 .high = {.to = "0.01"}}};
  EventKind swells{this, {.name = "brain_swells", .doc = "the brain begins to swell", .value = "1", .bad = true}};

  void connect(PrepareContext& context, Simulation&) override {
    for (SoftBody* body : on())
      if (!set(*body, 1))
        return error(context, on, "no force model of " + in_quotes(body->id) + " can swell (<corotational_fem> can)");
  }
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }

  void finish(const StepContext& context, const ConstraintSolution&) override {
    bool changed = false;
    for (std::size_t i = 0; i < measures; ++i) {
      const double before = reached_[i], wanted = in_force_[i] ? 1 : 0;
      if (before == wanted) continue;
      reached_[i] = wanted + (before - wanted) * std::exp(-context.h / time_constant(i));
      changed = true;
    }
    if (changed) apply();
    if (in_force_[swelling_] && !told_ && context.events)
      context.events->emit({swells.name(), id, "", 1, context.time + context.h});
    told_ = in_force_[swelling_];
  }
  void publish() override { volume_change.set(change()); }

  std::vector<CommandInfo> commands() const override {
    return {{"give_mannitol", "the brain loses water", "", 0, 0},
            {"hyperventilate", "the vessels of the brain narrow", "", 0, 0},
            {"ventilate_normally", "ends the hyperventilation", "", 0, 0},
            {"drain_fluid", "cerebrospinal fluid is drained, and the brain sinks", "", 0, 0},
            {"swell", "the brain swells", "", 0, 0},
            {"end_swelling", "the swelling goes back", "", 0, 0}};
  }
  std::vector<SurgeonRequest> surgeon_requests() const override {
    return {{"give_mannitol"}, {"hyperventilate"}, {"ventilate_normally"}, {"drain_fluid"}};
  }
  std::string run_command(std::string_view name, std::string_view) override {
    struct Effect {
      std::string_view command;
      Measure measure;
      bool in_force;
      std::string_view refused;
    };
    static constexpr std::array<Effect, 6> effects{
        {{"give_mannitol", mannitol_, true, "mannitol was given already"},
         {"hyperventilate", hyperventilation_, true, "the patient is hyperventilated already"},
         {"ventilate_normally", hyperventilation_, false, "the patient is not hyperventilated"},
         {"drain_fluid", drainage_, true, "the fluid is drained already"},
         {"swell", swelling_, true, "the brain swells already"},
         {"end_swelling", swelling_, false, "the brain does not swell"}}};
    for (const Effect& e : effects) {
      if (e.command != name) continue;
      if (in_force_[e.measure] == e.in_force) return std::string(e.refused);
      in_force_[e.measure] = e.in_force;
      return {};
    }
    return "unknown command " + in_quotes(name);
  }

  void reset() override {
    in_force_ = {};
    reached_ = {};
    told_ = false;
    apply();
  }
  void append_state(std::vector<double>& out) const override {
    for (std::size_t i = 0; i < measures; ++i)
      if (in_force_[i] || reached_[i] > 0) out.insert(out.end(), {double(i), double(in_force_[i]), reached_[i]});
  }

 private:
  enum Measure : std::size_t { mannitol_, hyperventilation_, drainage_, swelling_, measures };

  static bool set(SoftBody& body, double stretch) {
    bool any = false;
    for (ForceModel* m : body.forces()) any |= m->set_natural_stretch(stretch);
    return any;
  }
  double time_constant(std::size_t i) const {
    return std::array{mannitol_time(), hyperventilation_time(), drainage_time(), swelling_time()}[i];
  }
  double change() const {
    return swelling() * reached_[swelling_] - mannitol() * reached_[mannitol_] -
           hyperventilation() * reached_[hyperventilation_] - drainage() * reached_[drainage_];
  }
  void apply() {
    for (SoftBody* body : on()) set(*body, std::cbrt(1 + change()));
  }

  std::array<bool, measures> in_force_{};
  std::array<double, measures> reached_{};  ///< of the effect of each, 0..1
  bool told_ = false;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(brain_relaxation) {
  registry.add<insula::BrainRelaxation>("brain_relaxation", insula::Kind::constraint,
                                        "a brain that shrinks by mannitol, ventilation and drainage, or swells");
}
