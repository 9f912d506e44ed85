// SPDX-License-Identifier: GPL-3.0-or-later
/*
# circle_of_willis

The blood supply of the brain: carotid and vertebral arteries, the circle of Willis with its collaterals, and the beds
of the territories. An artery that is narrowed or shut by a clip in the scene is so here too, and its territory loses
as much blood as the collaterals cannot replace.

    <circle_of_willis id="circle" heart="heart" diameters="acom=0 pcom_right=0.5"
                      narrowed="m1_right=flow.parent.lumen m2_superior_right=flow.superior.lumen"/>

Each artery of length l and radius r is a resistance (Poiseuille). A clip leaves the share a of its cross-section over
the length n:

    R = 8 mu (l + n (1/a^2 - 1)) / (pi r^4),      a = 0: closed
    sum of the flows into each node = 0
    Q = g (p - venous) into each bed

Segments, with `_left` or `_right`: cca, ica, a1, a2, m1, m2_superior, m2_inferior, pcom, p1, p2, va. In the middle:
acom, basilar. `diameters` makes the variants of the anatomy: `acom=0` is a missing anterior communicating artery,
`a1_right=0.5` a hypoplastic A1, `pcom_left=1.5 p1_left=0.4` a fetal posterior cerebral artery.

The beds g are sized so that every territory has its flow at rest in the circle as it is declared, under the mean
pressure of a beat. They do not change afterwards: there is no autoregulation. Territories, with the side: aca,
mca_superior, mca_inferior, pca, orbit, face. In the middle: brainstem, cerebellum. Neighbouring territories of a side
are joined on the surface of the brain (leptomeningeal anastomoses): aca, mca_superior, mca_inferior, pca in a chain.
Each link has the share `leptomeningeal` of the conductance of half of the middle cerebral artery's territory at rest.

With `heart`, the pressure of the arteries follows that of the scene, as the mean p over the time T = `averaging`:
T dp/dt = p_heart - p. The flow in the brain does not act back on the vessels of the scene.

Sources: Alastruey et al., J Biomech 2007 (lengths and radii). Zarrinkoob et al., J Cereb Blood Flow Metab 2015 (flow in
94 persons by phase-contrast MRI). Phan et al., Front Neurol 2014 (leptomeningeal anastomoses).
*/
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/params/number.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "plugins/circle_of_willis/cerebral_network.h"
#include "plugins/pressure/pressure.h"

namespace insula {
namespace {

constexpr double most_diameter = 3;  // over that of the table

class CircleOfWillis final : public Constraint {
 public:
  static constexpr std::string_view kind_name = "circle_of_willis";

  Ref<BloodPressure> heart{
      this,
      {.name = "heart", .fallback = "", .doc = "pressure of the arteries; none: that of `arterial`, which is steady"}};
  Param<Pressure> arterial{this,
                           {.name = "arterial",
                            .fallback = "93 mmHg",
                            .min = "20 mmHg",
                            .max = "200 mmHg",
                            .doc = "mean pressure of the arteries without `heart`"}};
  Param<Pressure> venous{this,
                         {.name = "venous",
                          .fallback = "8 mmHg",
                          .min = "0 mmHg",
                          .max = "40 mmHg",
                          .doc = "pressure behind the beds, that of veins or skull"}};
  Param<FlowRate> brain_flow{this,
                             {.name = "flow",
                              .fallback = "717 ml/min",
                              .min = "100 ml/min",
                              .max = "2000 ml/min",
                              .doc = "of both carotid and vertebral arteries into the brain at rest"}};
  Param<Perfusion> rest_perfusion{this,
                                  {.name = "perfusion",
                                   .fallback = "50 ml/100g/min",
                                   .min = "10 ml/100g/min",
                                   .max = "150 ml/100g/min",
                                   .doc = "of every territory at rest"}};
  Param<Viscosity> viscosity{
      this, {.name = "viscosity", .fallback = "3.5 mPa s", .min = "0.5 mPa s", .max = "20 mPa s", .doc = "of blood"}};
  Param<std::string> diameters{this,
                               {.name = "diameters",
                                .fallback = "",
                                .doc = "diameters of segments over those of the table, 0 to 3, 0: missing; \"acom=0 "
                                       "a1_right=0.5\""}};
  Param<std::string> shut{this,
                          {.name = "shut",
                           .fallback = "",
                           .doc = "segments that are shut from the start, after the beds are sized: \"ica_right\""}};
  Param<std::string> narrowed{this,
                              {.name = "narrowed",
                               .fallback = "",
                               .doc = "segments and the channels with the share of their lumen that is open: "
                                      "\"m1_right=flow.parent.lumen\""}};
  Param<Length> narrow_length{this,
                              {.name = "narrow_length",
                               .fallback = "1.5 mm",
                               .min = "0.1 mm",
                               .max = "20 mm",
                               .doc = "length over which such a segment is narrowed: the width of a clip's blades"}};
  Param<Scalar> leptomeningeal{this,
                               {.name = "leptomeningeal",
                                .fallback = "0.3",
                                .min = "0",
                                .max = "5",
                                .doc = "collaterals on the surface of the brain; 0.1: poor, 0.3: fair, 0.8: good"}};
  Param<Duration> averaging{this,
                            {.name = "averaging",
                             .fallback = "2 s",
                             .min = "0.01 s",
                             .max = "60 s",
                             .doc = "time over which the pressure of `heart` is averaged"}};

  ChannelGroup<Perfusion> perfusion{this,
                                    {.name = "perfusion",
                                     .doc = "of a territory",
                                     .min = "0 ml/100g/min",
                                     .max = "200 ml/100g/min",
                                     .display = "ml/100g/min",
                                     .digits = 1,
                                     .good = {.from = "35 ml/100g/min"},
                                     .high = {.from = "20 ml/100g/min"}}};
  ChannelGroup<FlowRate> outflow{this,
                                 {.name = "outflow",
                                  .doc = "into the bed of a territory",
                                  .min = "0 ml/min",
                                  .max = "2000 ml/min",
                                  .shown = Shown::none,
                                  .display = "ml/min",
                                  .digits = 1}};
  ChannelGroup<FlowRate> segment_flow{
      this,
      {.name = "flow",
       .doc = "through a segment, away from the heart; of pcom from front to back, of acom from left to right",
       .min = "-2000 ml/min",
       .max = "2000 ml/min",
       .shown = Shown::none,
       .display = "ml/min",
       .digits = 1}};

  void connect(PrepareContext& context, Simulation&) override {
    network_ = complete_circle(brain_flow());
    network_.viscosity = viscosity();
    network_.venous = venous();
    if (!set_diameters(context)) return;
    const double pressure = rest_pressure();
    if (pressure <= venous()) return error(context, venous, "is not below the pressure of the arteries");
    const double half = 0.105 * brain_flow() / (pressure - venous());  // of the middle cerebral artery's bed
    for (auto& a : network_.anastomoses) a.conductance = leptomeningeal() * half;
    if (const std::string poor = network_.size_beds(pressure); !poor.empty())
      return error(context, diameters, "these arteries cannot supply " + in_quotes(poor) + " with its flow at rest");
    std::vector<std::string> names;
    for (const auto& t : network_.territories) names.push_back(t.name);
    perfusion.declare(names);
    outflow.declare(names);
    names.clear();
    for (const auto& s : network_.segments) names.push_back(s.name);
    segment_flow.declare(names);
    shut_.assign(names.size(), 0);
    for (const std::string_view name : split_blanks(shut())) {
      const CerebralNetwork::Segment* s = segment_of(context, shut, name);
      if (!s) return;
      shut_[index_of(*s)] = 1;
    }
    shut_at_start_ = shut_;
    reset();
  }

  void find_channels(PrepareContext& context, const Simulation& simulation) override {
    lumens_.clear();
    for (const std::string_view word : split_blanks(narrowed())) {
      const auto [name, channel] = halves(word);
      CerebralNetwork::Segment* segment = segment_of(context, narrowed, name);
      if (!segment) return;
      const ChannelEntry* entry = simulation.channels().find(channel);
      if (!entry || entry->size() != 1) {
        const std::string near = nearest_name(channel, simulation.channels().ids());
        return error(
            context, narrowed,
            "no component publishes the channel " + in_quotes(channel) + " as one number" + did_you_mean(near));
      }
      segment->narrow_length = narrow_length();
      lumens_.push_back({index_of(*segment), entry});
    }
  }
  void settled(PrepareContext&) override {
    pressure_ = rest_pressure();
    take_lumens(true);
    network_.solve(pressure_);
  }

  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }
  void finish(const StepContext& context, const ConstraintSolution&) override {
    if (heart) pressure_ += (heart->arterial(context.h) - pressure_) * -std::expm1(-context.h / averaging());
    take_lumens(true);
    network_.solve(pressure_);
  }
  void publish() override {
    for (std::size_t i = 0; i < network_.territories.size(); ++i) {
      const auto& t = network_.territories[i];
      outflow.set(i, t.flow);
      perfusion.set(i, rest_perfusion() * t.flow / t.rest_flow);
    }
    for (std::size_t i = 0; i < network_.segments.size(); ++i) segment_flow.set(i, network_.segments[i].flow);
  }
  void reset() override {
    shut_ = shut_at_start_;
    pressure_ = rest_pressure();
    take_lumens(false);
    network_.solve(pressure_);
  }
  void append_state(std::vector<double>& out) const override {
    out.push_back(pressure_);
    for (std::size_t i = 0; i < shut_.size(); ++i)
      out.insert(out.end(), {double(shut_[i]), network_.segments[i].lumen});
  }
  std::vector<CommandInfo> commands() const override {
    return {{"close", "shuts a segment, as a balloon does for a test", "segment", 0, 0},
            {"open", "opens a segment that `close` has shut", "segment", 0, 0}};
  }
  std::string run_command(std::string_view name, std::string_view argument) override {
    if (name != "close" && name != "open") return "unknown command " + in_quotes(name);
    const CerebralNetwork::Segment* s = network_.find(trim(argument));
    if (!s) return "there is no segment " + in_quotes(argument);
    shut_[index_of(*s)] = name == "close";
    return {};
  }

 private:
  struct Lumen {
    std::size_t segment = 0;
    const ChannelEntry* open = nullptr;
  };

  double rest_pressure() const { return heart ? heart->wave_mean() : arterial(); }

  /// "a=b" as "a" and "b".
  static std::pair<std::string_view, std::string_view> halves(std::string_view word) {
    const std::size_t at = std::min(word.find('='), word.size());
    return {word.substr(0, at), word.substr(std::min(at + 1, word.size()))};
  }
  CerebralNetwork::Segment* segment_of(PrepareContext& context, const ParamBase& param, std::string_view name) {
    if (CerebralNetwork::Segment* s = network_.find(name)) return s;
    std::vector<std::string> names;
    for (const auto& s : network_.segments) names.push_back(s.name);
    const std::string near = nearest_name(name, names);
    error(context, param, "there is no segment " + in_quotes(name) + did_you_mean(near));
    return nullptr;
  }
  bool set_diameters(PrepareContext& context) {
    for (const std::string_view word : split_blanks(diameters())) {
      const auto [name, text] = halves(word);
      CerebralNetwork::Segment* segment = segment_of(context, diameters, name);
      if (!segment) return false;
      std::string why;
      const std::optional<double> factor = parse_quantity(text, Scalar::units(), Scalar::name, why);
      if (!factor || !(*factor >= 0 && *factor <= most_diameter)) {
        error(context, diameters, in_quotes(word) + " needs a number from 0 to 3 behind its name");
        return false;
      }
      segment->radius *= *factor;
    }
    return true;
  }
  std::size_t index_of(const CerebralNetwork::Segment& s) const { return std::size_t(&s - network_.segments.data()); }
  /// The lumens are those that were published at the end of the step before. One that is not known is open.
  void take_lumens(bool published) {
    for (std::size_t i = 0; i < shut_.size(); ++i) network_.segments[i].lumen = shut_[i] ? 0 : 1;
    if (!published) return;
    for (const Lumen& l : lumens_) {
      double& lumen = network_.segments[l.segment].lumen;
      if (const double open = *l.open->channel->values(l.open->item); open >= 0) lumen = std::min(lumen, open);
    }
  }

  CerebralNetwork network_;
  std::vector<Lumen> lumens_;
  std::vector<char> shut_at_start_;

  // State.
  double pressure_ = 0;     ///< of the arteries, Pa
  std::vector<char> shut_;  ///< of each segment, whatever its lumen
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(circle_of_willis) {
  registry.add<insula::CircleOfWillis>("circle_of_willis", insula::Kind::constraint,
                                       "blood supply of the brain with its collaterals, territory by territory");
}
