// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of everything that adds rows: constraints, instruments and rigid bodies.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/base/random.h"
#include "core/constraint/stated_law.h"
#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"
#include "core/testing/law_contract.h"
#include "core/testing/row_bench.h"

namespace insula::test {
namespace {

// A contact's normal is fixed over a step. If it is not a direction of least distance (at an edge or a corner), an open
// gap rotates with it. So does the displacement to a contact that was found in the free motion. The error is at most
// the gap over this radius of curvature ...
constexpr double min_radius = 0.02;  // m
// ... and a row is compared if that is at most this share.
constexpr double max_turning = 0.02;
// A tool's piece whose gap is closed still touches at this distance from its core
// (core/collision/shapes/rounded_piece.cpp).
constexpr double rounding = 2e-4;  // m

struct Compared {
  std::set<RowKey> rows;    ///< rows with a violation to compare
  bool unilateral = false;  ///< there were such rows ...
  bool tight = false;       ///< ... and one of them was compared at a small gap
};

class Derivatives {
 public:
  Derivatives(Findings& f, Simulation& s, Component& c, std::uint64_t seed)
      : findings_(f), s_(s), c_(c), bench_(s, c), random_(seed) {}

  /// Checks the present positions, then each of a few open gaps after it is closed.
  void check(Compared& compared) {
    const Restore restore(s_);
    const RowMap base = bench_.rows();
    at(base, compared, 6, 0);
    int closed = 0;
    for (const auto& [key, row] : base) {
      if (closed == 3) break;
      if (!row.positional() || !is_unilateral(c_, row) || turning(row) <= max_turning) continue;
      if (const auto tight = close(key, row)) {
        ++closed;
        at(*tight, compared, 2, rounding);
      }
      restore();
    }
    bench_.rows();
  }

 private:
  static double turning(const RowData& row) { return (std::abs(row.violation) + row.swept) / min_radius; }

  /// Reduces the gap to a hundredth of a millimetre by repeated motion of one whole body along the row. Returns nothing
  /// if no body can be moved in this manner, or if the row vanishes.
  std::optional<RowMap> close(const RowKey& key, const RowData& row) {
    double gap = row.violation;
    RowMap now = {{key, row}};
    for (int i = 0; i < 20 && std::abs(gap) > 1.5e-5; ++i) {
      const std::optional<std::vector<VecX>> dq = whole_body(now.at(key));
      if (!dq) return {};
      move(s_, *dq, 1e-5 - gap);
      now = bench_.rows();
      if (!now.contains(key)) return {};
      const double left = now.at(key).violation;
      if (!findings_.expect(std::abs(left) < 1.2 * std::abs(gap) + 1e-4,
                            "a gap opens when a body moves along its row to close it: the row is not its derivative",
                            fmt::format("{}, then {:.4g} mm", name_of(key, row), 1e3 * left)))
        return {};
      gap = left;
    }
    if (std::abs(gap) > 1.5e-5) return {};
    return now;
  }

  /// Translation of a whole deformable body along the row, such that the violation grows at the same rate.
  std::optional<std::vector<VecX>> whole_body(const RowData& row) const {
    for (std::size_t b = 0; b < s_.bodies().size(); ++b) {
      if (!dynamic_cast<DeformableBody*>(s_.bodies()[b])) continue;
      Vec3 net = Vec3::Zero();
      for (int i = 0; i < row.h[b].size() / 3; ++i) net += row.h[b].segment<3>(3 * i);
      if (net.norm() < 0.1) continue;
      std::vector<VecX> dq = no_motion(s_);
      for (int i = 0; i < dq[b].size() / 3; ++i) dq[b].segment<3>(3 * i) = net / net.squaredNorm();
      return dq;
    }
    return {};
  }

  /// arm: distance of the contact point from that of the body, m, in addition to an open gap.
  void at(const RowMap& base, Compared& compared, int trials, double arm) {
    arm_ = arm;
    const Restore restore(s_);
    for (int trial = 0; trial < trials; ++trial) {
      const std::vector<VecX> dq = any_motion();
      const double e = 1e-7;
      move(s_, dq, e);
      const RowMap plus = bench_.rows();
      restore();
      move(s_, dq, -e);
      const RowMap minus = bench_.rows();
      restore();
      for (const auto& [key, row] : base) {
        const auto p = plus.find(key), m = minus.find(key);
        if (p == plus.end() || m == minus.end() || !row.positional()) continue;
        // A row that depends only on motion: its violation is zero at all positions (differences here are 1e-7 m).
        if (std::max({std::abs(row.violation), std::abs(p->second.violation), std::abs(m->second.violation)}) < 1e-12)
          continue;
        compare(key, row, dq, (p->second.violation - row.violation) / e, (row.violation - m->second.violation) / e,
                compared);
      }
    }
  }

  std::vector<VecX> any_motion() {
    std::vector<VecX> dq = no_motion(s_);
    for (std::size_t b = 0; b < dq.size(); ++b) {
      const bool rigid = dynamic_cast<const RigidBody*>(s_.bodies()[b]) != nullptr;
      for (int i = 0; i < dq[b].size(); ++i)
        dq[b][i] = random_.uniform(-1, 1) * (rigid && i > 2 ? 20.0 : 1.0);  // rad per metre
    }
    return dq;
  }

  void compare(const RowKey& key, const RowData& row, const std::vector<VecX>& dq, double forward, double backward,
               Compared& compared) {
    const bool unilateral = is_unilateral(c_, row);
    compared.unilateral = compared.unilateral || unilateral;
    if (unilateral && turning(row) > max_turning) return;
    double slope = 0, scale = 0;
    for (std::size_t b = 0; b < dq.size(); ++b)
      if (dq[b].size() > 0) {
        slope += row.h[b].dot(dq[b]);
        scale += row.h[b].cwiseAbs().dot(dq[b].cwiseAbs());
      }
    double found = 0.5 * (forward + backward);
    // A flat piece may rest on two points at once. The smallest distance then has a kink, and any slope between the two
    // one-sided ones is valid.
    if (unilateral) found = std::clamp(slope, std::min(forward, backward), std::max(forward, backward));
    const double turned = unilateral ? (turning(row) + arm_ / min_radius) * scale : 0.0;
    findings_.within("row = derivative of its violation", std::max(0.0, std::abs(found - slope) - turned), scale, 1e-5,
                     name_of(key, row) + fmt::format(", moves by {:.4g} where its row says {:.4g}", found, slope));
    compared.rows.insert(key);
    compared.tight = compared.tight || unilateral;
  }

  Findings& findings_;
  Simulation& s_;
  Component& c_;
  RowBench bench_;
  Random random_;
  double arm_ = 0;
};

/// Effect of a unit lambda of a row on all bodies together.
struct Together {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0, arm = 0;
  int bodies = 0;

  void add(const Vec3& f, const Vec3& m, const Vec3& x) {
    force += f;
    moment += x.cross(f) + m;
    size += std::max(f.norm(), m.norm());
    if (!f.isZero(0) || !m.isZero(0)) arm = std::max(arm, x.norm());
  }
  void add(Body* body, const VecX& h) {
    if (h.size() == 0 || h.isZero(0)) return;
    ++bodies;
    if (auto* soft = dynamic_cast<DeformableBody*>(body))
      for (int i = 0; i < soft->nodes(); ++i) add(h.segment<3>(3 * i), Vec3::Zero(), soft->q().segment<3>(3 * i));
    else add(h.head<3>(), h.segment<3>(3), dynamic_cast<RigidBody&>(*body).link_pose(0).p);
  }
};

/// Only if every body of a row can move.
void check_balance(Findings& findings, Simulation& s, Component& c) {
  RowBench bench(s, c);
  for (const auto& [key, row] : bench.rows()) {
    Together sum;
    for (std::size_t b = 0; b < s.bodies().size(); ++b) sum.add(s.bodies()[b], row.h[b]);
    if (sum.bodies < 2) continue;  // pushes against something that never moves
    findings.within("action = reaction", sum.force.norm(), sum.size, 1e-12, name_of(key, row));
    // A contact acts on two points, so an open gap between two surfaces is an arm of that length.
    const double open = is_unilateral(c, row) ? std::abs(row.violation) + 5e-4 : 0.0;
    const double allowed = sum.size * (1e-12 * sum.arm + open);
    findings.expect(sum.moment.norm() < allowed, "action and reaction turn the whole: they must act along one line",
                    fmt::format("{}, moment {:.3g} m a newton", name_of(key, row), sum.moment.norm()));
  }
}

/// Numbers, bounds, and lambda within its law.
bool check_block(Findings& findings, const ConstraintProblem& p, const Block& b) {
  const double* l = p.lambda.data() + b.row;
  bool finite =
      std::isfinite(b.compliance) && std::isfinite(b.friction) && !std::isnan(b.lower) && !std::isnan(b.upper);
  for (int k = 0; k < b.rows(); ++k) finite = finite && std::isfinite(p.delta_free[std::size_t(b.row + k)]);
  if (!findings.expect(finite,
                       "a row is not made of finite numbers: violation, direction, compliance and friction must be"))
    return false;
  findings.expect(b.compliance >= 0, "compliance of a row is negative, expected 0 or more",
                  fmt::format("{:.3g} m/N", b.compliance));
  findings.expect(b.friction >= 0, "friction coefficient is negative, expected 0 or more",
                  fmt::format("{:.3g}", b.friction));
  if (!findings.expect(b.law != LawKind::box || b.lower <= b.upper, "bounds are swapped: lower is above upper",
                       fmt::format("[{:.3g}, {:.3g}] N", b.lower, b.upper)))
    return false;
  for (int k = 0; k < b.rows(); ++k)
    if (!findings.expect(std::isfinite(l[k]), "the solution of a row is not finite")) return false;
  if (b.law == LawKind::box) {
    findings.expect(l[0] >= b.lower && l[0] <= b.upper, "lambda is out of its bounds",
                    fmt::format("{:.3g} N of [{:.3g}, {:.3g}] N", l[0], b.lower, b.upper));
    return true;
  }
  const bool patch = b.law == LawKind::patch;
  double pressed = patch ? 0 : l[0];
  for (int i = 1; patch && i <= b.normals; ++i) pressed += l[-i];
  const double across = patch ? std::hypot(l[0], l[1]) : std::hypot(l[1], l[2]);
  findings.expect(pressed >= 0, "a contact pulls", fmt::format("{:.3g} N", pressed));
  findings.expect(across <= std::max(0.0, b.friction) * pressed * (1 + 1e-9) + 1e-15, "friction is above its cone",
                  fmt::format("{:.3g} N of {:.3g} N", across, b.friction * pressed));
  return true;
}

/// Collects the ids of the component's rows, and checks that they are its own and unique. False if the rows are not
/// valid.
bool check_blocks(Findings& findings, const Simulation& s, const Component& c, std::set<std::uint64_t>& own) {
  std::set<std::uint64_t> ids;
  for (const Block& b : s.problem().blocks) {
    const bool mine = b.owner == c.order;
    const bool once = ids.insert(b.id).second;
    if (!mine) continue;
    own.insert(b.id);
    findings.expect(once, "two of its rows have one id: every block needs a key of its own",
                    fmt::format("key {}", b.id & ((std::uint64_t(1) << 44) - 1)));
    if (!check_block(findings, s.problem(), b)) return false;
  }
  return true;
}

void check_own_ids(Findings& findings, Simulation& s, Component& c) {
  RowBench bench(s, c);
  bench.rows();
  for (const Block& b : bench.blocks)
    findings.expect(owner_of(b.id) == c.order, "the id of a row is not made by row_id(*this, key)",
                    fmt::format("id {}", b.id));
}

/// A row that moves by itself declares its rate.
void check_rates(Findings& findings, Simulation& s, Component& c) {
  RowBench bench(s, c);
  const double dt = 1e-3;
  const RowMap now = bench.rows(0), later = bench.rows(dt);
  for (const auto& [key, row] : now) {
    const auto other = later.find(key);
    if (other == later.end() || !row.positional() || is_unilateral(c, row)) continue;
    const double found = (other->second.violation - row.violation) / dt;
    findings.expect(std::abs(found - row.rate) <= 1e-6 * std::abs(found) + 1e-9,
                    "a row moves by itself at another rate than it declares with moves()",
                    fmt::format("{:.4g} m/s, declared {:.4g} m/s, {}", found, row.rate, name_of(key, row)));
  }
  bench.rows();
}

/// Compares the laws of common rows at equal positions of the bodies.
bool same_laws(const RowMap& a, const RowMap& b, std::string& what) {
  const auto near = [](double x, double y) {
    return x == y || std::abs(x - y) <= 1e-9 * std::max(std::abs(x), std::abs(y));
  };
  for (const auto& [key, row] : a) {
    const auto other = b.find(key);
    if (other == b.end()) continue;
    const Block &x = row.block, &y = other->second.block;
    if (near(x.compliance, y.compliance) && near(x.lower, y.lower) && near(x.upper, y.upper) &&
        near(x.friction, y.friction) && std::abs(row.violation - other->second.violation) <= 1e-9)
      continue;
    what = name_of(key, other->second);
    return false;
  }
  return true;
}

std::vector<double> state_of(const Component& c) {
  std::vector<double> out;
  if (const auto* constraint = dynamic_cast<const Constraint*>(&c)) constraint->append_state(out);
  if (const auto* body = dynamic_cast<const DynamicBody*>(&c)) body->append_state(out);
  return out;
}

/// Lasting changes of a component in a run are in its state, and reset() undoes them.
void check_memory(Findings& findings, const std::filesystem::path& scene, const std::string& id) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  auto* c = s->scene().find_as<Component>(id);
  ASSERT_TRUE(c);
  const auto* stated = dynamic_cast<const StatesLaw*>(c);
  if (!stated) return;
  const Restore start(*s);
  RowBench bench(*s, *c);
  RowMap first = bench.rows();
  if (stated->law().kind == StatedLaw::Kind::unilateral) return;  // its rows also depend on the bodies' motion
  s->reset();
  const std::vector<double> before = state_of(*c);
  std::string what;
  for (int i = 0; i < 75; ++i) {
    run_script(*s, 1);
    if (i % 15 != 14) continue;
    const std::vector<double> after = state_of(*c);
    const Restore here(*s);
    start();
    const bool same = same_laws(first, bench.rows(-s->time()), what);
    here();
    bench.rows();
    findings.expect(same || after != before, "its rows change with something that append_state() does not tell", what);
  }
  s->reset();
  start();
  const bool same = same_laws(first, bench.rows(), what);  // before `what` is passed as a view
  findings.expect(same, "after reset() its rows are not those of the start", what);
}

/// At rest the ids stay. A constraint that declares no rows adds none.
void check_ends(Findings& findings, Simulation& s, Component& c, const std::set<std::uint64_t>& before, bool seen) {
  run_script(s, 1);
  std::set<std::uint64_t> after;
  check_blocks(findings, s, c, after);
  const auto kept = std::count_if(before.begin(), before.end(), [&](std::uint64_t id) { return after.contains(id); });
  findings.expect(kept >= int(0.9 * double(before.size())), "row ids change although nothing moves",
                  fmt::format("{} of {} are kept", kept, before.size()));
  const auto* constraint = dynamic_cast<const Constraint*>(&c);
  if (constraint && !constraint->adds_rows()) findings.expect(!seen, "adds rows, but adds_rows() says it does not");
}

void check_one(const std::filesystem::path& scene, const std::string& element, const std::string& id, bool& seen,
               Compared& compared) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  auto* c = s->scene().find_as<Component>(id);
  ASSERT_TRUE(c);
  Findings findings(fmt::format("<{}> {}", element, id));
  const int n = int(std::lround(script_length / s->h()));
  std::set<std::uint64_t> own;
  for (int i = 0; i < n + 60; ++i) {
    run_script(*s, 1);
    findings.at(fmt::format("after step {}", i));
    own.clear();
    if (!check_blocks(findings, *s, *c, own)) return;
    seen = seen || !own.empty();
    if (i % 10 != 5) continue;
    check_own_ids(findings, *s, *c);
    if (own.empty()) continue;
    if (i >= n && i % 30 != 5) continue;
    check_balance(findings, *s, *c);
    Derivatives(findings, *s, *c, std::uint64_t(i) + 1).check(compared);
    check_stated_law(findings, *s, *c, std::uint64_t(i) / 10);
    check_rates(findings, *s, *c);
  }
  findings.at("");
  check_ends(findings, *s, *c, own, seen);
  check_memory(findings, scene, id);
}

}  // namespace

void check_rows(const std::filesystem::path& scene, const std::string& element, bool rows_expected) {
  std::vector<std::string> mine;
  bool adds = false;
  {
    auto s = load(scene);
    ASSERT_TRUE(s);
    for (Component* c : s->scene().components()) {
      if (c->element != element) continue;
      mine.push_back(c->id);
      const auto* constraint = dynamic_cast<const Constraint*>(c);
      adds = adds || !constraint || constraint->adds_rows();
    }
  }
  Findings findings("<" + element + ">");
  if (!findings.expect(!mine.empty(), "its example holds none of it")) return;
  bool seen = false;
  Compared compared;
  for (const std::string& id : mine) check_one(scene, element, id, seen, compared);
  if (!rows_expected || !adds) return;
  if (!findings.expect(seen, "its example never shows a row of it, so it shows nothing")) return;
  findings.expect(!compared.rows.empty(), "no row had a violation to compare with its derivative");
  findings.expect(!compared.unilateral || compared.tight,
                  "no contact came closer than 0.4 mm, so no direction could be checked; let its example touch");
}

}  // namespace insula::test
