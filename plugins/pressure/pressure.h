// SPDX-License-Identifier: GPL-3.0-or-later
// Blood pressure on the wall of a closed shell, chamber by chamber (equations in pressure.cpp).
#pragma once
#include <string>
#include <vector>

#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/shell_body.h"
#include "plugins/pressure/chambers.h"
#include "plugins/pressure/star_mesh.h"
#include "plugins/pressure/waveform.h"

namespace insula {

/// Source of the chambers' blood when the pressure is not prescribed: a network of vessels.
class ChamberFeed {
 public:
  virtual ~ChamberFeed() = default;
  /// Pressure of a chamber in the imaged shape, Pa.
  virtual double reference(int chamber) const = 0;
  /// The network of this step reduced to one node for each chamber; all other nodes are eliminated. May be called
  /// repeatedly.
  virtual void reduce(const StepContext& context, StarMesh& chambers) = 0;
  /// After the step: pressure at each chamber's node of the network (Pa), and the compliance of the chamber (m3/Pa).
  virtual void settle(const StepContext& context, const double* pressure, const double* yielding) = 0;
};

/// Something that makes the heart pause: it stands between the beat and the arteries.
class HeartPause {
 public:
  virtual ~HeartPause() = default;
  virtual bool beating() const = 0;  ///< in the coming step
  virtual bool acting() const = 0;   ///< the arteries have another pressure than that of the beat
  /// Pressure of the arteries after `h` of the coming step, from that of the beating heart, Pa.
  virtual double arterial(double h, double of_beat) const = 0;
  /// The step is over. of_beat: pressure of the beating heart at its end, Pa.
  virtual void advance(double h, double of_beat) = 0;
};

class BloodPressure final : public Constraint, public FollowerLoad, public StatesLaw {
 public:
  static constexpr std::string_view kind_name = "pressure";
  static constexpr int max_chambers = 8;

  Ref<ShellBody> on{this, {.name = "on", .doc = "closed shell whose wall the blood loads"}};
  Param<Pressure> systolic{this,
                           {.name = "systolic",
                            .fallback = "120 mmHg",
                            .min = "20 mmHg",
                            .max = "300 mmHg",
                            .doc = "greatest pressure of a beat"}};
  Param<Pressure> diastolic{this,
                            {.name = "diastolic",
                             .fallback = "80 mmHg",
                             .min = "10 mmHg",
                             .max = "200 mmHg",
                             .doc = "least pressure of a beat"}};
  Param<Frequency> heart_rate{
      this, {.name = "heart_rate", .fallback = "70 1/min", .min = "20 1/min", .max = "220 1/min", .doc = "beats"}};
  Param<Pressure> imaged_at{this,
                            {.name = "imaged_at",
                             .fallback = "0 mmHg",
                             .min = "0 mmHg",
                             .max = "300 mmHg",
                             .doc = "pressure at which the shape was imaged; 0: the mean of a beat"}};
  Param<bool> prestress{
      this,
      {.name = "prestress",
       .fallback = "true",
       .doc = "the wall balances the pressure of imaging in the imaged shape by a tension of its own, and is slack "
              "without pressure; false: its imaged shape is free of stress, and only what exceeds that pressure loads "
              "it (so it is, too, for a shell without a membrane)"}};
  Param<Duration> response{this,
                           {.name = "response",
                            .fallback = "1 s",
                            .min = "0 s",
                            .max = "60 s",
                            .doc = "time in which pressure and rate follow a command"}};
  Param<std::string> regions{this,
                             {.name = "chambers",
                              .fallback = "",
                              .doc = "regions of each chamber, chambers separated by semicolons: \"parent; superior; "
                                     "sac bleb\"; none: one a region with a centreline"}};

  Channel<Pressure> arterial_now{this,
                                 {.name = "arterial",
                                  .doc = "pressure of the arteries",
                                  .min = "0 mmHg",
                                  .max = "300 mmHg",
                                  .shown = Shown::vital,
                                  .display = "mmHg",
                                  .digits = 0}};
  Channel<Scalar> heart_phase{this,
                              {.name = "heart_phase",
                               .doc = "of the beat, 0 the start of systole",
                               .min = "0",
                               .max = "1",
                               .shown = Shown::none,
                               .role = Role::pulse}};
  ChannelGroup<Pressure> chamber_pressure{this,
                                          {.name = "pressure",
                                           .doc = "on the wall of a chamber",
                                           .min = "0 mmHg",
                                           .max = "300 mmHg",
                                           .shown = Shown::none,
                                           .display = "mmHg",
                                           .digits = 0}};
  ChannelGroup<Scalar> chamber_volume{this,
                                      {.name = "volume_share",
                                       .doc = "volume inside the wall of a chamber over that of the imaged shape",
                                       .min = "0",
                                       .shown = Shown::none,
                                       .display = "%",
                                       .digits = 0}};

  /// Creates the chambers if they do not exist yet. False if they have an error.
  bool ready(PrepareContext& context);
  /// Called before the first step with the network that feeds the chambers.
  void set_feed(ChamberFeed* feed);
  bool fed() const { return feed_ != nullptr; }
  /// Called before the first step. False if something else makes the heart pause already.
  bool set_pause(HeartPause* pause);
  bool beating() const { return !pause_ || pause_->beating(); }
  bool rests() const { return pause_ && pause_->acting(); }  ///< flow says nothing of the lumen meanwhile

  const Chambers& chambers() const { return chambers_; }
  double wave_mean() const {
    return diastolic() + (systolic() - diastolic()) * wave_.mean();
  }  ///< of a beat with the declared parameters, Pa
  double imaged_pressure() const { return imaged_at() > 0 ? imaged_at() : wave_mean(); }  ///< of the arteries, Pa
  double arterial(double h) const;         ///< pressure of the arteries at the end of the coming step, Pa
  double phase() const { return phase_; }  ///< of the heart, 0..1, 0 the start of systole
  /// Number of beats in a step; of a heart that rests, the number that it would make.
  double beat_share(double h) const { return h * rate_; }
  double pressure(int chamber) const { return pressure_[std::size_t(chamber)]; }   ///< on its wall in the last step, Pa
  double volume(int chamber) const { return chambers_.volume(chamber, on->q()); }  ///< now, m3
  double rest_volume(int chamber) const { return rest_volume_[std::size_t(chamber)]; }
  double fluid(int chamber) const {
    return fluid_[std::size_t(chamber)];
  }  ///< volume of blood according to the network, m3

  void prepare(PrepareContext& context) override;
  void connect(PrepareContext& context, Simulation& simulation) override;
  void detect(const StepContext& context) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override;
  void add_gradient(BlockMatrix& a, double scale) const override;
  std::vector<CommandInfo> commands() const override;
  std::string run_command(std::string_view name, std::string_view argument) override;

 private:
  double beat_pressure(double h) const;  ///< of the beating heart after h, Pa
  double step_beats(double h) const { return beating() ? h * rate_ : 0; }
  bool make_chambers(PrepareContext& context);
  bool read_groups(PrepareContext& context, std::vector<std::vector<std::string>>& groups) const;
  void add_row(ConstraintBuilder& builder, int k, Block block, double violation);
  void prestress_wall(PrepareContext* context);
  void fill();
  double reference(int chamber) const { return feed_ ? feed_->reference(chamber) : imaged_pressure(); }
  void prepare_feed(double h);
  void finish_feed(const StepContext& context, const ConstraintSolution& solution);

  Chambers chambers_;
  PulseWave wave_;
  ChamberFeed* feed_ = nullptr;
  HeartPause* pause_ = nullptr;
  bool connected_ = false, good_ = false, prestressed_ = false;
  double area_ = 1;
  std::vector<double> rest_volume_;
  std::vector<char> yields_;  ///< has a node that is not fixed

  // State.
  double phase_ = 0, systolic_now_ = 0, diastolic_now_ = 0, rate_ = 0;
  double systolic_wanted_ = 0, diastolic_wanted_ = 0, rate_wanted_ = 0;
  std::vector<double> pressure_, fluid_;
  std::vector<double> excess_;  ///< over the pressure that the wall does not count, of each chamber, Pa

  // Of this step.
  double h_ = 0;  ///< its length, s
  struct Row {
    int row = -1;
    double conductance = 0;  ///< conductance in its law, m3/(s Pa)
    double feed = 0;         ///< pressure above that of the last step at which there is no flow, Pa
  };
  std::vector<Row> rows_;
  StarMesh mesh_;
  std::vector<double> mix_;  ///< mix_[k n + j]: share of chamber j in row k
  std::vector<std::vector<Vec3>> gradient_;
  std::vector<Vec3> row_gradient_;
  std::vector<int> row_nodes_;
  std::vector<double> volume_, flow_, yielding_, at_node_;
};

}  // namespace insula
