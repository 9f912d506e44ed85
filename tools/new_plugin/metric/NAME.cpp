// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

How steadily the tip of each hand's tool stays near a place: the time within `distance` of it, and the mean distance in
that time. A metric reads the reports of the steps and writes nothing but its own values.
*/
#include <array>

#include "core/registry/registry.h"
#include "core/sim/metric.h"

namespace insula {
namespace {

class @Name@ final : public MetricSet {
 public:
  Param<Vec<Length>> at{this, {.name = "at", .doc = "the place, scene frame"}};
  Param<Length> distance{this,
                         {.name = "distance",
                          .fallback = "1 mm",
                          .min = "0.01 mm",
                          .max = "100 mm",
                          .doc = "of the tip from the place that counts as near"}};

  // Declared once: name, unit, meaning, who defines it, and which direction is better.
  Metric<Duration> near{this,
                        {.name = "@name@_time",
                         .doc = "Time near the place",
                         .source = "the plugin's author",
                         .better = Better::high,
                         .display = "s",
                         .digits = 1}};
  Metric<Length> away{this,
                      {.name = "@name@_distance",
                       .doc = "Mean distance from the place while near",
                       .source = "the plugin's author",
                       .better = Better::low,
                       .display = "mm",
                       .digits = 2}};

  // Every step in which the exercise runs. Must not allocate.
  void observe(const StepReport& report) override {
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const HandReport& h = report.hands[hand];
      const double d = (h.tip.p - at()).norm();
      if (!h.present || !h.tool || d > distance()) continue;
      time_s_[hand] += report.h;
      sum_ms_[hand] += report.h * d;
    }
  }
  // Whenever somebody asks. A value that is not known stays unknown.
  void evaluate() override {
    for (MetricBase* m : metrics()) m->reset();
    for (const int hand : {left_hand, right_hand}) {
      const double time = time_s_[std::size_t(hand)];
      near.set(hand, time);
      if (time > 0) away.set(hand, sum_ms_[std::size_t(hand)] / time);
    }
  }
  void reset() override { time_s_ = sum_ms_ = {}; }

 private:
  std::array<double, 2> time_s_{}, sum_ms_{};  // left, right
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::metric, "@doc@"); }
