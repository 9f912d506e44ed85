// SPDX-License-Identifier: GPL-3.0-or-later
// An aneurysm clip: a rigid body of three links, two of them jaws that a spring closes about one hinge. clip.cpp
// describes its behaviour and its scene element.
#pragma once
#include <algorithm>
#include <vector>

#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/rigid_body.h"
#include "plugins/clip/clip_data.h"
#include "plugins/clip/clip_state.h"

namespace insula {

class ClipApplier;

class Clip final : public RigidBody, public ClipSource, public StatesLaw {
 public:
  static constexpr std::string_view kind_name = "clip";

  Param<File> model{this, {.name = "model", .doc = "URDF of the clip; tool.json beside it says what its spring does"}};
  Param<Choice> start{this,
                      {.name = "start",
                       .fallback = "tray",
                       .choices = {"tray", "field"},
                       .doc = "where it is at the start, unless an applier is loaded with it: on the tray, or let go "
                              "in the field at home"}};
  Param<Vec<Length>> home{
      this,
      {.name = "home", .fallback = "0 0 0 mm", .doc = "tip of the blades at the start in the field, scene frame"}};
  Param<Vec<Scalar>> shaft{
      this,
      {.name = "shaft", .fallback = "0 0 1", .doc = "direction from the tip to the hinge at the start in the field"}};
  Param<Vec<Scalar>> flat{
      this,
      {.name = "flat", .fallback = "1 0 0", .doc = "direction in which the blades open at the start in the field"}};
  Param<Angle> start_opening{this,
                             {.name = "start_opening",
                              .fallback = "0 rad",
                              .min = "0 rad",
                              .max = "1 rad",
                              .doc = "angle of the jaws at the start in the field"}};
  Param<Force> closing_force{this,
                             {.name = "closing_force",
                              .fallback = "0 N",
                              .min = "0 N",
                              .max = "20 N",
                              .doc = "between the closed blades at their middle; 0: as the model says"}};
  Param<Stiffness> force_slope{
      this,
      {.name = "force_slope",
       .fallback = "0 N/m",
       .min = "0 N/m",
       .max = "10 kN/m",
       .doc = "rise of that force with the gap between the blades there; 0: as the model says"}};
  Param<Scalar> weakening{this,
                          {.name = "weakening",
                           .fallback = "0.22",
                           .min = "0",
                           .max = "0.9",
                           .doc = "part of the force lost in ten minutes of being held fully open"}};
  Param<Mass> added_mass{this,
                         {.name = "added_mass",
                          .fallback = "30 g",
                          .min = "0.01 g",
                          .max = "1 kg",
                          .doc = "mass that resists acceleration, larger than the true one for the solver's sake; "
                                 "weight is that of the model",
                          .formerly = "inertia"}};
  Param<Length> gyration{
      this,
      {.name = "gyration",
       .fallback = "20 mm",
       .min = "0 mm",
       .max = "100 mm",
       .doc = "radius at which that mass stands against being turned, in addition to the clip's own shape"}};
  Param<Duration> hinge_time{this,
                             {.name = "hinge_time",
                              .fallback = "30 ms",
                              .min = "0 ms",
                              .max = "1 s",
                              .doc = "damping of the hinge over the spring's stiffness"}};
  Param<Duration> closing_time{this,
                               {.name = "closing_time",
                                .fallback = "0.3 s",
                                .min = "0 s",
                                .max = "5 s",
                                .doc = "from fully open to shut at the fastest"}};
  Param<Rate> drag{this,
                   {.name = "drag",
                    .fallback = "2 1/s",
                    .min = "0 1/s",
                    .max = "1000 1/s",
                    .doc = "rate at which the fluid takes a loose clip's motion"}};

  Channel<Force> pressing{this, {.name = "force", .doc = "of the blades on what is between them", .min = "0 N"}};
  Channel<Angle> opening_now{this,
                             {.name = "opening",
                              .doc = "of each jaw from the closed position",
                              .min = "0 rad",
                              .shown = Shown::none,
                              .display = "deg",
                              .digits = 1}};
  Channel<Scalar> applied{this,
                          {.name = "applications",
                           .doc = "times it was released in the field",
                           .min = "0",
                           .shown = Shown::none,
                           .digits = 0}};
  Channel<Scalar> place_now{this,
                            {.name = "place",
                             .doc = "0 on the tray, 1 held by an applier, 2 free in the field",
                             .min = "0",
                             .max = "2",
                             .shown = Shown::none,
                             .digits = 0}};

  Clip() : RigidBody(3) {}  ///< degrees of freedom: translation, rotation, (opening, 0, 0)
  void prepare(PrepareContext& context) override;

  const ToolModel& tool() const override { return tool_; }
  const ClipData& data() const { return data_; }
  std::vector<BodyProperty> properties() const override;
  std::vector<std::string> tags() const override;
  const RigidBody* held_by() const override;
  double opening() const override { return opening_; }
  const Pose& pose() const { return pose_; }  ///< of its frame at the start of the step: origin at the tip
  Pose grip() const { return {pose_.apply(data_.grip.p), pose_.q * data_.grip.q}; }  ///< where an applier holds it
  double mass() const { return tool_.mass; }                                         ///< true one, kg
  double strength() const { return strength_; }  ///< force over the force of an unused clip
  double force() const { return force_; }  ///< of each blade on what is between them, at the middle of the blades, N
  double stop_force() const {
    return stop_force_;
  }  ///< force that keeps the jaws from closing further (of each other, or of an applier), at the same point, N
  bool touched() const { return touched_; }  ///< whether something other than its applier pushed it in the last step
  bool in_field() const { return !holder_ && in_field_; }  ///< released
  ClipApplier* holder() const { return holder_; }
  Vec3 momentum() const { return added_mass() * velocity_; }  ///< kg m/s
  const Vec3& spin() const { return spin_; }                  ///< angular momentum about the centre of mass, kg m2/s
  /// Moment of the spring that closes each jaw, N m.
  double torque(double opening) const;
  /// Force and moment about the centre of mass in the next steps, scene frame, N and N m (for tests).
  Vec6 external = Vec6::Zero();

  /// Called once with the applier that holds it at the start.
  void start_in(ClipApplier* applier);
  void load(ClipApplier& applier, const Pose& pose);  ///< from the tray into an applier
  void take(ClipApplier& applier) { holder_ = &applier; }
  void let_go();
  void to_tray();
  /// Moves it to a pose at once (for tests and replays).
  void place(const Pose& pose, double opening) override;

  bool active() const override;
  bool implant() const override { return true; }
  int links() const override { return 3; }
  const std::vector<ConvexPiece>& link_pieces(int link) const override { return pieces_[std::size_t(link)]; }
  Pose link_pose(int link) const override;
  Pose link_free_pose(int link) const override;
  Vec3 position(const MaterialPoint& p) const override { return pose_.p + arm(p); }
  Vec3 free_displacement(const MaterialPoint& p) const override;
  void add_row(BodyRows& rows, const MaterialPoint& p, const Vec3& d) const override;
  void free_motion(const StepContext& context) override;
  void begin_compliance(const BodyRows& rows) override;
  void add_response(const BodyRows& rows, double* w, int stride, double* delta_free) override;
  void apply(const StepContext& context, const BodyRows& rows, const double* lambda) override;
  void add_rate(const BodyRows& rows, double* rate) const override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void publish() override;
  ClipState clip_state() const override;
  void reset() override;
  double energy() const override;
  void append_state(std::vector<double>& out) const override;
  StatedLaw law() const override {  // of its stops: rigid
    return StatedLaw::potential(opening_ < min_opening() || opening_ > tool_.opening_max ? infinite : 0);
  }

 private:
  using Vec7 = Eigen::Matrix<double, 7, 1>;  ///< translation of the tip, rotation vector, opening
  using Mat7 = Eigen::Matrix<double, 7, 7>;
  Pose start_pose() const;
  void settle(const Pose& pose, double opening);
  Vec3 arm(const MaterialPoint& p) const {
    return pose_.q * turned_[std::size_t(p.link)].apply(p.local);
  }                                                                ///< from the tip
  double turning(int link, const Vec3& arm, const Vec3& d) const;  ///< d . d(point)/d(opening)
  double closing() const { return closing_force() > 0 ? closing_force() : data_.closing_force; }
  double slope() const { return force_slope() > 0 ? force_slope() : data_.force_slope; }
  double lever() const {
    return 2 * data_.reference;
  }                             ///< d(gap at the middle of the blades)/d(opening) when closed, m
  double held_opening() const;  ///< opening below which an applier does not let the jaws close; 0: none
  double min_opening() const {
    return std::max(held_opening(), soonest_);
  }  ///< opening below which the jaws cannot close in this step

  ToolModel tool_;
  ClipData data_;
  std::vector<std::vector<ConvexPiece>> pieces_;  ///< for each link
  std::vector<Pose> turned_;                      ///< for each link: tool frame to tool frame, at the present opening
  ClipApplier *holder_ = nullptr, *start_holder_ = nullptr;
  bool in_field_ = false, touched_ = false, held_open_ = false;
  int applications_ = 0;
  Pose pose_, free_pose_;
  double opening_ = 0, turn_rate_ = 0, last_change_ = 0;  ///< rad, rad/s, rad in the last step
  Vec3 velocity_ = Vec3::Zero(), spin_ = Vec3::Zero();    ///< of the centre of mass; angular momentum
  double strength_ = 1, force_ = 0, stop_force_ = 0, pushed_ = 0;
  // Of this step.
  Vec3 to_centre_ = Vec3::Zero();                              ///< from the tip to the centre of mass
  Vec3 free_shift_ = Vec3::Zero(), free_turn_ = Vec3::Zero();  ///< of the centre of mass
  double free_opening_ = 0;                                    ///< displacement, rad
  double soonest_ = 0;                                 ///< opening that the jaws would reach at the largest speed, rad
  Mat3 moments_ = Mat3::Zero(), give_ = Mat3::Zero();  ///< inertia; rotation over moment
  double give_shift_ = 0, give_opening_ = 0;
  Mat7 compliance_ = Mat7::Zero();
  std::vector<Vec7> jacobian_, answer_;
  Vec7 moving_ = Vec7::Zero();  ///< rate of the degrees of freedom
  int stop_row_ = -1, limit_row_ = -1;
};

}  // namespace insula
