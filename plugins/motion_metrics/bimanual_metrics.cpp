// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics of both hands together.
#include <algorithm>
#include <cmath>

#include "core/registry/registry.h"
#include "core/sim/metric.h"
#include "plugins/motion_metrics/differences.h"
#include "plugins/motion_metrics/hand_at_work.h"
#include "plugins/motion_metrics/register.h"
#include "plugins/motion_metrics/sources.h"

namespace insula {
namespace {

/// Sums for the correlation of two numbers.
struct Correlation {
  double time = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  void add(double x, double y, double h) {
    time += h;
    a += h * x;
    b += h * y;
    aa += h * x * x;
    bb += h * y * y;
    ab += h * x * y;
  }
  /// Pearson's; NaN if one of them never changes.
  double value() const {
    if (!(time > 0)) return NAN;
    const double va = aa / time - (a / time) * (a / time), vb = bb / time - (b / time) * (b / time);
    const double least = 1e-12;  // of the mean square: rounding
    if (!(va > least * aa / time) || !(vb > least * bb / time)) return NAN;
    return std::clamp((ab / time - (a / time) * (b / time)) / std::sqrt(va * vb), -1.0, 1.0);
  }
};

class BimanualMetrics final : public MetricSet {
 public:
  Param<Speed> speed{
      this,
      {.name = "speed", .fallback = "5 mm/s", .min = "0.1 mm/s", .max = "100 mm/s", .doc = "a faster hand is at work"}};
  Param<Force> touch{this,
                     {.name = "touch",
                      .fallback = "0.005 N",
                      .min = "0 N",
                      .max = "1 N",
                      .doc = "a larger force of the tool on something is work"}};

  Metric<Length> separation{this,
                            {.name = "tip_separation",
                             .doc = "Mean distance of the two tips",
                             .source = sources::winkler,
                             .of = Of::both_hands,
                             .display = "mm",
                             .digits = 1}};
  Metric<Length> least_separation{this,
                                  {.name = "tip_separation_least",
                                   .doc = "Smallest distance of the two tips",
                                   .source = sources::winkler,
                                   .of = Of::both_hands,
                                   .display = "mm",
                                   .digits = 1}};
  Metric<Length> separation_change{this,
                                   {.name = "tip_separation_change",
                                    .doc = "Deviation of the tips' distance",
                                    .source = sources::insula,
                                    .of = Of::both_hands,
                                    .display = "mm",
                                    .digits = 1}};
  Metric<Scalar> simultaneous{this,
                              {.name = "simultaneous_use",
                               .doc = "Simultaneous use",
                               .source = sources::neurotouch,
                               .better = Better::high,
                               .of = Of::both_hands,
                               .display = "%",
                               .digits = 0}};
  Metric<Scalar> coordination{
      this,
      {.name = "coordination", .doc = "Coordination of speeds", .source = sources::hofstad, .of = Of::both_hands}};
  Metric<Scalar> dominance{
      this,
      {.name = "dominance", .doc = "Dominance of the right hand", .source = sources::hofstad, .of = Of::both_hands}};

  void reset() override { sums_ = {}; }

  void observe(const StepReport& r) override {
    std::array<bool, 2> at_work{}, present{};
    std::array<double, 2> fast{};
    for (std::size_t i = 0; i < 2; ++i) {
      const HandReport& hand = r.hands[i];
      present[i] = hand.present && hand.tool;
      if (present[i]) sums_.motion[i].add(hand.device.p, r.h);
      else sums_.motion[i].restart();
      fast[i] = sums_.motion[i].speed();
      sums_.path_m[i] += r.h * fast[i];
      at_work[i] = present[i] && works(hand, fast[i], {speed(), touch()});
    }
    if (at_work[0] || at_work[1]) sums_.one_s += r.h;
    if (at_work[0] && at_work[1]) sums_.both_s += r.h;
    if (!present[0] || !present[1]) return;
    const double distance = (r.hands[0].tip.p - r.hands[1].tip.p).norm();
    sums_.distance.add(distance, distance, r.h);
    sums_.least_m = std::min(sums_.least_m, distance);
    if (sums_.motion[0].has_velocity() && sums_.motion[1].has_velocity()) sums_.speeds.add(fast[0], fast[1], r.h);
  }

  void evaluate() override {
    for (MetricBase* m : metrics()) m->reset();
    const Correlation& d = sums_.distance;
    if (d.time > 0) {
      const double mean = d.a / d.time;
      separation.set(mean);
      least_separation.set(sums_.least_m);
      separation_change.set(std::sqrt(std::max(0.0, d.aa / d.time - mean * mean)));
      coordination.set(sums_.speeds.value());
    }
    if (sums_.one_s > 0) simultaneous.set(sums_.both_s / sums_.one_s);
    const double path = sums_.path_m[0] + sums_.path_m[1];
    if (path > 0) dominance.set((sums_.path_m[1] - sums_.path_m[0]) / path);
  }

 private:
  struct Sums {
    std::array<Differences, 2> motion;
    std::array<double, 2> path_m{};
    double one_s = 0, both_s = 0;  ///< time in which one hand works at least, and both
    double least_m = INFINITY;
    Correlation distance, speeds;
  };
  Sums sums_;
};

}  // namespace

void register_bimanual_metrics(Registry& registry) {
  registry.add<BimanualMetrics>("bimanual_metrics", Kind::metric, "how both hands work together");
}

}  // namespace insula
