// SPDX-License-Identifier: GPL-3.0-or-later
// Contracts of whole scenes, of supports, surfaces and exercise rules.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/testing/contracts.h"
#include "core/testing/example.h"

namespace insula::test {
namespace {

/// Kinetic, elastic, coupling energy and weight.
double total_energy(const Simulation& s) {
  double e = s.energy();
  for (const Body* b : s.bodies())
    if (auto* soft = dynamic_cast<const DeformableBody*>(b))
      for (int i = 0; i < soft->nodes(); ++i)
        e -= soft->node_mass()[std::size_t(i)] * s.scene().gravity().dot(soft->q().segment<3>(3 * i) - soft->rest_nodes()[std::size_t(i)]);
  return e;
}

}  // namespace

void check_example(const std::filesystem::path& scene) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  const int n = int(std::lround(script_length / s->h()));
  double most = 0, still = 0;
  for (int i = 0; i < n + 40; ++i) {
    run_script(*s, 1);
    ASSERT_TRUE(s->report().finite) << "step " << i;
    for (const Body* b : s->bodies())
      if (auto* soft = dynamic_cast<const DeformableBody*>(b)) {
        ASSERT_TRUE(soft->q().allFinite() && soft->v().allFinite()) << soft->id << " at step " << i;
        EXPECT_EQ(soft->indefinite_steps(), 0) << soft->id << ": indefinite matrix";
      }
    const double e = total_energy(*s);
    most = std::max(most, std::abs(e));
    if (i == n) still = e;  // the first step of hands at rest: nothing puts energy in any more
    if (i > n) { EXPECT_LE(e, still + 0.01 * most + 1e-15) << "energy grows while the hands are still, step " << i; }
  }
}

void check_deterministic(const std::filesystem::path& scene) {
  auto one = load(scene, 1), again = load(scene, 1), two = load(scene, 2);
  ASSERT_TRUE(one && again && two);
  const std::uint64_t start = one->state_hash();
  EXPECT_EQ(again->state_hash(), start);
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < 75; ++i) {
    run_script(*one, 1);
    run_script(*again, 1);
    run_script(*two, 1);
    hashes.push_back(one->state_hash());
    ASSERT_EQ(again->state_hash(), hashes.back()) << "a second run differs at step " << i;
    ASSERT_EQ(two->state_hash(), hashes.back()) << "two threads differ from one at step " << i;
  }
  one->reset();
  EXPECT_EQ(one->state_hash(), start) << "reset does not lead back to the start";
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    run_script(*one, 1);
    ASSERT_EQ(one->state_hash(), hashes[i]) << "the run after reset differs at step " << i;
  }
}

void check_support(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  int found = 0;
  for (Support* support : s->scene().all<Support>()) {
    if (support->element != element) continue;
    ++found;
    auto* body = dynamic_cast<DeformableBody*>(support->parent);
    ASSERT_TRUE(body);
    std::vector<char> fixed(std::size_t(body->nodes()), 0);
    Diagnostics diagnostics;
    PrepareContext context{diagnostics, s->h()};
    support->fix(context, body->rest_nodes(), fixed);
    EXPECT_TRUE(diagnostics.ok()) << diagnostics.format();
    int own = 0;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      own += fixed[i] != 0;
      if (fixed[i]) { EXPECT_TRUE(body->fixed()[i]) << "node " << i; }
    }
    EXPECT_GT(own, 0) << support->id << " holds nothing";
  }
  EXPECT_GT(found, 0) << "its example holds no <" << element << ">";
  run_script(*s, 40);
  for (const Body* b : s->bodies()) {
    auto* body = dynamic_cast<const DeformableBody*>(b);
    if (!body) continue;
    int moved = 0;
    for (int i = 0; i < body->nodes(); ++i) {
      const bool same = body->q().segment<3>(3 * i) == body->rest_nodes()[std::size_t(i)];
      if (body->fixed()[std::size_t(i)]) { EXPECT_TRUE(same && body->v().segment<3>(3 * i).isZero(0)) << "fixed node " << i << " moved"; }
      else moved += !same;
    }
    EXPECT_GT(moved, 0) << "nothing moves in the example, so it shows nothing";
  }
}

void check_surfaces(const std::filesystem::path& scene) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  for (Surface* surface : s->surfaces()) {
    SCOPED_TRACE(surface->id);
    ASSERT_EQ(surface->positions().size(), surface->rest().vertices.size());
    surface->update();
    for (std::size_t i = 0; i < surface->positions().size(); ++i)
      EXPECT_LT((surface->positions()[i] - surface->rest().vertices[i]).norm(), 1e-3) << "vertex " << i << " starts elsewhere";
    auto* body = dynamic_cast<DeformableBody*>(&surface->body());
    if (!body || (dynamic_cast<ShellBody*>(body) && !surface->mesh.empty())) continue;  // a picture beside the wall keeps its distance
    const VecX rest = body->q();
    const Quat turn = from_rotation_vector(Vec3(0.3, -1.1, 0.7));
    const Vec3 shift(0.01, 0.02, -0.03);
    const std::vector<Vec3> start = surface->positions();
    for (int i = 0; i < body->nodes(); ++i) body->q().segment<3>(3 * i) = turn * rest.segment<3>(3 * i) + shift;
    surface->update();
    for (std::size_t i = 0; i < start.size(); ++i)
      ASSERT_LT((surface->positions()[i] - (turn * start[i] + shift)).norm(), 1e-12) << "vertex " << i << " does not follow a rigid motion";
    // A row at a triangle's point is the derivative of that point; positions are linear in q, so the difference is exact.
    const VecX q = deformed(*body, 0.2, 3);
    for (std::size_t t = 0; t < surface->triangles().size(); t += 1 + surface->triangles().size() / 50) {
      const Vec3 bary(0.2, 0.5, 0.3), d(0.6, 0, 0.8);
      const auto along = [&] {
        surface->update();
        Vec3 x = Vec3::Zero();
        for (int k = 0; k < 3; ++k) x += bary[k] * surface->positions()[std::size_t(surface->triangles()[t][std::size_t(k)])];
        return d.dot(x);
      };
      body->q() = rest;
      const double at_rest = along();
      body->q() = q;
      const double moved = along();
      BodyRows rows;
      rows.clear();
      rows.open(0);
      surface->add_row(rows, int(t), bary, d);
      double predicted = 0;
      for (std::size_t e = 0; e < rows.block.size(); ++e)
        predicted += rows.coeff[e].dot(q.segment<3>(3 * rows.block[e]) - rest.segment<3>(3 * rows.block[e]));
      EXPECT_NEAR(moved - at_rest, predicted, 1e-13) << "triangle " << t;
    }
    // The step places all in one go, to the bits of each point by itself, and sees how far they went.
    body->q() = rest;
    s->step();
    surface->will_collide();
    surface->update_collision();
    const std::vector<Vec3> before = surface->positions();
    body->q() = q;
    body->v() = 7 * (q - rest);
    surface->update_collision();
    double farthest = 0, farthest_free = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const MaterialPoint& p = surface->points()[i];
      if (!body->can_move(p)) continue;
      ASSERT_TRUE(surface->positions()[i] == body->position(p) && surface->expected_displacements()[i] == body->expected_displacement(p)) << "vertex " << i;
      farthest = std::max(farthest, (surface->positions()[i] - before[i]).norm());
      farthest_free = std::max(farthest_free, surface->expected_displacements()[i].norm());
    }
    EXPECT_NEAR(surface->collision().moved(~std::uint64_t(0)), farthest, 1e-12);
    EXPECT_NEAR(surface->collision().farthest_free(), farthest_free, 1e-12);
    EXPECT_GT(farthest_free, 0);
    s->reset();  // the step moved the others too
    for (Surface* other : s->surfaces()) other->update();
  }
}

void check_exercise_rule(const std::filesystem::path& scene, const std::string& element) {
  std::ifstream in(scene);
  std::stringstream buffer;
  buffer << in.rdbuf();
  std::string text = buffer.str();
  const std::size_t from = text.find("<exercise");
  const std::size_t to = text.find("</exercise>");
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos) << "its example has no <exercise>";
  EXPECT_NE(text.find("<" + element, from), std::string::npos) << "its example holds no <" << element << ">";
  text.erase(from, to + 11 - from);
  auto with = load(scene), without = load_text(text, scene);
  ASSERT_TRUE(with && without);
  ASSERT_TRUE(with->exercise());
  ASSERT_FALSE(without->exercise());
  std::set<std::string> ids;
  for (const GoalState& g : with->exercise()->log().goals()) EXPECT_TRUE(!g.id.empty() && ids.insert(g.id).second) << "goal \"" << g.id << "\"";
  for (const FaultState& f : with->exercise()->log().faults()) EXPECT_TRUE(!f.id.empty() && ids.insert(f.id).second) << "fault \"" << f.id << "\"";
  for (int i = 0; i < 90; ++i) {
    run_script(*with, 1);
    run_script(*without, 1);
    // Document positions shift, so row ids do; the state must not.
    ASSERT_EQ(with->state_hash(), without->state_hash()) << "the exercise changes the state at step " << i;
  }
  with->reset();
  for (const GoalState& g : with->exercise()->log().goals()) EXPECT_FALSE(g.done) << g.id;
  for (const FaultState& f : with->exercise()->log().faults()) EXPECT_EQ(f.count, 0) << f.id;
}

}  // namespace insula::test
