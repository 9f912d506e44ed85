// SPDX-License-Identifier: GPL-3.0-or-later
// A thin artery between an artery and the tissue behind it. perforator.cpp describes its law and its scene element.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/sim/simulation.h"
#include "plugins/clip/clip_state.h"

namespace insula {

class Perforator final : public Constraint, public StatesLaw {
 public:
  static constexpr int points = 25;  ///< of its course

  Ref<Surface> from{this, {.name = "from", .doc = "surface of the artery where it begins"}};
  Ref<Surface> to{this, {.name = "to", .doc = "surface of the tissue where it ends"}};
  Param<Vec<Length>> start{this,
                           {.name = "start", .doc = "where it begins: at the nearest vertex, scene frame at rest"}};
  Param<Vec<Length>> end{this, {.name = "end", .doc = "where it ends: at the nearest vertex, scene frame at rest"}};
  Param<Vec<Length>> bulge{
      this,
      {.name = "bulge", .fallback = "0 0 0 mm", .doc = "how far its middle lies beside the straight line at rest"}};
  Param<Length> diameter{
      this, {.name = "diameter", .fallback = "0.5 mm", .min = "0.05 mm", .max = "3 mm", .doc = "of the vessel"}};
  Param<Length> occluded_slit{this,
                              {.name = "occluded_slit",
                               .fallback = "0.8 mm",
                               .min = "0 mm",
                               .max = "3 mm",
                               .doc = "slit of the blades at which no blood passes"}};
  Param<Stiffness> stiffness{this,
                             {.name = "stiffness",
                              .fallback = "50 N/m",
                              .min = "0.1 N/m",
                              .max = "10000 N/m",
                              .doc = "of the whole vessel when it is pulled"}};
  Param<Scalar> slack{this,
                      {.name = "slack",
                       .fallback = "1.3",
                       .min = "0.5",
                       .max = "5",
                       .doc = "length without tension over the distance of its ends at rest"}};
  Param<Force> strength{
      this, {.name = "strength", .fallback = "0.1 N", .min = "0.001 N", .max = "10 N", .doc = "tension that tears it"}};

  Channel<Scalar> flow{this,
                       {.name = "flow_share",
                        .doc = "its flow over that at rest",
                        .min = "0",
                        .max = "1",
                        .shown = Shown::vital,
                        .display = "%",
                        .digits = 0,
                        .good = {.from = "0.75"},
                        .high = {.from = "0.5"}}};
  Channel<Force> tension{
      this, {.name = "tension", .doc = "along it", .min = "0 N", .shown = Shown::none, .display = "mN", .digits = 0}};
  Polylines course{this,
                   {.name = "course",
                    .doc = "the vessel",
                    .material = "vessel",
                    .value = "its flow over that at rest; negative: torn",
                    .radius = "0.25 mm",
                    .points_per_line = points}};
  EventKind occlusion{this,
                      {.name = "perforator_shut",
                       .doc = "a clip closed on a perforator",
                       .value = "its flow over that at rest",
                       .bad = true}};
  EventKind tear{
      this, {.name = "perforator_torn", .doc = "a perforator was torn off", .value = "its tension, N", .bad = true}};

  void connect(PrepareContext& context, Simulation& simulation) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override;

  /// Flow over that at rest, 0 to 1.
  double flow_share() const {
    const double open = std::clamp(share_, 0.0, 1.0);
    return open * open * open * open;
  }
  bool torn() const { return torn_; }

 private:
  Vec3 on_course(double s) const;
  void catch_between_blades();
  double across_blades(const ClipState& clip, const Vec3& x) const;

  Clips clips_;
  MaterialPoint a_, b_;
  double rest_ = 0;           ///< length without tension, m
  Vec3 side_ = Vec3::Zero();  ///< bulge, perpendicular to the chord at rest
  std::array<Vec3, points> at_{};
  std::array<int, points> holder_{};  ///< clip whose blades a point lies between, -1: none
  int row_ = -1;
  double pull_ = 0, share_ = 1;  ///< tension, N; narrowest opening over the diameter
  bool torn_ = false, caught_ = false;
};

}  // namespace insula
