// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

A rigid body on a spring, with a stop below. With d the displacement from its home pose (translation, rotation vector),
M its mass and its moment of inertia about the origin of the model, K the two stiffnesses, and w its weight:

    M a = w - K d - damping_time K d',      z of the origin >= lowest

A step is implicit: (M / h^2 + (1 + damping_time / h) K) dq = w + M v / h - K d. So A is diagonal.
*/
#include "core/base/input_error.h"
#include "core/constraint/stated_law.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/rigid_body.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class @Name@ final : public RigidBody, public StatesLaw {
 public:
  @Name@() : RigidBody(2) {}  ///< blocks of degrees of freedom: translation of the origin, rotation vector

  Param<File> model{this, {.name = "model", .doc = "URDF of the body, without joints; its mass is the body's"}};
  Param<Vec<Length>> home{this, {.name = "home", .doc = "origin of the model where the spring is without force"}};
  Param<Stiffness> spring{
      this, {.name = "spring", .fallback = "100 N/m", .min = "0.1 N/m", .max = "10 kN/m", .doc = "of translation"}};
  Param<AngularStiffness> angular_spring{this,
                                         {.name = "angular_spring",
                                          .fallback = "0.1 N m/rad",
                                          .min = "0.001 N m/rad",
                                          .max = "10 N m/rad",
                                          .doc = "of rotation"}};
  Param<Length> gyration{
      this, {.name = "gyration", .fallback = "10 mm", .min = "0.1 mm", .max = "1 m", .doc = "radius of gyration"}};
  Param<Duration> damping_time{this,
                               {.name = "damping_time",
                                .fallback = "50 ms",
                                .min = "0 ms",
                                .max = "10 s",
                                .doc = "damping of the spring over its stiffness"}};
  Param<Length> lowest{
      this, {.name = "lowest", .fallback = "-1 m", .min = "-1 m", .max = "1 m", .doc = "least z of the origin"}};

  // Once: read the files, and report what does not fit.
  void prepare(PrepareContext& context) override {
    try {
      tool_ = read_tool(model());
    } catch (const InputError& e) {
      return error(context, model, e.what());
    }
    if (!tool_.hinges.empty()) return error(context, model, "has joints, and this body has none");
    reset();
  }

  // For contact and the picture.
  const ToolModel& tool() const override { return tool_; }
  const std::vector<ConvexPiece>& link_pieces(int) const override { return tool_.pieces; }
  Pose link_pose(int) const override { return pose_; }
  Pose link_free_pose(int) const override { return free_pose_; }
  void place(const Pose& pose, double) override { pose_ = pose; }

  Vec3 position(const MaterialPoint& p) const override { return pose_.apply(p.local); }
  Vec3 free_displacement(const MaterialPoint& p) const override {
    return free_.head<3>() + free_.tail<3>().cross(pose_.q * p.local);
  }
  void add_row(BodyRows& out, const MaterialPoint& p, const Vec3& d) const override {
    out.add(0, d);
    out.add(1, (pose_.q * p.local).cross(d));
  }

  // Every step: A, and the motion without row forces.
  void free_motion(const StepContext& context) override {
    const double h = context.h;
    const Vec6 m = masses(), k = stiffnesses();
    gravity_ = context.gravity;
    Vec6 force = k.cwiseProduct(displacement(pose_, home_pose())) + m.cwiseProduct(velocity_) / h;
    force.head<3>() += tool_.mass * gravity_;
    compliance_ = (m / (h * h) + (1 + damping_time() / h) * k).cwiseInverse();
    free_ = compliance_.cwiseProduct(force);
    free_pose_ = displaced(pose_, free_);
  }

  // H A^-1 H^T of the rows that touch it, and H times the free motion.
  void begin_compliance(const BodyRows& r) override {
    jacobian_.assign(std::size_t(r.count()), Vec6::Zero());
    for (std::size_t i = 0; i < jacobian_.size(); ++i)
      for (int e = r.start[i]; e < r.start[i + 1]; ++e)
        jacobian_[i].segment<3>(3 * r.block[std::size_t(e)]) += r.coeff[std::size_t(e)];
  }
  void add_response(const BodyRows& r, double* w, int stride, double* delta_free) override {
    for (std::size_t i = 0; i < jacobian_.size(); ++i) {
      delta_free[r.row[i]] += jacobian_[i].dot(free_);
      for (std::size_t j = 0; j < jacobian_.size(); ++j)
        w[r.row[i] * stride + r.row[j]] += jacobian_[i].dot(compliance_.cwiseProduct(jacobian_[j]));
    }
  }

  // After the solve: the motion with the row forces.
  void apply(const StepContext& context, const BodyRows& r, const double* lambda) override {
    Vec6 pushed = Vec6::Zero();
    for (std::size_t i = 0; i < jacobian_.size(); ++i) pushed += lambda[r.row[i]] * jacobian_[i];
    const Pose before = pose_;
    pose_ = displaced(free_pose_, compliance_.cwiseProduct(pushed));
    velocity_ = displacement(before, pose_) / context.h;
  }
  void add_rate(const BodyRows& r, double* rate) const override {
    for (std::size_t i = 0; i < jacobian_.size(); ++i) rate[r.row[i]] += jacobian_[i].dot(velocity_);
  }

  // A row of its own: the stop.
  void build(const StepContext&, ConstraintBuilder& builder) override {
    Block block;
    block.id = row_id(*this, 0);
    block.role = BlockRole::stop;
    block.lower = 0;
    const int row = builder.add(block);
    builder.violation(row, pose_.p.z() - lowest());
    builder.point(row, link_point(0, Vec3::Zero()), Vec3::UnitZ());
  }
  // The law of the row as an energy, for the contract's test: the stop is rigid.
  StatedLaw law() const override { return StatedLaw::potential(pose_.p.z() < lowest() ? infinite : 0); }

  void reset() override {
    pose_ = free_pose_ = home_pose();
    velocity_.setZero();
    free_.setZero();
  }
  double energy() const override {
    const Vec6 d = displacement(pose_, home_pose());
    return 0.5 * velocity_.dot(masses().cwiseProduct(velocity_)) + 0.5 * d.dot(stiffnesses().cwiseProduct(d)) -
           tool_.mass * gravity_.dot(d.head<3>());
  }
  void append_state(std::vector<double>& out) const override {
    for (const double x : pose_.p) out.push_back(x);
    for (const double x : pose_.q.coeffs()) out.push_back(x);
    for (const double x : velocity_) out.push_back(x);
  }

 private:
  Pose home_pose() const { return {home(), Quat::Identity()}; }
  Vec6 masses() const {
    Vec6 m = Vec6::Constant(tool_.mass);
    m.tail<3>() *= gyration() * gyration();
    return m;
  }
  Vec6 stiffnesses() const {
    Vec6 k = Vec6::Constant(spring());
    k.tail<3>().setConstant(angular_spring());
    return k;
  }

  ToolModel tool_;
  Pose pose_, free_pose_;
  Vec6 velocity_ = Vec6::Zero(), free_ = Vec6::Zero();
  Vec6 compliance_ = Vec6::Zero();  ///< diagonal of A^-1
  Vec3 gravity_ = Vec3::Zero();
  std::vector<Vec6> jacobian_;  ///< a row of H each
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::body, "@doc@"); }
