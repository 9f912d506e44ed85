// SPDX-License-Identifier: GPL-3.0-or-later
// A hand-held tool: a rigid body tied to the device pose by a 6-DoF spring and damper (virtual coupling; Colgate,
// Stanley, Brown 1995). It has its own 6x6 system matrix. Instrument plugins add the function of their tip.
#pragma once
#include "core/mechanics/constraint.h"
#include "core/mechanics/rigid_body.h"

namespace insula {

/// State of a hand during a step.
struct HandState {
  bool present = false;
  Pose device;  ///< at the end of the step, scene frame
  bool button1 = false;
  bool button2 = false;
};

class Instrument : public RigidBody {
 public:
  static constexpr std::string_view kind_name = "instrument";

  Param<File> model{this, {.name = "model", .doc = "URDF of the tool"}};
  Param<Choice> hand{this,
                     {.name = "hand",
                      .choices = {"left", "right", "none"},
                      .doc = "hand that uses the tool; the first one of a hand is in it at the start, the others lie "
                             "on the tray; none: a table-mounted arm holds it"}};
  Param<Vec<Length>> home{this, {.name = "home", .doc = "tip at the start, scene frame"}};
  Param<Vec<Scalar>> shaft{
      this, {.name = "shaft", .doc = "direction from the tip along the shaft to the handle at the start"}};
  Param<Vec<Scalar>> flat{this,
                          {.name = "flat", .fallback = "0 0 1", .doc = "normal of the blade's flat side at the start"}};
  Param<Stiffness> coupling{this,
                            {.name = "coupling",
                             .fallback = "300 N/m",
                             .min = "10 N/m",
                             .max = "5000 N/m",
                             .doc = "translational stiffness of the virtual coupling"}};
  Param<AngularStiffness> angular_coupling{this,
                                           {.name = "angular_coupling",
                                            .fallback = "0.3 N m/rad",
                                            .min = "0.001 N m/rad",
                                            .max = "10 N m/rad",
                                            .doc = "rotational stiffness of the virtual coupling"}};
  Param<Duration> coupling_time{this,
                                {.name = "coupling_time",
                                 .fallback = "0 ms",
                                 .min = "0 ms",
                                 .max = "100 ms",
                                 .doc = "damping of the virtual coupling over its stiffness"}};
  Param<Mass> mass{this,
                   {.name = "mass",
                    .fallback = "0 g",
                    .min = "0 g",
                    .max = "1 kg",
                    .doc = "mass that the coupling moves; 0: the tool follows the hand without lag"}};

  Instrument() : RigidBody(2) {}  ///< degrees of freedom: translation, rotation
  void prepare(PrepareContext& context) override;
  /// Called once: whether the tool begins in its hand or on the tray.
  void start_in_hand(bool yes) { active_ = in_hand_at_start_ = yes; }
  int hand_index() const { return hand.is("right") ? 1 : hand.is("left") ? 0 : -1; }  ///< -1: held by an arm
  const ToolModel& tool() const override { return tool_; }
  const Pose& pose() const { return pose_; }      ///< tool pose at the start of the step
  const Pose& device() const { return device_; }  ///< device pose at the end of the step
  const Pose& free_pose() const { return free_pose_; }
  const HandState& state() const { return hand_state_; }
  Pose home_pose() const;
  void set_hand(const HandState& s) { hand_state_ = s; }
  /// Whether it is in its hand (or on its arm). False: it is on the tray and takes no part in the step.
  bool active() const override { return active_; }
  /// Tool exchange: takes it into the hand, which is at `device`, or lays it on the tray.
  virtual void take_up(const Pose& device);
  virtual void lay_down();
  /// Reason why the hand may not lay it down now; empty if it may.
  virtual std::string why_kept() const { return {}; }
  /// Moves the tool to a pose at once. Velocity and history stay (for tests and replays).
  void place(const Pose& pose, double = 0) override { pose_ = pose; }

  /// Coupling force and torque on the hand at the end of the step: stiffness * displacement(device, tool).
  const Vec6& hand_force() const { return hand_force_; }
  /// Fills the terms of the haptic problem. The Jacobian comes from the rows of the last step.
  void fill_terms(ToolTerms& terms, int problem_rows) const;

  /// Pose at which a table-mounted arm (hand="none") holds the tool at this time, s.
  virtual Pose arm_pose(double) const { return home_pose(); }

  /// Whether its cutting edges cut now. Default: whenever the tool has edges.
  virtual bool cutting() const { return !tool_.blade_edges.empty(); }
  /// Activity between 0 and 1 for drawing: suction on, blade at work.
  virtual double activity() const { return 0; }
  /// Called once, after all components are connected. Finds what its effect (suction, ...) acts on. Its rows are added
  /// in build().
  virtual void join(PrepareContext&, Simulation&) {}

  const std::vector<ConvexPiece>& link_pieces(int) const override { return tool_.pieces; }
  Pose link_pose(int) const override { return pose_; }
  Pose link_free_pose(int) const override { return free_pose_; }
  Vec3 position(const MaterialPoint& p) const override { return pose_.apply(p.local); }
  Vec3 free_displacement(const MaterialPoint& p) const override;
  void add_row(BodyRows& rows, const MaterialPoint& p, const Vec3& d) const override;
  void free_motion(const StepContext& context) override;
  void add_response(const BodyRows& rows, double* w, int stride, double* delta_free) override;
  void apply(const StepContext& context, const BodyRows& rows, const double* lambda) override;
  void reset() override;
  double energy() const override;
  void append_state(std::vector<double>& out) const override;
  MaterialPoint point(const Vec3& scene_position) const;  ///< point of the tool that is at that position now

 private:
  ToolModel tool_;
  HandState hand_state_;
  bool active_ = true, in_hand_at_start_ = true;
  Pose pose_, device_, last_device_, free_pose_;
  Vec6 velocity_ = Vec6::Zero(), free_dq_ = Vec6::Zero(), hand_force_ = Vec6::Zero();
  Mat6 compliance_ = Mat6::Zero(), gain_ = Mat6::Identity(), stiffness_ = Mat6::Zero();
  Mat6 inertia_ = Mat6::Zero();  ///< about the tip, in this step, kg and kg m2
};

}  // namespace insula
