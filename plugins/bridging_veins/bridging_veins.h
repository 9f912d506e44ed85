// SPDX-License-Identifier: GPL-3.0-or-later
// Veins that bridge a fissure, as compliant rows, and what they bleed when they part.
#pragma once
#include <array>
#include <vector>

#include "plugins/bipolar_forceps/coagulable.h"
#include "plugins/bleeding/bowl.h"
#include "plugins/strand_springs/strand_springs.h"

namespace insula {

class BridgingVeins final : public StrandSprings, public Coagulable {
 public:
  Param<Length> along{this,
                      {.name = "along",
                       .fallback = "7 mm",
                       .min = "1 mm",
                       .max = "50 mm",
                       .doc = "of each vein that is drawn on either surface before it bridges the gap"}};
  Param<FlowRate> bleeding_rate{this,
                                {.name = "bleeding_rate",
                                 .fallback = "4 ml/min",
                                 .min = "0 ml/min",
                                 .max = "200 ml/min",
                                 .doc = "of a parted vein"}};
  Param<Vec<Length>> origin{this, {.name = "origin", .doc = "bottom of the field that the blood fills"}};
  Param<Vec<Scalar>> up{this, {.name = "up", .fallback = "0 0 1", .doc = "out of the field, against gravity"}};
  Param<Length> bowl_radius{
      this,
      {.name = "bowl_radius", .fallback = "10 mm", .min = "1 mm", .max = "200 mm", .doc = "of the field at its rim"}};
  Param<Length> bowl_depth{this,
                           {.name = "bowl_depth",
                            .fallback = "12 mm",
                            .min = "1 mm",
                            .max = "200 mm",
                            .doc = "of the field from bottom to rim; what is above runs off"}};
  Param<FlowRate> suction_rate{this,
                               {.name = "suction_rate",
                                .fallback = "45 ml/min",
                                .min = "0 ml/min",
                                .max = "2000 ml/min",
                                .doc = "that a suction tube takes while its tip is in the blood"}};
  Param<FlowRate> drain{this,
                        {.name = "drain",
                         .fallback = "1 ml/min",
                         .min = "0 ml/min",
                         .max = "500 ml/min",
                         .doc = "that cotton patties and irrigation take, whatever the hands do"}};

  Channel<Scalar> parted{
      this,
      {.name = "parted", .doc = "veins that have been cut or torn", .min = "0", .shown = Shown::vital, .digits = 0}};
  Channel<FlowRate> rate{this,
                         {.name = "rate",
                          .doc = "blood out of parted veins",
                          .min = "0 ml/min",
                          .shown = Shown::none,
                          .display = "ml/min",
                          .digits = 0}};
  Channel<Volume> lost{
      this, {.name = "lost", .doc = "blood lost from veins", .shown = Shown::none, .display = "ml", .digits = 1}};
  Polylines veins{this,
                  {.name = "veins",
                   .doc = "the veins, two lines each, which meet in the middle of a whole one",
                   .material = "vein",
                   .value = "0",
                   .radius = "0.55 mm",
                   .points_per_line = 8}};
  Polylines jets{this,
                 {.name = "jets",
                  .doc = "where parted veins bleed",
                  .material = "blood",
                  .value = "rate over 60 ml/min, at most 1",
                  .radius = "0.3 mm"}};
  Plane pool{this,
             {.name = "pool",
              .doc = "surface of the blood in the field",
              .material = "blood",
              .value = "height over the bottom of the field",
              .unit = "m",
              .rate_channel = "rate"}};
  EventKind vein_parted{this,
                        {.name = "vein_parted",
                         .doc = "a bridging vein was cut or torn",
                         .value = "force of the blade or tension, N",
                         .bad = true}};
  EventKind vein_closed{this,
                        {.name = "vein_closed", .doc = "heat closed a whole bridging vein", .value = "1", .bad = true}};

  void prepare(PrepareContext& context) override;
  void connect(PrepareContext& context, Simulation& simulation) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;

  /// Veins are kept: none of them is among the strands that an exercise asks to divide.
  int strand_count() const override { return 0; }

  // Each vein has three places for heat: its middle while it is whole, then its two stumps.
  int site_count() const override { return places * count(); }
  std::optional<CoagulationSite> site(int i) const override;
  bool add_dose(const StepContext& context, int i, double dose) override;
  double dose(int i) const override { return doses_[std::size_t(i)]; }
  bool covers(const Vec3& point) const override { return bowl_.covers(volume_, point); }

  double volume() const { return volume_; }  ///< of blood in the field, m3
  int veins_parted() const { return count() - strands_left(); }
  int open_stumps() const;  ///< of parted veins, that heat has not closed

 private:
  enum Place { middle, from_stump, to_stump, places };
  double& dose_of(std::size_t vein, Place p) { return doses_[places * vein + std::size_t(p)]; }
  double dose_of(std::size_t vein, Place p) const { return doses_[places * vein + std::size_t(p)]; }
  bool bleeds(std::size_t vein, Place stump) const;
  static constexpr int points = 8;  ///< of each of a vein's two lines
  static constexpr int ashore = 5;  ///< of these on the surface; the last one is the lip
  /// From the far end to the lip, on the surface `on`.
  struct Course {
    const Surface* on = nullptr;
    std::array<int, ashore> vertex{};
  };
  void spun(int from_vertex, int to_vertex) override;
  void part(const StepContext& context, Strand& s, const EventKind& what, double value) override;
  Course course(const Surface& on, int lip, const Vec3& away) const;
  void draw(std::size_t line, const Course& course, const Strand& s, bool first);
  static double arch(const Strand& s, double length);  ///< of a slack vein over the straight line between its ends, m

  Bowl bowl_;
  std::vector<std::array<Course, 2>> courses_;  ///< one for each vein
  std::vector<Instrument*> tubes_;
  std::vector<double> doses_;     ///< Arrhenius integrals, `places` for each vein
  double volume_ = 0, lost_ = 0;  ///< m3
};

}  // namespace insula
