// SPDX-License-Identifier: GPL-3.0-or-later
// A contact that the program does not know gets the same frame prediction and cost estimate as the one it ships with.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/haptics/contact_frame_prediction.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/instrument.h"
#include "core/registry/registry.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "tools/workbench/cost_model.h"

namespace insula {
namespace {

constexpr double roller = 0.03;  // m

/// The tip of a tool on a cylinder along y, whose top is at the origin.
class RollerContact final : public Constraint {
 public:
  Ref<Body> tool{this, {.name = "tool", .doc = "what touches"}};

  void build(const StepContext&, ConstraintBuilder& builder) override {
    const MaterialPoint tip = point();
    start_ = tool->position(tip);
    Block block;
    block.id = row_id(*this, 0);
    block.role = BlockRole::contact;
    block.law = LawKind::friction;
    block.friction = 0.1;
    row_ = builder.add(block);
    builder.violation(row_, (start_ - centre()).norm() - roller);
    const Vec3 n = normal(start_);
    builder.point(row_, tip, n);
    builder.point(row_ + 1, tip, Vec3::UnitY());
    builder.point(row_ + 2, tip, n.cross(Vec3::UnitY()));
  }
  void finish(const StepContext&, const ConstraintSolution& solution) override { pressed_ = solution.lambda[row_] > 0; }
  void predict_frames(double steps, std::vector<ContactFrame>& out) const override {
    if (!pressed_) return;
    const Vec3 now = tool->position(point()), moved = now - start_;
    out.push_back({row_ + wrong_row, normal(start_), Vec3::UnitY(), normal(now + steps * moved),
                   normal(now + (steps + 1) * moved)});
  }
  void estimate_cost(CostCounts& out) const override {
    out.tool_pieces += 2;
    out.rows.push_back({dynamic_cast<const RigidBody*>(tool.get()), tool.get(), 3, 6});
  }
  static Vec3 normal(const Vec3& x) { return Vec3(x.x(), 0, x.z() + roller).normalized(); }
  int row() const { return row_; }
  int wrong_row = 0;

 private:
  Vec3 centre() const { return {0, start_.y(), -roller}; }
  MaterialPoint point() const { return dynamic_cast<const RigidBody&>(*tool).link_point(0, Vec3::Zero()); }
  Vec3 start_ = Vec3::Zero();
  int row_ = 0;
  bool pressed_ = false;
};

class ForeignContact : public ::testing::Test {
 protected:
  void SetUp() override {
    register_builtin(registry_);
    registry_.add<RollerContact>("roller_contact", Kind::constraint, "a tip on a roller");
    folder_.write("meshes/tool/tool.urdf", test::test_tool_urdf(1e-3));
    auto result = load_simulation_text(R"(<scene title="roller">
<retractor id="tool" model="meshes/tool/tool.urdf" hand="right" home="0 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
<roller_contact id="roller" tool="tool"/></scene>)",
                                       folder_.path() / "scene.xml", registry_, 1);
    ASSERT_TRUE(result.diagnostics.all().empty()) << result.diagnostics.format();
    s_ = std::move(result.simulation);
    contact_ = s_->scene().find_as<RollerContact>("roller");
    tool_ = s_->instrument_of(1);
  }
  /// Rolls the tool over the top, pressed in by a tenth of a millimetre, 4 degrees a step.
  void roll(int steps) {
    for (int k = 0; k < steps; ++k) {
      const double angle = 0.07 * k - 0.2;
      HandState hand;
      hand.present = true;
      hand.device = tool_->home_pose();
      hand.device.p = (roller - 1e-4) * Vec3(std::sin(angle), 0, std::cos(angle)) - Vec3(0, 0, roller);
      s_->set_hand(1, hand);
      s_->step();
    }
  }
  Registry registry_;
  test::SceneFolder folder_;
  std::unique_ptr<Simulation> s_;
  RollerContact* contact_ = nullptr;
  Instrument* tool_ = nullptr;
};

TEST_F(ForeignContact, ItsRowsSayWhoseTheyAre) {
  roll(3);
  ASSERT_EQ(s_->problem().blocks.size(), 1u);
  EXPECT_EQ(s_->problem().blocks[0].owner, contact_->order);
  EXPECT_EQ(s_->problem().blocks[0].role, BlockRole::contact);
}

TEST_F(ForeignContact, ItsFramesArePredicted) {
  roll(8);
  const double ahead = 0.4;
  std::vector<ContactFrame> frames;
  contact_->predict_frames(ahead, frames);
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_GT(frames[0].normal.cross(frames[0].ahead).norm(), 0.02) << "nothing turns";
  ContactFramePrediction predict;
  const ConstraintProblem& p = predict(*s_, s_->problem(), ahead * s_->h());
  ASSERT_NE(&p, &s_->problem());
  EXPECT_DOUBLE_EQ(p.prediction_horizon_steps, ahead);
  ASSERT_EQ(p.tools.size(), 1u);
  const Vec3 direction = p.tools[0].jacobian.row(contact_->row()).head<3>().transpose();
  EXPECT_LT((direction - frames[0].ahead).norm(), 1e-12);
  const auto& rotation = p.blocks[0].frame_rotation;
  const Vec3 by{double(rotation[0]), double(rotation[1]), double(rotation[2])};
  EXPECT_LT((from_rotation_vector(by) * frames[0].ahead - frames[0].later).norm(), 1e-6);
}

TEST_F(ForeignContact, FramesOfNoBlockOfItsAreLeftOut) {
  roll(8);
  ContactFramePrediction predict;
  for (const int wrong : {1, 2, 3, 1000, -1}) {
    contact_->wrong_row = wrong;
    EXPECT_EQ(&predict(*s_, s_->problem(), 0.005), &s_->problem());
  }
}

TEST_F(ForeignContact, ItsCostIsEstimated) {
  roll(3);
  const SceneWork w = count_work(*s_);
  EXPECT_EQ(w.standing_rows, 3);
  EXPECT_EQ(w.expected_rows, 3 + 3);
  EXPECT_EQ(w.max_rows, 3 + 6);
  EXPECT_EQ(w.tool_pieces, 2);
}

}  // namespace
}  // namespace insula
