// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the metrics of a scene reports of made motions instead of steps.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "core/testing/example.h"

namespace insula::test {

class MadeMotion {
 public:
  /// The state of a hand at a time: pose of device and tip, buttons, force. `tool` is set by show().
  using HandAt = std::function<void(double time, HandReport& hand)>;

  /// rate_hz: of the reports.
  explicit MadeMotion(double rate_hz)
      : simulation_(load(std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/motion_metrics/example.xml")) {
    report.h = 1 / rate_hz;
    if (!simulation_) return;
    simulation_->reset();
    report.structures = simulation_->report().structures;
  }
  /// Shows the reports of so many seconds, with the first one at time 0. An empty function: no such hand.
  void show(double seconds, const HandAt& left, const HandAt& right) {
    const auto steps = std::llround(seconds / report.h);
    for (std::int64_t k = 0; k <= steps; ++k) step(double(k) * report.h, left, right);
  }
  void step(double time, const HandAt& left, const HandAt& right) {
    report.time = time;
    for (int i = 0; i < 2; ++i) {
      const HandAt& at = i == 0 ? left : right;
      HandReport hand;
      hand.tool = simulation_->instrument_of(i);
      hand.present = bool(at);
      if (at) at(time, hand);
      report.hands[std::size_t(i)] = hand;
    }
    if (before_step) before_step();
    simulation_->exercise()->observe(report);
    simulation_->exercise()->observe_metrics(report);
  }
  /// All known values, by id and hand.
  using Values = std::map<std::pair<std::string, int>, double>;
  Values values() const {
    Values out;
    for (const MetricSet* set : simulation_->exercise()->children_of<MetricSet>()) {
      simulation_->exercise()->metrics();  // evaluates
      for (const MetricBase* m : set->metrics())
        for (std::size_t item = 0; item < m->items().size(); ++item)
          for (int hand = 0; hand < 3; ++hand)
            if (std::isfinite(m->value(item, hand))) out[{m->id(item), hand}] = m->value(item, hand);
    }
    return out;
  }
  /// SI; NaN: unknown.
  double value(const std::string& id, int hand) const {
    const Values all = values();
    const auto it = all.find({id, hand});
    return it == all.end() ? NAN : it->second;
  }
  Simulation& simulation() { return *simulation_; }

  StepReport report;
  std::function<void()> before_step;

 private:
  std::unique_ptr<Simulation> simulation_;
};

/// A hand whose device and tip are at that place.
inline MadeMotion::HandAt at(std::function<Vec3(double)> place) {
  return [place = std::move(place)](double t, HandReport& hand) { hand.device.p = hand.tip.p = place(t); };
}

/// Minimum-jerk reach (Flash and Hogan 1985): share of the way at the share s of the time.
inline double minimum_jerk(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}
/// Its derivative.
inline double minimum_jerk_speed(double s) { return s <= 0 || s >= 1 ? 0 : 30 * s * s * (1 - s) * (1 - s); }

}  // namespace insula::test
