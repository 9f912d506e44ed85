// SPDX-License-Identifier: GPL-3.0-or-later
// Counts of a scene and what they make of a step.
#include "tools/workbench/cost_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/mechanics/instrument.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"

namespace insula {
namespace {

/// What the hands and an implant add to the rows that stand already.
struct MoreRows {
  double expected = 0, most = 0;
  std::vector<std::pair<const Body*, double>> of_body;
};

MoreRows rows_of_hands(const Simulation& s, const std::vector<RowEstimate>& estimates) {
  MoreRows out;
  const auto expect = [&](const RowEstimate& e) {
    out.expected += e.expected;
    out.of_body.emplace_back(e.body, e.expected);
  };
  for (int hand = 0; hand < 2; ++hand) {
    const Instrument* tool = s.instrument_of(hand);
    bool working = false;  // at one place at a time
    for (const RowEstimate& e : estimates) {
      if (!tool || e.tool != tool) continue;
      out.most += e.most;
      if (!working) expect(e);
      working = true;
    }
  }
  const RigidBody* closed = nullptr;  // one implant at a time
  for (const RowEstimate& e : estimates) {
    if (!e.tool || !e.tool->implant() || (closed && e.tool != closed)) continue;
    closed = e.tool;
    out.most += e.most;
    expect(e);
  }
  return out;
}

}  // namespace

double usual_compliance_flops(double rows, const SolverCost& solver, int nodes) {
  return 0.7 * (rows * double(solver.factor_entries) + 0.3 * rows * rows * 3 * nodes);
}

SceneWork count_work(const Simulation& s) {
  SceneWork w;
  w.h = s.h();
  w.standing_rows = s.problem().rows;
  CostCounts counts;
  for (const Constraint* c : s.constraints()) c->estimate_cost(counts);
  const MoreRows more = rows_of_hands(s, counts.rows);
  w.expected_rows = w.standing_rows + int(std::lround(more.expected));
  w.max_rows = w.standing_rows + int(std::lround(more.most));
  w.newton = s.solve_settings().max_newton > 0;
  w.expected_sweeps = 6 + 0.05 * w.expected_rows;

  for (const Body* b : s.bodies()) {
    const auto* body = dynamic_cast<const DeformableBody*>(b);
    if (!body) continue;
    BodyWork k;
    k.id = body->id;
    k.nodes = body->nodes();
    k.h = s.h();
    if (const auto* soft = dynamic_cast<const SoftBody*>(body)) k.elements = int(soft->rest().tets.size());
    if (const auto* shell = dynamic_cast<const ShellBody*>(body))
      k.elements = int(shell->wall_triangles().size()), k.wall = true;
    k.background = body->solver_kind.is("asynchronous");
    k.keeps_tangent = !k.background && body->tangent_tolerance() > 0;
    k.solver = body->solver_cost();
    const int now = body->rows.count();
    double rows = now;
    for (const auto& [which, n] : more.of_body) rows += which == body ? n : 0;
    k.rows = int(std::lround(rows));
    // The flops of the last rows, and the usual ones of those that are expected.
    const auto usual = [&](double m) { return usual_compliance_flops(m, k.solver, k.nodes); };
    k.compliance_flops =
        k.solver.compliance_flops > 0 ? k.solver.compliance_flops + usual(rows) - usual(now) : usual(rows);
    w.bodies.push_back(std::move(k));
  }

  const auto moves = [](const Surface* f) { return f->body().blocks() > 0; };
  for (const Surface* f : s.surfaces())
    if (moves(f)) w.surface_vertices += int(f->rest().vertices.size());
  std::set<const Surface*> touched;
  for (const Surface* f : counts.searched)
    if (moves(f)) touched.insert(f);
  w.tissue_vertices = counts.tissue_vertices;
  w.tool_pieces = counts.tool_pieces;
  w.wall_vertices = counts.self_vertices;
  for (const Surface* f : touched) w.surface_triangles += int(f->triangles().size());
  return w;
}

namespace {

/// Bodies by their cost, the heaviest first, on so many threads: when the last one is done.
double on_threads(std::vector<double> seconds, int threads) {
  std::sort(seconds.rbegin(), seconds.rend());
  std::vector<double> busy(std::size_t(std::max(1, threads)), 0.0);
  for (double t : seconds) *std::min_element(busy.begin(), busy.end()) += t;
  return *std::max_element(busy.begin(), busy.end());
}

struct Share {
  double ms;
  std::string what, advice;
};

/// Time of each stage for each body, s, and the largest shares of it.
class BodyCosts {
 public:
  explicit BodyCosts(const CostRates& rates) : r_(rates) {}

  void add(const BodyWork& b) {
    const double tangent = b.elements * r_.tetrahedron * (b.wall ? wall_tangent : 1),
                 force = b.elements * r_.tetrahedron_force * (b.wall ? wall_force : 1);
    const double factor =
        b.background ? 0 : b.solver.factor_flops * r_.factor_flop + double(b.solver.factor_entries) * r_.factor_entry;
    const double solve = double(b.solver.factor_entries) * r_.solve_entry * (b.background ? 0.5 * iterations : 1);
    const double often = b.keeps_tangent ? renewals : 1, forward = b.background ? solve : 0.5 * solve;
    free.push_back(in_a_step * (often * (tangent + factor) + (1 - often) * force + forward) + 12 * b.nodes * r_.vertex);
    correct.push_back(b.background ? (b.rows > 0 ? 0.8 * solve : 0) : 0.5 * solve);
    compliance.push_back(b.rows > 0 ? b.compliance_flops * r_.compliance_flop +
                                          1.5 * std::max(0.0, double(b.solver.factor_entries) - cached) * r_.solve_entry
                                    : 0);
    rows2 += double(b.rows) * b.rows * r_.compliance_row2;
    if (b.keeps_tangent) refactor_ms = std::max(refactor_ms, 1000 * (tangent + factor));
    add_shares(b, 1000 * often * factor, 1000 * (tangent * often + force * (1 - often)));
  }

  std::vector<double> free, correct, compliance;
  double rows2 = 0;  ///< time to add up W, s
  double refactor_ms = 0;
  std::vector<Share> shares;

 private:
  // wall_tangent, wall_force: cost of a wall triangle with its hinges over a tetrahedron. renewals: share of steps that
  // renew a kept factor. iterations: of a solve with a background factor. in_a_step: time in a step over that of the
  // best of several runs in a row, with data in the caches. cached: entries of a factor that a cache holds.
  static constexpr double wall_tangent = 3, wall_force = 3.2, renewals = 0.05, iterations = 3, in_a_step = 1.25,
                          cached = 1e6;

  void add_shares(const BodyWork& b, double factor_ms, double elements_ms) {
    shares.push_back(
        {factor_ms,
         fmt::format("the factor of \"{}\" ({} nodes, {:.0f} Mflop)", b.id, b.nodes, b.solver.factor_flops * 1e-6),
         fmt::format("fewer nodes in \"{}\": half of them make its factor about four times cheaper; hold what lies far "
                     "with <fixed>{}",
                     b.id,
                     b.keeps_tangent               ? ""
                     : b.solver.factor_flops > 1e9 ? ", or have it made in the background with solver=\"asynchronous\""
                                                   : ", or keep the factor with tangent_tolerance=\"0.02\"")});
    shares.push_back({elements_ms, fmt::format("the {} elements of \"{}\"", b.elements, b.id),
                      fmt::format("fewer elements in \"{}\"", b.id)});
    shares.push_back({1000 * compliance.back(), fmt::format("the compliance of {} rows on \"{}\"", b.rows, b.id),
                      "fewer rows: larger spacing, smaller max_contacts, patch, fewer strands"});
  }

  const CostRates& r_;
};

void set_stages(CostEstimate& out, const SceneWork& w, const CostRates& r, const BodyCosts& bodies, int threads) {
  constexpr double newton_step = 2;
  const double surfaces = r.vertex * (0.8 * w.surface_vertices + 0.2 * w.surface_triangles + 0.25 * w.tissue_vertices +
                                      500.0 * w.tool_pieces + 120.0 * w.wall_vertices + 550.0 * w.expected_rows);
  // Newton steps are used where sweeps stall. One step costs m^3 / 1.5 flops in small parts, at the dense rate of the
  // factor.
  const double rows2 = double(w.expected_rows) * w.expected_rows;
  const double sweeps = w.expected_sweeps * rows2 * r.sweep_row2 +
                        (w.newton ? newton_step * rows2 * w.expected_rows / 1.5 * r.compliance_flop : 0);
  const double row = 10 * r.vertex;  // other costs of a row: to build, read and publish it
  double all = 0;
  for (double c : bodies.compliance) all += c;
  // Threads also share parts of a body's compliance. So all have equal work, except for the sum by one thread.
  out.stage_ms[stage_free_motion] = 1000 * on_threads(bodies.free, threads);
  out.stage_ms[stage_collision] = 1000 * surfaces / std::max(1.0, 0.85 * threads);
  out.stage_ms[stage_build] = 1000 * (all / std::max(1, threads) + bodies.rows2 + row * w.expected_rows);
  out.stage_ms[stage_solve] = 1000 * sweeps;
  out.stage_ms[stage_correct] = 1000 * (on_threads(bodies.correct, threads) + row * w.expected_rows);
  out.stage_ms[stage_publish] = 1000 * row * w.expected_rows;
  for (double ms : out.stage_ms) out.step_ms += ms;
}

}  // namespace

CostEstimate estimate(const SceneWork& w, const CostRates& r, int threads) {
  BodyCosts bodies(r);
  for (const BodyWork& b : w.bodies) bodies.add(b);
  CostEstimate out;
  out.refactor_ms = std::max(out.refactor_ms, bodies.refactor_ms);
  set_stages(out, w, r, bodies, threads);
  std::vector<Share> shares = std::move(bodies.shares);
  shares.push_back({out.stage_ms[stage_collision],
                    fmt::format("collision of surfaces with {} triangles", w.surface_triangles),
                    "coarser surfaces for contact; contact=\"false\" on those for the picture; a larger "
                    "tissue_spacing; smaller alarms"});
  shares.push_back(
      {out.stage_ms[stage_solve], fmt::format("{:.0f} sweeps over {} rows", w.expected_sweeps, w.expected_rows),
       "fewer rows: larger spacing, smaller max_contacts, patch, fewer strands; a smaller max_sweeps of <solver>"});
  std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.ms > b.ms; });
  out.most = shares.front().what;
  if (out.step_ms > 1000 * w.h)
    for (const Share& s : shares)
      if (s.ms > 0.15 * out.step_ms && std::find(out.advice.begin(), out.advice.end(), s.advice) == out.advice.end())
        out.advice.push_back(s.advice);
  return out;
}

}  // namespace insula
