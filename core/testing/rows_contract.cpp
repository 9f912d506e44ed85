// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of everything that adds rows: constraints and instruments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/random.h"
#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula::test {
namespace {

struct RowData {
  LawKind law = LawKind::box;
  int offset = 0;         ///< row within its block
  bool unilateral = false;
  double violation = 0;   ///< at the start of the step
  double swept = 0;         ///< of the block's place in the free motion, m
  std::vector<VecX> h;    ///< one piece a body, blocks() * 3 long
};
using RowMap = std::map<std::pair<std::uint64_t, int>, RowData>;

/// Builds the rows of one component at the bodies' present state, outside a step.
class RowBench {
 public:
  RowBench(Simulation& s, Component& c) : simulation_(s), component_(c), builder_(problem_, s.bodies()) {
    context_.h = s.h();
    context_.gravity = s.scene().gravity();
    context_.step = s.steps() + 1;
  }
  RowMap rows() {
    for (Surface* f : simulation_.surfaces()) {
      f->update();
      f->update_collision();
    }
    ++context_.step;  // what is refreshed once a step is refreshed now
    builder_.clear();
    if (auto* c = dynamic_cast<Constraint*>(&component_)) {
      c->detect(context_);
      c->build(context_, builder_);
    } else if (auto* b = dynamic_cast<Body*>(&component_)) {
      b->build(context_, builder_);
    }
    builder_.finish();
    RowMap out;
    std::vector<RowData*> by_row;
    for (const Block& b : problem_.blocks)
      for (int k = 0; k < b.rows(); ++k) {
        RowData& r = out[{b.id, k}];
        r.law = b.law;
        r.offset = k;
        r.unilateral = b.law != LawKind::box || b.lower == 0;
        for (const Body* body : simulation_.bodies()) r.h.push_back(VecX::Zero(3 * body->blocks()));
        by_row.push_back(&r);
      }
    for (std::size_t b = 0; b < simulation_.bodies().size(); ++b) {
      const BodyRows& rows = simulation_.bodies()[b]->rows;
      for (int i = 0; i < rows.count(); ++i)
        for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
          by_row[std::size_t(rows.row[std::size_t(i)])]->h[b].segment<3>(3 * rows.block[std::size_t(e)]) += rows.coeff[std::size_t(e)];
    }
    // What the builder has is the violation alone; H dq_free comes with the compliance.
    for (std::size_t r = 0; r < by_row.size(); ++r) {
      double motion = 0;
      for (std::size_t b = 0; b < simulation_.bodies().size(); ++b)
        if (by_row[r]->h[b].size() > 0) motion += by_row[r]->h[b].dot(expected_motion(*simulation_.bodies()[b]));
      by_row[r]->violation = problem_.delta_free[r];
      by_row[r]->swept = motion;
    }
    for (const Block& b : problem_.blocks) {
      double way2 = 0;
      for (int k = 0; k < b.rows(); ++k) way2 += by_row[std::size_t(b.row + k)]->swept * by_row[std::size_t(b.row + k)]->swept;
      for (int k = 0; k < b.rows(); ++k) by_row[std::size_t(b.row + k)]->swept = std::sqrt(way2);
    }
    blocks = problem_.blocks;
    return out;
  }
  std::vector<Block> blocks;

 private:
  static VecX expected_motion(Body& body) {
    VecX dq = VecX::Zero(3 * body.blocks());
    if (auto* soft = dynamic_cast<DeformableBody*>(&body)) {
      for (int i = 0; i < soft->nodes(); ++i) {
        MaterialPoint p;
        p.body = soft;
        p.count = 1;
        p.node[0] = i;
        p.weight[0] = 1;
        dq.segment<3>(3 * i) = soft->expected_displacement(p);
      }
    } else if (auto* tool = dynamic_cast<RigidBody*>(&body)) {
      // Translation from the tip; the rotation from two points a metre off.
      const Pose pose = tool->link_pose(0);
      const auto at = [&](const Vec3& offset) { return tool->free_displacement(tool->link_point(0, pose.q.conjugate() * offset)); };
      const Vec3 t = at(Vec3::Zero()), x = at(Vec3::UnitX()) - t, y = at(Vec3::UnitY()) - t;
      dq.head<6>() << t, Vec3(y.z(), -x.z(), x.y());
      if (tool->blocks() < 3) return dq;
      // The opening from a point of the first jaw, along the direction in which it turns.
      const MaterialPoint p = tool->link_point(1, Vec3::Zero());
      Vec3 turn;
      for (int k = 0; k < 3; ++k) {
        BodyRows rows;
        rows.clear();
        rows.open(0);
        tool->add_row(rows, p, Vec3::Unit(k));
        turn[k] = 0;
        for (std::size_t e = 0; e < rows.block.size(); ++e)
          if (rows.block[e] == 2) turn[k] += rows.coeff[e].x();
      }
      const Vec3 rigid = t + Vec3(dq.segment<3>(3)).cross(tool->position(p) - pose.p);
      dq[6] = turn.dot(tool->free_displacement(p) - rigid) / turn.squaredNorm();
    }
    return dq;
  }

  Simulation& simulation_;
  Component& component_;
  ConstraintProblem problem_;
  ConstraintBuilder builder_;
  StepContext context_;
};

/// Moves every body along dq, once.
void move(Simulation& s, const std::vector<VecX>& dq, double scale) {
  for (std::size_t b = 0; b < s.bodies().size(); ++b) {
    if (auto* soft = dynamic_cast<DeformableBody*>(s.bodies()[b])) soft->q() += scale * dq[b];
    else if (auto* tool = dynamic_cast<RigidBody*>(s.bodies()[b]))
      tool->place(displaced(tool->link_pose(0), scale * Vec6(dq[b].head<6>())), tool->opening() + (dq[b].size() > 6 ? scale * dq[b][6] : 0));
  }
}

struct Restore {
  Simulation& s;
  std::vector<VecX> q;
  std::vector<std::pair<Pose, double>> pose;  // with the opening
  explicit Restore(Simulation& sim) : s(sim) {
    for (Body* b : s.bodies()) {
      if (auto* soft = dynamic_cast<DeformableBody*>(b)) q.push_back(soft->q());
      else q.emplace_back();
      if (auto* tool = dynamic_cast<RigidBody*>(b)) pose.emplace_back(tool->link_pose(0), tool->opening());
      else pose.emplace_back();
    }
  }
  void operator()() const {
    for (std::size_t b = 0; b < s.bodies().size(); ++b) {
      if (auto* soft = dynamic_cast<DeformableBody*>(s.bodies()[b])) soft->q() = q[b];
      if (auto* tool = dynamic_cast<RigidBody*>(s.bodies()[b])) tool->place(pose[b].first, pose[b].second);
    }
  }
};

/// Returns how many rows had a violation to compare.
int check_derivatives(Simulation& s, Component& c, std::uint64_t seed) {
  RowBench bench(s, c);
  const Restore restore(s);
  const RowMap base = bench.rows();
  Random random(seed);
  std::set<std::pair<std::uint64_t, int>> compared;
  for (int trial = 0; trial < 6; ++trial) {
    std::vector<VecX> dq;
    for (const Body* b : s.bodies()) {
      VecX d(3 * b->blocks());
      const bool rigid = dynamic_cast<const RigidBody*>(b) != nullptr;
      for (int i = 0; i < d.size(); ++i) d[i] = random.uniform(-1, 1) * (rigid && i > 2 ? 20.0 : 1.0);  // rad per metre
      dq.push_back(d);
    }
    const double e = 1e-7;
    move(s, dq, e);
    const RowMap plus = bench.rows();
    restore();
    move(s, dq, -e);
    const RowMap minus = bench.rows();
    restore();
    for (const auto& [key, row] : base) {
      const auto p = plus.find(key), m = minus.find(key);
      if (p == plus.end() || m == minus.end()) continue;
      // A row on motion alone: its violation is zero wherever the bodies are (differences here are of 1e-7 m).
      if (std::max({std::abs(row.violation), std::abs(p->second.violation), std::abs(m->second.violation)}) < 1e-12) continue;
      if (row.law == LawKind::friction && row.offset > 0) continue;
      if (row.law == LawKind::patch) continue;  // what it remembers of its slip has the weights of the steps it is of
      double slope = 0, scale = 0;
      for (std::size_t b = 0; b < dq.size(); ++b)
        if (dq[b].size() > 0) {
          slope += row.h[b].dot(dq[b]);
          scale += row.h[b].cwiseAbs().dot(dq[b].cwiseAbs());
        }
      const double forward = (p->second.violation - row.violation) / e, backward = (row.violation - m->second.violation) / e;
      double found = 0.5 * (forward + backward);
      // A flat piece may lie on two places at once: their least distance has a kink there, and any slope between the two
      // one-sided ones is its derivative.
      if (row.unilateral) found = std::clamp(slope, std::min(forward, backward), std::max(forward, backward));
      // The normal of a contact is fixed over a step; where it is no direction of least distance (an edge, a corner) an
      // open gap turns with it; so does the way to a contact that was found along the free motion.
      const double turning = row.unilateral ? 50 * (std::abs(row.violation) + row.swept) : 0.0;
      EXPECT_TRUE(held("row = derivative of its violation", std::max(0.0, std::abs(found - slope) - turning * scale), scale, 1e-5)) << "violation " << row.violation << " m, row id " << key.first << " + " << key.second;
      compared.insert(key);
    }
  }
  bench.rows();
  return int(compared.size());
}

/// Unit lambda on a row: forces and moments on all bodies. Only where every body it joins can move.
void check_balance(Simulation& s, Component& c) {
  RowBench bench(s, c);
  for (const auto& [key, row] : bench.rows()) {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0, arm = 0;
    int bodies = 0;
    for (std::size_t b = 0; b < s.bodies().size(); ++b) {
      if (row.h[b].size() == 0 || row.h[b].isZero(0)) continue;
      ++bodies;
      if (auto* soft = dynamic_cast<DeformableBody*>(s.bodies()[b])) {
        for (int i = 0; i < soft->nodes(); ++i) {
          const Vec3 f = row.h[b].segment<3>(3 * i), x = soft->q().segment<3>(3 * i);
          force += f;
          moment += x.cross(f);
          size += f.norm();
          if (!f.isZero(0)) arm = std::max(arm, x.norm());
        }
      } else {
        const auto* tool = dynamic_cast<RigidBody*>(s.bodies()[b]);
        ASSERT_TRUE(tool);
        const Vec3 f = row.h[b].head<3>(), m = row.h[b].segment<3>(3), at = tool->link_pose(0).p;
        force += f;
        moment += at.cross(f) + m;
        size += std::max(f.norm(), m.norm());
        arm = std::max(arm, at.norm());
      }
    }
    if (bodies < 2) continue;  // pushes against something that never moves
    EXPECT_TRUE(held("action = reaction", force.norm(), size, 1e-12)) << "row id " << key.first << " + " << key.second;
    // A contact acts on two points: an open gap between two surfaces has an arm of that length.
    const double open = row.unilateral ? std::abs(row.violation) + 5e-4 : 0.0;
    EXPECT_LT(moment.norm(), size * (1e-12 * arm + open)) << "action and reaction turn the whole, row id " << key.first << " + " << key.second;
  }
}

void check_laws(const Simulation& s) {
  const ConstraintProblem& p = s.problem();
  for (const Block& b : p.blocks) {
    const double* l = p.lambda.data() + b.row;
    if (b.law == LawKind::box) {
      EXPECT_GE(l[0], b.lower);
      EXPECT_LE(l[0], b.upper);
      EXPECT_GE(b.compliance, 0);
      EXPECT_LE(b.lower, b.upper);
    } else if (b.law == LawKind::patch) {
      double pressed = 0;
      for (int i = 1; i <= b.normals; ++i) pressed += l[-i];
      EXPECT_LE(std::hypot(l[0], l[1]), b.friction * pressed * (1 + 1e-9) + 1e-15);
    } else {
      EXPECT_GE(l[0], 0);
      EXPECT_LE(std::hypot(l[1], l[2]), b.friction * l[0] * (1 + 1e-9) + 1e-15);
    }
    EXPECT_TRUE(std::isfinite(l[0]));
  }
}

std::set<std::uint64_t> ids_of(const Simulation& s, const Component& c) {
  std::set<std::uint64_t> ids;
  for (const Block& b : s.problem().blocks)
    if (b.owner == c.order) ids.insert(b.id);
  return ids;
}

}  // namespace

void check_rows(const std::filesystem::path& scene, const std::string& element, bool rows_expected) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  std::vector<Component*> mine;
  for (Component* c : s->scene().components())
    if (c->element == element) mine.push_back(c);
  ASSERT_FALSE(mine.empty()) << "its example holds no <" << element << ">";
  int seen = 0, compared = 0;
  const int n = int(std::lround(script_length / s->h()));
  for (int i = 0; i < n + 60; ++i) {
    drive(*s);
    s->step();
    std::set<std::uint64_t> ids;
    for (const Block& b : s->problem().blocks) ASSERT_TRUE(ids.insert(b.id).second) << "row id " << b.id << " stands twice at step " << i;
    check_laws(*s);
    for (Component* c : mine) {
      const auto own = ids_of(*s, *c);
      seen += int(own.size());
      if (i % 10 == 5 && !own.empty() && i < n) {
        SCOPED_TRACE(c->id + " after step " + std::to_string(i));
        check_balance(*s, *c);
        compared += check_derivatives(*s, *c, std::uint64_t(i) + 1);
      }
    }
  }
  // At rest the ids stay.
  for (Component* c : mine) {
    const auto before = ids_of(*s, *c);
    run_script(*s, 1);
    const auto after = ids_of(*s, *c);
    int kept = 0;
    for (std::uint64_t id : before) kept += int(after.count(id));
    EXPECT_GE(kept, int(0.9 * double(before.size()))) << c->id << ": row ids change although nothing moves";
  }
  // A constraint that says it adds none keeps to that.
  bool any = false;
  for (Component* c : mine) {
    const auto* constraint = dynamic_cast<const Constraint*>(c);
    any = any || !constraint || constraint->adds_rows();
    if (constraint && !constraint->adds_rows()) {
      EXPECT_TRUE(ids_of(*s, *c).empty()) << c->id << " adds rows, but says it does not";
    }
  }
  if (!any) { EXPECT_EQ(seen, 0) << "rows of a constraint that says it adds none"; }
  if (rows_expected && any) {
    EXPECT_GT(seen, 0) << "the example never shows a row of it, so it shows nothing";
    EXPECT_GT(compared, 0) << "no row had a violation to compare with its derivative";
  }
}

}  // namespace insula::test
