// SPDX-License-Identifier: GPL-3.0-or-later
// How long the tools touched a region of a vessel's wall, such as the dome. The metric is named by its id: "dome_time".
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "core/sim/metric.h"
#include "core/sim/simulation.h"
#include "plugins/task_metrics/register.h"

namespace insula {
namespace {

class RegionTouchMetric final : public MetricSet {
 public:
  Ref<ShellBody> on{this, {.name = "on", .doc = "vessel"}};
  Param<std::string> regions{this, {.name = "regions", .doc = "regions of its wall: \"sac bleb\""}};

  Param<std::string> text{
      this, {.name = "text", .fallback = "the wall", .doc = "what is touched, for the trainee: \"the dome\""}};

  void declare(PrepareContext& context, const Simulation&) override {
    const WallModel& model = on->model();
    std::vector<char> wanted(model.regions.size(), 0);
    for (const std::string_view word : split_blanks(regions())) {
      const int region = on->region(word);
      if (region < 0) {
        const std::string near = nearest_name(std::string(word), model.regions);
        error(context, regions,
              in_quotes(word) + " is no region of the vessel" +
                  (near.empty() ? "; it has " + joined(model.regions) : did_you_mean(near)));
        continue;
      }
      wanted[std::size_t(region)] = 1;
    }
    watched_.assign(model.vertex_region.size(), 0);
    for (std::size_t i = 0; i < watched_.size(); ++i) watched_[i] = wanted[std::size_t(model.vertex_region[i])];
    time_ = std::make_unique<MetricBase>(
        this, MetricSpec{id + "_time", "Time in contact with " + text(), "Insula", Better::low, Of::each_hand, "s", 1},
        DisplayedQuantity::quantity_of<Duration>(), true);
  }

  void observe(const StepReport& r) override {
    std::array<bool, 2> touches{};
    for (const ContactPoint& c : r.contacts) {
      const bool first = c.a == &*on;
      if (!(c.normal_force > 0) || (!first && c.b != &*on)) continue;
      const int hand = StructureForces::hand_of(first ? c.b : c.a);
      if (hand >= 0 && !touches[std::size_t(hand)]) touches[std::size_t(hand)] = is_watched(c.position);
    }
    for (std::size_t i = 0; i < 2; ++i)
      if (touches[i]) time_s_[i] += r.h;
  }
  void reset() override { time_s_ = {}; }
  void evaluate() override {
    for (const int i : {left_hand, right_hand}) time_->set_value(0, i, time_s_[std::size_t(i)]);
  }

 private:
  /// Whether the wall's vertex that is nearest to the place is in one of the regions.
  bool is_watched(const Vec3& place) const {
    std::size_t nearest = 0;
    double least = infinite;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
      const double d = (on->q().segment<3>(Eigen::Index(3 * i)) - place).squaredNorm();
      if (d >= least) continue;
      least = d;
      nearest = i;
    }
    return !watched_.empty() && watched_[nearest];
  }

  std::unique_ptr<MetricBase> time_;
  std::vector<char> watched_;  ///< by vertex
  std::array<double, 2> time_s_{};
};

}  // namespace

void register_region_touch_metric(Registry& registry) {
  registry.add<RegionTouchMetric>("region_touch_metric", Kind::metric, "how long tools touched a region of a vessel");
}

}  // namespace insula
