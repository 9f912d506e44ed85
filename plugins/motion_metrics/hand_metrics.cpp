// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics of each hand for itself.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "core/sim/metric.h"
#include "core/sim/simulation.h"
#include "plugins/motion_metrics/band_pass.h"
#include "plugins/motion_metrics/force_figures.h"
#include "plugins/motion_metrics/hand_at_work.h"
#include "plugins/motion_metrics/movements.h"
#include "plugins/motion_metrics/register.h"
#include "plugins/motion_metrics/sources.h"

namespace insula {
namespace {

/// What is known of one hand.
struct Hand {
  Differences motion;
  Movements movements;
  BandPass tremor;
  ForceFigures force;
  std::vector<ForceFigures> on_structure;
  const Instrument* tool = nullptr;
  bool seen = false;     ///< it was there in some step
  bool follows = false;  ///< it was there in the step before
  Pose tip, device;      ///< in the step before
  std::array<bool, 2> button{};
  double time_s = 0, active_s = 0, button_s = 0, path_m = 0, turn_rad = 0, along_shaft_m = 0;
  double peak_speed = 0, acceleration2 = 0, acceleration_s = 0;
  int exchanges = 0, presses = 0;
};

class HandMetrics final : public MetricSet {
 public:
  Param<Speed> speed{
      this,
      {.name = "speed", .fallback = "5 mm/s", .min = "0.1 mm/s", .max = "100 mm/s", .doc = "a faster hand moves"}};
  Param<Duration> pause{
      this,
      {.name = "pause", .fallback = "0.2 s", .min = "0 s", .max = "2 s", .doc = "a longer pause ends a movement"}};
  Param<Force> touch{this,
                     {.name = "touch",
                      .fallback = "0.005 N",
                      .min = "0 N",
                      .max = "1 N",
                      .doc = "a larger force of the tool on something is contact"}};
  Param<Frequency> tremor_from{
      this,
      {.name = "tremor_from", .fallback = "8 Hz", .min = "1 Hz", .max = "40 Hz", .doc = "lowest frequency of tremor"}};
  Param<Frequency> tremor_to{
      this,
      {.name = "tremor_to", .fallback = "12 Hz", .min = "2 Hz", .max = "50 Hz", .doc = "highest frequency of tremor"}};

  Metric<Duration> active_time{
      this, {.name = "active_time", .doc = "Time at work", .source = sources::hofstad, .display = "s", .digits = 1}};
  Metric<Duration> idle_time{this,
                             {.name = "idle_time",
                              .doc = "Idle time",
                              .source = sources::hofstad,
                              .better = Better::low,
                              .display = "s",
                              .digits = 1}};
  Metric<Length> path_length{this,
                             {.name = "path_length",
                              .doc = "Path of the hand",
                              .source = sources::cotin,
                              .better = Better::low,
                              .display = "mm",
                              .digits = 0}};
  Metric<Scalar> economy{this,
                         {.name = "economy",
                          .doc = "Economy of movement",
                          .source = sources::hofstad,
                          .better = Better::high,
                          .display = "%",
                          .digits = 0}};
  Metric<Scalar> movements{this,
                           {.name = "movements",
                            .doc = "Number of movements",
                            .source = sources::hofstad,
                            .better = Better::low,
                            .digits = 0}};
  Metric<Speed> speed_mean{this,
                           {.name = "speed_mean",
                            .doc = "Mean speed of movement",
                            .source = sources::hofstad,
                            .display = "mm/s",
                            .digits = 1}};
  Metric<Speed> speed_peak{this,
                           {.name = "speed_peak",
                            .doc = "Largest speed",
                            .source = sources::hofstad,
                            .better = Better::low,
                            .display = "mm/s",
                            .digits = 0}};
  Metric<Acceleration> acceleration{this,
                                    {.name = "acceleration",
                                     .doc = "Acceleration (rms)",
                                     .source = sources::hofstad,
                                     .better = Better::low,
                                     .digits = 2}};
  Metric<Scalar> log_jerk{this,
                          {.name = "log_dimensionless_jerk",
                           .doc = "Smoothness (log jerk)",
                           .source = sources::balasubramanian,
                           .better = Better::high,
                           .digits = 2}};
  Metric<Scalar> arc_length{this,
                            {.name = "spectral_arc_length",
                             .doc = "Smoothness (spectral arc)",
                             .source = sources::balasubramanian,
                             .better = Better::high,
                             .digits = 2}};
  Metric<Length> tremor{this,
                        {.name = "tremor",
                         .doc = "Tremor (rms)",
                         .source = sources::harwell,
                         .better = Better::low,
                         .display = "um",
                         .digits = 1}};
  Metric<Angle> turn{this,
                     {.name = "turn",
                      .doc = "Turning",
                      .source = sources::cotin,
                      .better = Better::low,
                      .display = "deg",
                      .digits = 0}};
  Metric<Length> depth_travel{this,
                              {.name = "depth_travel",
                               .doc = "Depth travelled",
                               .source = sources::cotin,
                               .better = Better::low,
                               .display = "mm",
                               .digits = 0}};
  Metric<Scalar> exchanges{this,
                           {.name = "tool_exchanges", .doc = "Tool exchanges", .source = sources::insula, .digits = 0}};
  Metric<Scalar> presses{this,
                         {.name = "button_presses", .doc = "Button presses", .source = sources::insula, .digits = 0}};
  Metric<Duration> button_time{this,
                               {.name = "button_time",
                                .doc = "Time with a button pressed",
                                .source = sources::insula,
                                .display = "s",
                                .digits = 1}};
  Metric<Duration> contact_time{
      this,
      {.name = "contact_time", .doc = "Time in contact", .source = sources::neurotouch, .display = "s", .digits = 1}};
  Metric<Force> force_mean{this,
                           {.name = "force_mean",
                            .doc = "Mean force in contact",
                            .source = sources::neurotouch,
                            .better = Better::low,
                            .digits = 3}};
  Metric<Force> force_peak{this,
                           {.name = "force_peak",
                            .doc = "Largest force",
                            .source = sources::neurotouch,
                            .better = Better::low,
                            .digits = 3}};
  Metric<Force> force_p95{this,
                          {.name = "force_p95",
                           .doc = "95th percentile of force",
                           .source = sources::insula,
                           .better = Better::low,
                           .digits = 3}};
  Metric<ForceRate> force_rate{this,
                               {.name = "force_rate",
                                .doc = "Rate of force (rms)",
                                .source = sources::hofstad,
                                .better = Better::low,
                                .digits = 2}};
  Metric<Impulse> force_impulse{
      this,
      {.name = "force_impulse", .doc = "Impulse", .source = sources::neurotouch, .better = Better::low, .digits = 2}};
  MetricGroup<Duration> tissue_time{
      this,
      {.name = "tissue_time", .doc = "Time with force on", .source = sources::neurotouch, .display = "s", .digits = 1}};
  MetricGroup<Force> tissue_mean{this,
                                 {.name = "tissue_force_mean",
                                  .doc = "Mean force on",
                                  .source = sources::neurotouch,
                                  .better = Better::low,
                                  .digits = 3}};
  MetricGroup<Force> tissue_peak{this,
                                 {.name = "tissue_force_peak",
                                  .doc = "Largest force on",
                                  .source = sources::neurotouch,
                                  .better = Better::low,
                                  .digits = 3}};
  MetricGroup<Force> tissue_p95{this,
                                {.name = "tissue_force_p95",
                                 .doc = "95th percentile of force on",
                                 .source = sources::insula,
                                 .better = Better::low,
                                 .digits = 3}};
  MetricGroup<ForceRate> tissue_rate{this,
                                     {.name = "tissue_force_rate",
                                      .doc = "Rate of force (rms) on",
                                      .source = sources::hofstad,
                                      .better = Better::low,
                                      .digits = 2}};
  MetricGroup<Impulse> tissue_impulse{this,
                                      {.name = "tissue_impulse",
                                       .doc = "Impulse on",
                                       .source = sources::neurotouch,
                                       .better = Better::low,
                                       .digits = 2}};

  void prepare(PrepareContext& context) override {
    if (tremor_from() >= tremor_to()) error(context, tremor_from, "must be below tremor_to");
    if (2 * tremor_to() * context.time_step_s >= 1)
      error(context, tremor_to, "is not below half of the scene's rate of steps");
  }
  void declare(PrepareContext&, const Simulation& simulation) override {
    structures_.clear();
    for (const StructureForce& s : simulation.report().structures) structures_.push_back(s.body->id);
    tissue_time.declare_items(structures_);
    for (MetricGroup<Force>* group : {&tissue_mean, &tissue_peak, &tissue_p95}) group->declare_items(structures_);
    tissue_rate.declare_items(structures_);
    tissue_impulse.declare_items(structures_);
    reset();
  }
  void reset() override {
    for (Hand& hand : hands_) {
      hand = Hand();
      hand.movements.limits(speed(), pause());
      hand.tremor.limits(tremor_from(), tremor_to());
      hand.force.limit(touch());
      hand.on_structure.assign(structures_.size(), ForceFigures(touch()));
    }
  }

  void observe(const StepReport& r) override {
    for (std::size_t i = 0; i < 2; ++i) {
      if (r.hands[i].present && r.hands[i].tool) move(hands_[i], r.hands[i], r.h);
      else rest(hands_[i]);
      for (std::size_t k = 0; k < structures_.size() && k < r.structures.size(); ++k)
        hands_[i].on_structure[k].add(r.structures[k].of_hand[i].norm(), r.h);
    }
  }

  void evaluate() override {
    for (MetricBase* m : metrics()) m->reset();
    for (const int i : {left_hand, right_hand}) {
      const Hand& hand = hands_[std::size_t(i)];
      if (!hand.seen) continue;
      evaluate_motion(i, hand);
      evaluate_force(i, hand);
    }
  }

 private:
  static void rest(Hand& hand) {
    hand.motion.restart();
    hand.movements.add(hand.motion, 0);
    hand.tremor.restart();
    hand.follows = false;
  }

  void move(Hand& hand, const HandReport& now, double h) {
    hand.motion.add(now.device.p, h);
    hand.movements.add(hand.motion, h);
    hand.tremor.add(now.device.p, h);
    hand.force.add(now.contact_force, h);
    const double speed_now = hand.motion.speed();
    hand.time_s += h;
    if (works(now, speed_now, {speed(), touch()})) hand.active_s += h;
    hand.path_m += h * speed_now;
    hand.peak_speed = std::max(hand.peak_speed, speed_now);
    if (hand.motion.has_acceleration()) {
      hand.acceleration2 += h * hand.motion.acceleration().squaredNorm();
      hand.acceleration_s += h;
    }
    if (hand.follows) {
      hand.turn_rad += hand.device.q.angularDistance(now.device.q);
      if (hand.tool == now.tool) {
        const Vec3 along = hand.tip.q * Vec3::UnitZ();
        hand.along_shaft_m += std::abs((now.tip.p - hand.tip.p).dot(along));
      }
      for (std::size_t b = 0; b < 2; ++b) hand.presses += now.button[b] && !hand.button[b];
    }
    if (hand.tool && hand.tool != now.tool) ++hand.exchanges;
    if (now.button[0] || now.button[1]) hand.button_s += h;
    hand.tool = now.tool;
    hand.tip = now.tip;
    hand.device = now.device;
    hand.button = now.button;
    hand.seen = hand.follows = true;
  }

  void evaluate_motion(int i, const Hand& hand) {
    active_time.set(i, hand.active_s);
    idle_time.set(i, hand.time_s - hand.active_s);
    path_length.set(i, hand.path_m);
    const MovementFigures moved = hand.movements.figures();
    movements.set(i, double(moved.count));
    if (moved.path_m > 0) economy.set(i, moved.direct_m / moved.path_m);
    if (moved.duration_s > 0) speed_mean.set(i, moved.path_m / moved.duration_s);
    speed_peak.set(i, hand.peak_speed);
    if (hand.acceleration_s > 0) acceleration.set(i, std::sqrt(hand.acceleration2 / hand.acceleration_s));
    if (moved.judged > 0) {
      log_jerk.set(i, moved.log_jerk / double(moved.judged));
      arc_length.set(i, moved.arc_length / double(moved.judged));
    }
    tremor.set(i, std::sqrt(hand.tremor.mean_square()));
    turn.set(i, hand.turn_rad);
    depth_travel.set(i, hand.along_shaft_m);
    exchanges.set(i, hand.exchanges);
    presses.set(i, hand.presses);
    button_time.set(i, hand.button_s);
  }

  void evaluate_force(int i, const Hand& hand) {
    contact_time.set(i, hand.force.time_s());
    force_mean.set(i, hand.force.mean_N());
    force_peak.set(i, hand.force.peak_N());
    force_p95.set(i, hand.force.percentile_N(0.95));
    force_rate.set(i, hand.force.rate_N_s());
    force_impulse.set(i, hand.force.impulse_Ns());
    for (std::size_t k = 0; k < structures_.size(); ++k) {
      const ForceFigures& f = hand.on_structure[k];
      tissue_time.set(k, i, f.time_s());
      tissue_mean.set(k, i, f.mean_N());
      tissue_peak.set(k, i, f.peak_N());
      tissue_p95.set(k, i, f.percentile_N(0.95));
      tissue_rate.set(k, i, f.rate_N_s());
      tissue_impulse.set(k, i, f.impulse_Ns());
    }
  }

  std::vector<std::string> structures_;
  std::array<Hand, 2> hands_;
};

}  // namespace

void register_hand_metrics(Registry& registry) {
  registry.add<HandMetrics>("hand_metrics", Kind::metric, "how each hand moves and presses");
}

}  // namespace insula
