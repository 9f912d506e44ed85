// SPDX-License-Identifier: GPL-3.0-or-later
// A tear of the wall that bleeds into the field (equations in bleeding.cpp).
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/mechanics/instrument.h"
#include "plugins/bipolar_forceps/coagulable.h"
#include "plugins/bleeding/bleeding_state.h"
#include "plugins/bleeding/bowl.h"
#include "plugins/blood_flow/blood_flow.h"

namespace insula {

class Bleeding final : public Constraint, public BleedingSource, public Coagulable {
 public:
  static constexpr std::string_view kind_name = "bleeding";

  Ref<ShellBody> on{this, {.name = "on", .doc = "vessel whose wall may tear"}};
  Ref<BloodFlow> flow{this, {.name = "flow", .doc = "network that feeds the tear"}};
  Param<std::string> region{this, {.name = "region", .fallback = "bleb", .doc = "region of the wall that tears"}};
  Param<Force> force{this,
                     {.name = "force",
                      .fallback = "0.6 N",
                      .min = "0.001 N",
                      .max = "100 N",
                      .doc = "on the region by instruments and clips, that tears it"}};
  Param<Force> sharp_force{this,
                           {.name = "sharp_force",
                            .fallback = "0.15 N",
                            .min = "0.001 N",
                            .max = "100 N",
                            .doc = "the same by instruments with a cutting edge"}};
  Param<Pressure> burst{this,
                        {.name = "burst",
                         .fallback = "280 mmHg",
                         .min = "50 mmHg",
                         .max = "1000 mmHg",
                         .doc = "pressure inside that tears it"}};
  Param<Area> tear_area{
      this, {.name = "tear_area", .fallback = "0.3 mm2", .min = "0.001 mm2", .max = "20 mm2", .doc = "of the opening"}};
  Param<Vec<Length>> origin{this, {.name = "origin", .doc = "bottom of the field"}};
  Param<Vec<Scalar>> up{this, {.name = "up", .fallback = "0 0 1", .doc = "out of the field, against gravity"}};
  Param<Length> radius{
      this, {.name = "radius", .fallback = "15 mm", .min = "1 mm", .max = "200 mm", .doc = "of the field at its rim"}};
  Param<Length> depth{this,
                      {.name = "depth",
                       .fallback = "20 mm",
                       .min = "1 mm",
                       .max = "200 mm",
                       .doc = "of the field from bottom to rim; what is above runs off"}};
  Param<FlowRate> suction_rate{this,
                               {.name = "suction_rate",
                                .fallback = "45 ml/min",
                                .min = "0 ml/min",
                                .max = "2000 ml/min",
                                .doc = "that a suction tube takes while its tip is in the blood"}};
  Param<Scalar> idle_suction{this,
                             {.name = "idle_suction",
                              .fallback = "0.1",
                              .min = "0",
                              .max = "1",
                              .doc = "share of that which it takes with its vent open"}};
  Param<FlowRate> drain{this,
                        {.name = "drain",
                         .fallback = "0 ml/min",
                         .min = "0 ml/min",
                         .max = "500 ml/min",
                         .doc = "that cotton patties and irrigation take, whatever the hands do"}};

  Channel<FlowRate> bleeding_rate{this,
                                  {.name = "rate",
                                   .doc = "blood out of the tear",
                                   .min = "0 ml/min",
                                   .shown = Shown::vital,
                                   .display = "ml/min",
                                   .digits = 0,
                                   .good = {.to = "1 ml/min"},
                                   .high = {.to = "20 ml/min"}}};
  Channel<Volume> lost{
      this, {.name = "lost", .doc = "blood lost since the tear", .shown = Shown::vital, .display = "ml", .digits = 1}};
  Channel<Length> level{this,
                        {.name = "height",
                         .doc = "of the blood over the bottom of the field",
                         .min = "0 m",
                         .display = "mm",
                         .digits = 1}};
  Channel<FlowRate> sucked{this,
                           {.name = "sucked",
                            .doc = "blood that suction tubes take out of the field",
                            .min = "0 ml/min",
                            .shown = Shown::none,
                            .display = "ml/min",
                            .digits = 0}};
  Channel<Duration> since{
      this, {.name = "since", .doc = "time since the rupture", .min = "0 s", .shown = Shown::none, .digits = 0}};
  Channel<Scalar> load{this,
                       {.name = "load",
                        .doc = "force on the region over that which tears it; unknown once it is torn",
                        .min = "0",
                        .shown = Shown::none,
                        .display = "%",
                        .digits = 0}};
  Channel<Scalar> is_open{this,
                          {.name = "open",
                           .doc = "1 while there is a tear, else 0",
                           .min = "0",
                           .max = "1",
                           .shown = Shown::none,
                           .digits = 0}};
  Plane pool{this,
             {.name = "pool",
              .doc = "surface of the blood in the field",
              .material = "blood",
              .value = "height over the bottom of the field",
              .unit = "m",
              .rate_channel = "rate"}};
  Polylines jet{this,
                {.name = "jet",
                 .doc = "where the blood leaves, and its direction",
                 .material = "blood",
                 .value = "rate over 60 ml/min, at most 1",
                 .radius = "0.3 mm"}};
  EventKind ruptured{
      this, {.name = "rupture", .doc = "the wall tears", .value = "force or pressure that tore it", .bad = true}};
  EventKind stopped{this,
                    {.name = "bleeding_stopped", .doc = "the bleeding has come to a stand", .value = "blood lost, m3"}};
  EventKind again{this, {.name = "bleeding_again", .doc = "it bleeds anew", .value = "rate, m3/s", .bad = true}};

  void prepare(PrepareContext& context) override;
  void connect(PrepareContext& context, Simulation& simulation) override;
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  BleedingState bleeding() const override { return {open_, rate_, lost_, height(), since_}; }
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  std::vector<CommandInfo> commands() const override;
  std::string run_command(std::string_view name, std::string_view argument) override;

  // Heat closes the tear while no jet carries the heat away.
  int site_count() const override { return 1; }
  std::optional<CoagulationSite> site(int i) const override;
  bool add_dose(const StepContext& context, int i, double dose) override;
  double dose(int) const override { return dose_; }
  bool covers(const Vec3& point) const override { return bowl_.covers(volume_, point); }

  bool open() const { return open_; }
  double rate() const { return rate_; }                    ///< of blood out of the tear, m3/s; 0 while it flows back
  double volume() const { return volume_; }                ///< in the field, m3
  double height() const { return bowl_.height(volume_); }  ///< m

 private:
  void measure_forces(const ConstraintSolution& solution);
  void tear(const StepContext& context, const char* why, double value);
  /// Blood out of the tear, m3/s, for a flow `out` of any fluid. Negative: blood flows back from the pool.
  double blood_of(double h, double out);
  Vec3 tear_centre() const;
  void seal();
  void fill(double h, double blood);
  void tell(const StepContext& context);
  void emit(const StepContext& context, const EventKind& what, const char* text, double value) const;

  Bowl bowl_;
  int chamber_ = -1;
  std::vector<char> zone_;                          ///< one for each node
  std::vector<int> zone_nodes_;                     ///< nodes of the zone
  std::vector<std::array<int, 3>> zone_triangles_;  ///< of the wall, all corners in the zone
  double now_ = 0;                                  ///< simulated time at the end of the last step, s
  std::vector<Instrument*> instruments_;
  std::vector<Instrument*> suctions_;
  std::vector<double> row_force_;  ///< three for each row: force on the region
  // State.
  bool open_ = false, asked_ = false, stopped_ = false;
  double other_ = 0;  ///< fluid in the sac that is not blood: it entered while there was no pool above the tear, m3
  double rate_ = 0, lost_ = 0, sucked_rate_ = 0, volume_ = 0, since_ = -1, first_rate_ = 0, low_for_ = 0, force_ = 0,
         sharp_ = 0;
  double dose_ = 0;  ///< Arrhenius integral at the tear
};

}  // namespace insula
