// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of instruments: the virtual coupling and its terms for the haptic loop.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

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

void check_follows(Findings& findings, Simulation& s, Instrument& tool) {
  s.reset();
  const int hand = tool.hand_index();
  // Moves the tool away from all bodies along its shaft, waits until it rests, then moves it freely.
  Vec6 d;
  d << 0.2 * tool.shaft().normalized(), Vec3(0.1, -0.2, 0.05);
  const Pose away = displaced(tool.home_pose(), d);
  s.set_hand(hand, hand_at(away));
  for (int i = 0; i < 200; ++i) s.step();
  if (!findings.expect(displacement(away, tool.pose()).norm() < 1e-9, "it does not come to rest at the hand")) return;
  findings.expect(tool.hand_force().norm() < 1e-6, "the hand feels a force without a displacement");
  if (tool.mass() > 0) return;  // inertia causes a lag by intention
  Vec6 m;
  m << 0.001, -0.002, 0.0015, 0.02, 0.01, -0.03;
  const Pose next = displaced(away, m);
  s.set_hand(hand, hand_at(next));
  s.step();
  findings.expect(displacement(next, tool.free_pose()).norm() < 1e-12, "the free tool is not where the hand is");
  findings.expect(displacement(next, tool.pose()).norm() < 1e-12,
                  "the tool that touches nothing is not where the hand is");
}

// The gain of the haptic loop predicts the free tool for another device pose.
void check_terms(Findings& findings, const std::filesystem::path& scene, const std::string& id, int steps) {
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
  findings.at("after step " + std::to_string(steps));
  findings.expect(displacement(terms->device, tool->device()).norm() < 1e-12,
                  "the haptic terms have another device pose than the tool");
  findings.expect(displacement(terms->free, tool->free_pose()).norm() < 1e-12,
                  "the haptic terms have another free pose than the tool");
  findings.expect((terms->compliance - terms->compliance.transpose()).norm() < 1e-15 * terms->compliance.norm(),
                  "the tool's compliance is not symmetric");
  findings.expect(Eigen::SelfAdjointEigenSolver<Mat6>(terms->compliance).eigenvalues()[0] > 0,
                  "the tool's compliance is not positive");
  findings.expect((terms->stiffness - coupling_stiffness(*tool)).norm() < 1e-12 * terms->stiffness.norm(),
                  "the haptic terms have another stiffness than the coupling");
  findings.expect(terms->jacobian.rows() == a->problem().rows, "the tool's Jacobian has not the problem's rows");
  const Pose predicted = displaced(terms->free, terms->gain * displacement(terms->device, moved.device));
  // For rotations of 1e-4 rad, the second-order error is 1e-8.
  findings.expect(displacement(predicted, other->free_pose()).norm() < 1e-7 * (1 + terms->gain.norm()),
                  "the gain does not predict the free tool for another device pose");
  findings.at("");
}

}  // namespace

void check_instrument(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  int found = 0;
  Findings none("<" + element + ">");
  for (Instrument* tool : s->instruments()) {
    if (tool->element != element) continue;
    ++found;
    Findings findings("<" + element + "> " + tool->id);
    findings.expect(displacement(tool->home_pose(), tool->pose()).norm() < 1e-12, "it does not start at home");
    findings.expect(!tool->tool().pieces.empty(), "it has no pieces to touch with");
    s->reset();
    for (int i = 0; i < 70; ++i) {
      run_script(*s, 1);
      const Vec6 force = coupling_stiffness(*tool) * displacement(tool->device(), tool->pose());
      findings.expect((tool->hand_force() - force).norm() < 1e-12 * (1 + force.norm()),
                      "the hand's force is not stiffness times displacement");
      findings.expect(tool->activity() >= 0 && tool->activity() <= 1, "its activity is not within 0 and 1");
    }
    if (tool->hand_index() < 0) {  // held by an arm, so the hands' script does not move it
      findings.expect(displacement(tool->home_pose(), tool->device()).norm() < 1e-12,
                      "the hands carry away what an arm holds");
      continue;
    }
    check_follows(findings, *s, *tool);
    for (const int steps : {0, 20, 50}) check_terms(findings, scene, tool->id, steps);
  }
  none.expect(found > 0, "its example holds none of it");
}

}  // namespace insula::test
