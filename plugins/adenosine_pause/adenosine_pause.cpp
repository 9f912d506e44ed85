// SPDX-License-Identifier: GPL-3.0-or-later
/*
# adenosine_pause

A pause of the heart after a dose of adenosine, which the anaesthetist gives on request. The sac becomes soft, and a
clip or a dissector meets less. The command is `give_adenosine` with the dose in milligrams. The surgeon may ask for it;
the usual dose is 0.35 mg/kg.

    <adenosine_pause id="adenosine" pressure="heart" weight="70 kg"/>

The dose acts after `delay`. The heart then stands still for

    T = pause_per_dose * dose / weight

Meanwhile the arteries run empty as a Windkessel does, from their pressure p0 towards the mean filling pressure
`floor`, with `fall` = resistance times compliance. When the heart beats again, p_beat being the pressure that the beat
would have without the pause,

    pause      p(t) = floor + (p0 - floor) exp(-t / fall)
    recovery   p(t) = floor + (p_beat(t) - floor) (1 - s exp(-t / rise)),    s = 1 - (p1 - floor) / (p_beat(0) - floor)

with p1 the pressure at the end of the pause; t counts from the start of each part. After ten times `rise` the recovery
is over. Both parts begin at the end of the step that is nearest to their time.

A dose is refused while another one acts, and beyond the total `most`. The slow heart after the pause and the change of
the resistance are left out.

Sources: Guinn et al. 2011 (0.3 to 0.4 mg/kg give about 45 s of profound hypotension); Bebawy et al. 2010 (dose and
duration); Wesseling et al. 1993 (Windkessel: resistance times compliance 1 to 2 s); Guyton 1955 (filling pressure).
*/
#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/params/number.h"
#include "core/registry/registry.h"
#include "core/registry/surgeon_requests.h"
#include "core/sim/events.h"
#include "core/sim/simulation.h"
#include "plugins/pressure/pressure.h"

namespace insula {
namespace {

constexpr double mg = 1e-6, least_dose = 1 * mg;  // kg
constexpr double recovered_after = 10;            // times `rise`
constexpr double usual_per_kg = 0.35 * mg;        // Guinn et al. 2011

class AdenosinePause final : public Constraint, public HeartPause, public TakesSurgeonRequests {
 public:
  Ref<BloodPressure> pressure{this, {.name = "pressure", .doc = "pressure of the heart that pauses"}};
  Param<Mass> weight{
      this, {.name = "weight", .fallback = "70 kg", .min = "2 kg", .max = "250 kg", .doc = "ideal one of the patient"}};
  Param<Duration> delay{this,
                        {.name = "delay",
                         .fallback = "12 s",
                         .min = "0 s",
                         .max = "120 s",
                         .doc = "from the injection until the heart stands still"}};
  Param<Duration> pause_per_dose{this,
                                 {.name = "pause_per_dose",
                                  .fallback = "130 s",
                                  .min = "1 s",
                                  .max = "1000 s",
                                  .doc = "pause for each mg of the dose over kg of the weight"}};
  Param<Pressure> floor{this,
                        {.name = "floor",
                         .fallback = "15 mmHg",
                         .min = "0 mmHg",
                         .max = "60 mmHg",
                         .doc = "mean filling pressure, to which the arteries fall"}};
  Param<Duration> fall{this,
                       {.name = "fall",
                        .fallback = "1.6 s",
                        .min = "0.1 s",
                        .max = "20 s",
                        .doc = "resistance times compliance of the arteries"}};
  Param<Duration> rise{
      this, {.name = "rise", .fallback = "3 s", .min = "0.1 s", .max = "60 s", .doc = "time constant of the recovery"}};
  Param<Mass> most{this,
                   {.name = "most",
                    .fallback = "120 mg",
                    .min = "1 mg",
                    .max = "1000 mg",
                    .doc = "total of all doses that is given"}};

  Channel<Duration> remaining{this,
                              {.name = "remaining",
                               .doc = "of the pause; 0: the heart beats",
                               .min = "0 s",
                               .shown = Shown::vital,
                               .digits = 0}};
  Channel<Scalar> doses{this,
                        {.name = "doses", .doc = "that were given", .min = "0", .shown = Shown::none, .digits = 0}};
  Channel<Mass> total{this,
                      {.name = "total",
                       .doc = "adenosine that was given",
                       .min = "0 mg",
                       .shown = Shown::none,
                       .display = "mg",
                       .digits = 0}};
  EventKind paused{this, {.name = "heart_paused", .doc = "the heart stands still", .value = "for so long, s"}};
  EventKind resumed{this,
                    {.name = "heart_resumed", .doc = "the heart beats again", .value = "pressure of the arteries, Pa"}};

  void connect(PrepareContext& context, Simulation&) override {
    if (!pressure->set_pause(this)) error(context, pressure, in_quotes(pressure->id) + " has a pause already");
  }
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }

  bool beating() const override { return part_ != Part::pause; }
  bool acting() const override { return part_ == Part::pause || part_ == Part::recovery; }
  double arterial(double h, double of_beat) const override {
    const double t = time_ + h;
    if (part_ == Part::pause) return floor() + (from_ - floor()) * std::exp(-t / fall());
    if (part_ == Part::recovery) return floor() + (of_beat - floor()) * (1 - from_ * std::exp(-t / rise()));
    return of_beat;
  }
  void advance(double h, double of_beat) override {
    if (part_ == Part::none) return;
    time_ += h;
    const double length = part_ == Part::delay ? delay() : part_ == Part::pause ? pause_ : recovered_after * rise();
    if (time_ + 0.5 * h < length) return;
    const double now = arterial(0, of_beat);
    if (part_ == Part::delay) begin(Part::pause, now);
    else if (part_ == Part::pause)
      begin(Part::recovery, of_beat > floor() ? 1 - (now - floor()) / (of_beat - floor()) : 0);
    else begin(Part::none, 0);
  }

  void finish(const StepContext& context, const ConstraintSolution&) override {
    if (part_ == told_) return;
    told_ = part_;
    const double end = context.time + context.h;
    if (!context.events) return;
    if (part_ == Part::pause) context.events->emit({paused.name(), id, "", pause_, end});
    if (part_ == Part::recovery) context.events->emit({resumed.name(), id, "", pressure->arterial(0), end});
  }
  void publish() override {
    remaining.set(part_ == Part::pause ? pause_ - time_ : 0);
    doses.set(doses_);
    total.set(total_);
  }

  std::vector<CommandInfo> commands() const override {
    return {{"give_adenosine", "the heart pauses some seconds later", "dose_mg", std::round(least_dose / mg),
             std::round(most() / mg)}};
  }
  std::vector<SurgeonRequest> surgeon_requests() const override {
    const double usual = std::round(usual_per_kg * weight() / mg);
    return {{"give_adenosine", std::clamp(usual, std::round(least_dose / mg), std::round(most() / mg))}};
  }
  std::string run_command(std::string_view name, std::string_view argument) override {
    if (name != "give_adenosine") return "unknown command " + in_quotes(name);
    std::string why;
    const auto dose = read_number(trim(argument), why);
    if (!dose) return std::string(name) + " needs a number: " + why;
    if (*dose * mg < least_dose || *dose * mg > most() * (1 + 1e-12))
      return std::string(name) + ": " + shown(argument) + " is outside the allowed range " +
             std::to_string(int(std::round(least_dose / mg))) + " to " + std::to_string(int(std::round(most() / mg)));
    if (part_ != Part::none) return "the last dose of adenosine still acts";
    if (total_ + *dose * mg > most() * (1 + 1e-12)) return "no more adenosine: the total would be too high";
    ++doses_;
    total_ += *dose * mg;
    pause_ = pause_per_dose() * *dose / weight();
    begin(Part::delay, 0);
    return {};
  }

  void reset() override {
    part_ = told_ = Part::none;
    time_ = from_ = pause_ = total_ = 0;
    doses_ = 0;
  }
  void append_state(std::vector<double>& out) const override {
    if (doses_ > 0) out.insert(out.end(), {double(part_), time_, from_, pause_, total_, double(doses_)});
  }

 private:
  enum class Part { none, delay, pause, recovery };
  void begin(Part part, double from) {
    part_ = part;
    time_ = 0;
    from_ = from;
  }

  Part part_ = Part::none, told_ = Part::none;
  double time_ = 0;               ///< in this part, s
  double from_ = 0;               ///< pause: pressure at its start, Pa; recovery: share that is missing there
  double pause_ = 0, total_ = 0;  ///< length, s; of all doses, kg
  int doses_ = 0;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(adenosine_pause) {
  registry.add<insula::AdenosinePause>("adenosine_pause", insula::Kind::constraint,
                                       "pause of the heart after a dose of adenosine");
}
