// SPDX-License-Identifier: GPL-3.0-or-later
/*
# ischaemia

How long a tissue of the brain has had too little blood, and how near it is to infarction.

    <ischaemia id="motor_strip" channel="circle.mca_superior_right.perfusion"/>

The channel may be a perfusion, a flow with `rest_flow`, or a flow over that at rest, such as that of a branch in
`blood_flow`. With the perfusion f, tissue below `penumbra` has lost its function and may recover. Tissue at a constant
perfusion below `infarct` lives for the time

    T(f) = arrest + delay f / (infarct - f)

It is `arrest` without any blood, and infinite at `infarct`. The values of the defaults are 5 min at 0, 29 min at 4,
144 min at 11 ml/100g/min, and no end at 17.5. The dose D adds up, and at 1 the tissue is infarcted and stays so:

    f < infarct:                dD/dt = 1 / T(f)
    infarct <= f < penumbra:    dD/dt = 0
    f >= penumbra:              dD/dt = -D / recovery        while D < 1

Each step takes the exact solution for the perfusion at its start. The law of the recovery is not measured: that pauses
in a temporary occlusion help is.

Sources: Jones et al., J Neurosurg 1981 (monkeys: paralysis below 23, infarction below 10 to 12 ml/100g/min for 2 to 3
hours, and below 17 to 18 for good); Astrup, Siesjo, Symon, Stroke 1981 (penumbra).
*/
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mechanics/constraint.h"
#include "core/registry/registry.h"
#include "plugins/ischaemia/perfusion_input.h"

namespace insula {
namespace {

class Ischaemia final : public Constraint {
 public:
  static constexpr std::string_view kind_name = "ischaemia";

  PerfusionInput input{this};
  Param<Perfusion> penumbra{this,
                            {.name = "penumbra",
                             .fallback = "20 ml/100g/min",
                             .min = "1 ml/100g/min",
                             .max = "50 ml/100g/min",
                             .doc = "perfusion below which the tissue has no function"}};
  Param<Perfusion> core{this,
                        {.name = "core",
                         .fallback = "10 ml/100g/min",
                         .min = "1 ml/100g/min",
                         .max = "50 ml/100g/min",
                         .doc = "perfusion below which the time `core_time` counts"}};
  Param<Perfusion> infarct{this,
                           {.name = "infarct",
                            .fallback = "17.5 ml/100g/min",
                            .min = "1 ml/100g/min",
                            .max = "50 ml/100g/min",
                            .doc = "perfusion below which the tissue dies some day"}};
  Param<Duration> arrest{this,
                         {.name = "arrest",
                          .fallback = "5 min",
                          .min = "1 s",
                          .max = "120 min",
                          .doc = "time after which tissue without any blood is dead"}};
  Param<Duration> delay{
      this, {.name = "delay", .fallback = "82 min", .min = "1 s", .max = "1000 min", .doc = "of the law of that time"}};
  Param<Duration> recovery{this,
                           {.name = "recovery",
                            .fallback = "20 min",
                            .min = "1 s",
                            .max = "1000 min",
                            .doc = "time in which the dose decays"}};

  Channel<Perfusion> perfusion{this,
                               {.name = "perfusion",
                                .doc = "of the tissue",
                                .min = "0 ml/100g/min",
                                .max = "300 ml/100g/min",
                                .shown = Shown::vital,
                                .display = "ml/100g/min",
                                .digits = 0,
                                .good = {.from = "35 ml/100g/min"}}};
  Channel<Duration> time{this,
                         {.name = "time",
                          .doc = "in which the perfusion was below `penumbra`",
                          .min = "0 s",
                          .shown = Shown::vital,
                          .display = "s",
                          .digits = 0}};
  Channel<Duration> core_time{this,
                              {.name = "core_time",
                               .doc = "in which the perfusion was below `core`",
                               .min = "0 s",
                               .shown = Shown::none,
                               .display = "s",
                               .digits = 0}};
  Channel<Scalar> dose{this,
                       {.name = "dose",
                        .doc = "share of the time until infarction that is used up; 100 %: infarcted",
                        .min = "0",
                        .max = "1",
                        .display = "%",
                        .digits = 1,
                        .good = {.to = "0.25"},
                        .high = {.to = "0.5"}}};
  Channel<Duration> left{this,
                         {.name = "left",
                          .doc = "time until infarction if the perfusion stays; unknown: there is no danger",
                          .min = "0 s",
                          .shown = Shown::vital,
                          .display = "min",
                          .digits = 1}};
  EventKind begins{this,
                   {.name = "ischaemia",
                    .doc = "a tissue has too little blood for its function",
                    .value = "its perfusion, m3/s/kg",
                    .bad = true}};
  EventKind ends{this, {.name = "ischaemia_over", .doc = "it has enough again", .value = "how long it lasted, s"}};
  EventKind infarction{
      this, {.name = "infarction", .doc = "a tissue is dead", .value = "time below `penumbra`, s", .bad = true}};

  void connect(PrepareContext& context, Simulation&) override {
    if (core() > penumbra()) error(context, core, "is above `penumbra`");
    if (infarct() > penumbra()) error(context, infarct, "is above `penumbra`");
    perfusion.set_bands(perfusion.good(), {penumbra(), {}});
    reset();
  }
  void find_channels(PrepareContext& context, const Simulation& simulation) override {
    input.find(context, simulation);
  }
  void settled(PrepareContext&) override { reset(); }
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }

  void finish(const StepContext& context, const ConstraintSolution&) override {
    now_ = input.now();
    if (std::isnan(now_)) return;
    const double h = context.h, end = context.time + h;
    const auto tell = [&](const EventKind& event, double value) {
      if (context.events) context.events->emit({event.name(), id, "", value, end, -1});
    };
    const bool low = now_ < penumbra();
    if (low && !low_) tell(begins, now_), episode_ = 0;
    if (!low && low_) tell(ends, episode_);
    low_ = low;
    if (low) episode_ += h, below_ += h;
    if (now_ < core()) below_core_ += h;
    if (dose_ >= 1) return;
    if (now_ < infarct()) dose_ = std::min(1.0, dose_ + h / lives());
    if (!low) dose_ *= std::exp(-h / recovery());
    if (dose_ >= 1) tell(infarction, below_);
  }
  void publish() override {
    perfusion.set(now_);
    time.set(below_);
    core_time.set(below_core_);
    dose.set(dose_);
    left.set(now_ < infarct() ? (1 - dose_) * lives() : unknown);
  }
  void reset() override {
    now_ = unknown;
    low_ = false;
    below_ = below_core_ = episode_ = dose_ = 0;
  }
  void append_state(std::vector<double>& out) const override {
    out.insert(out.end(), {double(low_), below_, below_core_, episode_, dose_});
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  /// Time to infarction under the perfusion of now, s.
  double lives() const {
    const double f = std::max(0.0, now_);
    return arrest() + delay() * f / (infarct() - f);
  }

  double now_ = unknown;  ///< m3/(s kg)
  // State.
  bool low_ = false;
  double below_ = 0, below_core_ = 0, episode_ = 0;  ///< s
  double dose_ = 0;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(ischaemia) {
  registry.add<insula::Ischaemia>("ischaemia", insula::Kind::constraint,
                                  "time of a tissue with too little blood, and how near it is to infarction");
}
