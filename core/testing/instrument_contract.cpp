// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of instruments: the virtual coupling and its terms for the haptic loop.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/testing/contracts.h"
#include "core/testing/example.h"

namespace insula::test {
namespace {

Mat6 coupling_stiffness(const Instrument& tool) {
  Vec6 d;
  d << Vec3::Constant(tool.coupling()), Vec3::Constant(tool.angular_coupling());
  return d.asDiagonal();
}

HandState hand_at(const Pose& pose) {
  HandState s;
  s.present = true;
  s.device = pose;
  return s;
}

void check_follows(Simulation& s, Instrument& tool) {
  s.reset();
  const int hand = tool.hand_index();
  // Out of reach of everything: away along the shaft, held there until it rests, then a free move.
  Vec6 d;
  d << 0.2 * tool.shaft().normalized(), Vec3(0.1, -0.2, 0.05);
  const Pose away = displaced(tool.home_pose(), d);
  s.set_hand(hand, hand_at(away));
  for (int i = 0; i < 200; ++i) s.step();
  ASSERT_LT(displacement(away, tool.pose()).norm(), 1e-9) << tool.id << " does not come to rest at the hand";
  EXPECT_LT(tool.hand_force().norm(), 1e-6) << tool.id << ": a force without a displacement";
  if (tool.mass() > 0) return;  // inertia lags by intention
  Vec6 m;
  m << 0.001, -0.002, 0.0015, 0.02, 0.01, -0.03;
  const Pose next = displaced(away, m);
  s.set_hand(hand, hand_at(next));
  s.step();
  EXPECT_LT(displacement(next, tool.free_pose()).norm(), 1e-12) << tool.id << ": the free tool is not where the hand is";
  EXPECT_LT(displacement(next, tool.pose()).norm(), 1e-12) << tool.id;
}

// The gain of the haptic loop says where the free tool goes for another device pose.
void check_terms(const std::filesystem::path& scene, const std::string& id, int steps) {
  auto a = load(scene), b = load(scene);
  ASSERT_TRUE(a && b);
  auto* tool = a->scene().find_as<Instrument>(id);
  auto* other = b->scene().find_as<Instrument>(id);
  ASSERT_TRUE(tool && other);
  run_script(*a, steps);
  run_script(*b, steps);
  drive(*a);
  drive(*b);
  a->step();
  Vec6 d;
  d << 2e-5, -1e-5, 3e-5, 1e-4, 2e-4, -1e-4;
  HandState moved = other->state();
  moved.device = displaced(moved.device, d);
  b->set_hand(other->hand_index(), moved);
  b->step();
  const ToolTerms* terms = nullptr;
  for (const ToolTerms& t : a->problem().tools)
    if (t.hand == tool->hand_index()) terms = &t;
  ASSERT_TRUE(terms);
  EXPECT_LT(displacement(terms->device, tool->device()).norm(), 1e-12);
  EXPECT_LT(displacement(terms->free, tool->free_pose()).norm(), 1e-12);
  EXPECT_LT((terms->compliance - terms->compliance.transpose()).norm(), 1e-15 * terms->compliance.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat6>(terms->compliance).eigenvalues()[0], 0);
  EXPECT_LT((terms->stiffness - coupling_stiffness(*tool)).norm(), 1e-12 * terms->stiffness.norm());
  EXPECT_EQ(terms->jacobian.rows(), a->problem().rows);
  const Pose predicted = displaced(terms->free, terms->gain * displacement(terms->device, moved.device));
  // Rotations of 1e-4 rad: second order is 1e-8.
  EXPECT_LT(displacement(predicted, other->free_pose()).norm(), 1e-7 * (1 + terms->gain.norm())) << id << ": the gain does not predict the free tool";
}

}  // namespace

void check_instrument(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  int found = 0;
  for (Instrument* tool : s->instruments()) {
    if (tool->element != element) continue;
    ++found;
    EXPECT_LT(displacement(tool->home_pose(), tool->pose()).norm(), 1e-12);
    EXPECT_FALSE(tool->tool().pieces.empty()) << "nothing to touch with";
    s->reset();
    for (int i = 0; i < 70; ++i) {
      run_script(*s, 1);
      const Vec6 force = coupling_stiffness(*tool) * displacement(tool->device(), tool->pose());
      EXPECT_LT((tool->hand_force() - force).norm(), 1e-12 * (1 + force.norm())) << "step " << i;
      EXPECT_GE(tool->activity(), 0);
      EXPECT_LE(tool->activity(), 1);
    }
    if (tool->hand_index() < 0) {  // an arm holds it: the hands' script must not carry it away
      EXPECT_LT(displacement(tool->home_pose(), tool->device()).norm(), 1e-12);
      continue;
    }
    check_follows(*s, *tool);
    check_terms(scene, tool->id, 0);
    check_terms(scene, tool->id, 20);
    check_terms(scene, tool->id, 50);
  }
  EXPECT_GT(found, 0) << "its example holds no <" << element << ">";
}

}  // namespace insula::test
