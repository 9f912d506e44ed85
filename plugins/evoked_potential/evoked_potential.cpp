// SPDX-License-Identifier: GPL-3.0-or-later
/*
# evoked_potential

A somatosensory or motor evoked potential, as neurophysiologists watch it during an operation: its amplitude and latency
follow the perfusion of the tissue that makes it.

    <evoked_potential id="n20" channel="circle.mca_superior_right.perfusion"/>

The channel is read as in `ischaemia`. A tissue whose perfusion f is constant has the amplitude

    A0(f) = (f - lost) / (full - lost), between 0 and 1

of that at rest. It comes to this amplitude with the time T, which is `decline` downwards and `return` upwards. Each
step takes the exact solution:

    T dA/dt = A0(f) - A,        A(t + h) = A0 + (A(t) - A0) exp(-h / T)

The latency grows as the amplitude falls: L = latency (1 + prolongation (1 - A)). A potential below a twentieth of its
amplitude has no latency. The alarm is a fall below `alarm`, and counts again once the amplitude is a tenth above it.
With the defaults, half of the amplitude is a latency that is 10 % longer. Both are the usual limits.

The trace repeats the averaged response of `window` after the stimulus, slowed down to `sweep`, so that a curve shows
it. It is the difference of two bells of width w at L and 1.3 L:

    V = A (exp(-((t - L) / w)^2) - 0.7 exp(-((t - 1.3 L) / w)^2)),     w = 0.1 latency

Sources: Branston et al., Exp Neurol 1974, and Astrup et al., Stroke 1977 (the response fails at 15 to 20 ml/100g/min);
Symon et al., Adv Neurol 1979; MacDonald et al., Clin Neurophysiol 2013 (50 % and 10 %).
*/
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mechanics/constraint.h"
#include "core/registry/registry.h"
#include "plugins/ischaemia/perfusion_input.h"

namespace insula {
namespace {

constexpr double flat = 0.05;  // amplitude below which there is no latency

class EvokedPotential final : public Constraint {
 public:
  static constexpr std::string_view kind_name = "evoked_potential";

  PerfusionInput input{this};
  Param<Perfusion> lost{this,
                        {.name = "lost",
                         .fallback = "15 ml/100g/min",
                         .min = "1 ml/100g/min",
                         .max = "50 ml/100g/min",
                         .doc = "perfusion at which the potential is lost"}};
  Param<Perfusion> full{this,
                        {.name = "full",
                         .fallback = "20 ml/100g/min",
                         .min = "1 ml/100g/min",
                         .max = "100 ml/100g/min",
                         .doc = "perfusion from which on it is whole"}};
  Param<Duration> decline{this,
                          {.name = "decline",
                           .fallback = "60 s",
                           .min = "0.1 s",
                           .max = "1000 s",
                           .doc = "time in which the amplitude falls"}};
  Param<Duration> back{this,
                       {.name = "return",
                        .fallback = "120 s",
                        .min = "0.1 s",
                        .max = "5000 s",
                        .doc = "time in which the amplitude comes back"}};
  Param<Scalar> alarm{this,
                      {.name = "alarm",
                       .fallback = "0.5",
                       .min = "0.05",
                       .max = "0.9",
                       .doc = "amplitude over that at rest below which the surgeon is warned"}};
  Param<Duration> rest_latency{this,
                               {.name = "latency",
                                .fallback = "20 ms",
                                .min = "1 ms",
                                .max = "200 ms",
                                .doc = "of the wave at rest; 20 ms: the cortical response to the median nerve"}};
  Param<Scalar> prolongation{this,
                             {.name = "prolongation",
                              .fallback = "0.2",
                              .min = "0",
                              .max = "2",
                              .doc = "how much longer the latency of a vanishing wave is, over that at rest"}};
  Param<Duration> window{this,
                         {.name = "window",
                          .fallback = "50 ms",
                          .min = "2 ms",
                          .max = "1000 ms",
                          .doc = "after the stimulus, that the trace shows"}};
  Param<Duration> sweep{
      this, {.name = "sweep", .fallback = "2 s", .min = "0.2 s", .max = "60 s", .doc = "time the trace takes for it"}};

  Channel<Scalar> amplitude{this,
                            {.name = "amplitude",
                             .doc = "of the potential over that at rest",
                             .min = "0",
                             .max = "1",
                             .shown = Shown::vital,
                             .display = "%",
                             .digits = 0}};
  Channel<Duration> latency{this,
                            {.name = "latency",
                             .doc = "of its wave; unknown: it is flat",
                             .min = "0 ms",
                             .shown = Shown::vital,
                             .display = "ms",
                             .digits = 1}};
  Channel<Scalar> trace{this,
                        {.name = "trace",
                         .doc = "the averaged response, slowed down; the negative wave is up",
                         .min = "-1",
                         .max = "1",
                         .digits = 2}};
  EventKind warning{this,
                    {.name = "evoked_potential_low",
                     .doc = "the amplitude has fallen below the alarm",
                     .value = "amplitude over that at rest",
                     .bad = true}};
  EventKind over{this,
                 {.name = "evoked_potential_back",
                  .doc = "the amplitude is above the alarm again",
                  .value = "amplitude over that at rest"}};

  void connect(PrepareContext& context, Simulation&) override {
    if (!(full() > lost())) error(context, full, "is not above `lost`");
    amplitude.set_bands({1.1 * alarm(), {}}, {alarm(), {}});
    latency.set_max(rest_latency() * (1 + prolongation()));
    reset();
  }
  void find_channels(PrepareContext& context, const Simulation& simulation) override {
    input.find(context, simulation);
  }
  void settled(PrepareContext&) override { reset(); }
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }

  void finish(const StepContext& context, const ConstraintSolution&) override {
    const double h = context.h;
    phase_ = std::fmod(phase_ + h / sweep(), 1.0);
    const double f = input.now();
    if (std::isnan(f)) return;
    const double wanted = std::clamp((f - lost()) / (full() - lost()), 0.0, 1.0);
    amplitude_ += (wanted - amplitude_) * -std::expm1(-h / (wanted < amplitude_ ? decline() : back()));
    const bool low = low_ ? amplitude_ < 1.1 * alarm() : amplitude_ < alarm();
    if (low != low_ && context.events)
      context.events->emit({(low ? warning : over).name(), id, "", amplitude_, context.time + h, -1});
    low_ = low;
  }
  void publish() override {
    amplitude.set(amplitude_);
    latency.set(amplitude_ < flat ? unknown : delayed());
    trace.set(response(phase_ * window()));
  }
  void reset() override {
    amplitude_ = 1;
    phase_ = 0;
    low_ = false;
  }
  void append_state(std::vector<double>& out) const override {
    out.insert(out.end(), {amplitude_, phase_, double(low_)});
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double delayed() const { return rest_latency() * (1 + prolongation() * (1 - amplitude_)); }
  double response(double t) const {
    const auto bell = [&](double at) { return std::exp(-std::pow((t - at) / (0.1 * rest_latency()), 2)); };
    return amplitude_ * (bell(delayed()) - 0.7 * bell(1.3 * delayed()));
  }

  // State.
  double amplitude_ = 1;  ///< over that at rest
  double phase_ = 0;      ///< of the trace, 0..1
  bool low_ = false;      ///< the alarm is on
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(evoked_potential) {
  registry.add<insula::EvokedPotential>("evoked_potential", insula::Kind::constraint,
                                        "evoked potential of a tissue, which falls with its perfusion");
}
