// SPDX-License-Identifier: GPL-3.0-or-later
// What this machine needs for one of each: the code that steps run, timed on two bricks.
#include <algorithm>
#include <memory>
#include <vector>

#include "core/linalg/direct_solver.h"
#include "core/mechanics/soft_body.h"
#include "tools/workbench/cost_model.h"
#include "tools/workbench/scaling_scene.h"
#include "tools/workbench/shortest.h"

namespace insula {
namespace {

/// Time of a sweep over the square of the number of rows, s, from the first steps of a scene.
double sweep_rate(Simulation& s) {
  double solve = 1e9;
  for (int i = 0; i < 4; ++i) {
    s.step();
    const StepReport& now = s.report();
    if (i > 0 && now.solve.sweeps > 0)
      solve = std::min(solve, now.stage_ms[stage_solve] * 1e-3 / (now.solve.sweeps * double(now.rows) * now.rows));
  }
  return solve < 1e9 ? solve : 1e-9;
}

void measure_elements(SoftBody& body, double h, CostRates& r) {
  BlockMatrix a = body.system();
  std::vector<double> force(3 * std::size_t(body.nodes()));
  const double tets = double(body.rest().tets.size());
  ForceModel& model = *body.forces().front();
  r.tetrahedron = shortest(4, [&] { model.linearise(body.q().data(), force.data(), &a, h, Tangent::system); }) / tets;
  r.tetrahedron_force =
      shortest(4, [&] { model.linearise(body.q().data(), force.data(), nullptr, h, Tangent::system); }) / tets;
}

struct FactorCost {
  double seconds = 1e9, flops = 0, entries = 0;
};

/// A factor of a body's matrix, and its cost.
struct MeasuredFactor {
  std::unique_ptr<BodySolver> solver = make_direct_solver(false);
  FactorCost cost;
  double compliance = 1e9;  ///< time for the compliance of the body's rows with this factor, s

  MeasuredFactor(const SoftBody& body, int runs, bool with_compliance) {
    solver->analyse(body.system());
    cost.flops = solver->cost().factor_flops;
    cost.entries = double(solver->cost().factor_entries);
    for (int i = 0; i < runs; ++i) {
      cost.seconds = std::min(cost.seconds, shortest(1, [&] { solver->factorise(body.system()); }));
      if (!with_compliance) continue;
      // Each run uses a new factor, since rows otherwise keep their compliance.
      const auto compute = [&] { solver->compute_compliance(body.rows, body.free_of_node()); };
      compliance = std::min(compliance, shortest(1, compute));
    }
  }
};

void measure_rows(const SoftBody& body, const SceneWork& work, const MeasuredFactor& factor, CostRates& r) {
  std::vector<double> x(3 * std::size_t(body.nodes()), 1.0);
  r.solve_entry = shortest(6, [&] { factor.solver->solve(x.data()); }) / factor.cost.entries;
  r.compliance_flop = factor.compliance / std::max(1.0, work.bodies.front().compliance_flops);
  const int side = work.standing_rows + 8;
  std::vector<double> w(std::size_t(side) * std::size_t(side));
  r.compliance_row2 = shortest(4, [&] { factor.solver->add_compliance(body.rows, w.data(), side); }) /
                      std::max(1.0, double(body.rows.count()) * body.rows.count());
}

/// Separates the cost of flops from that of entries, with two factors of different sizes.
void set_factor_rates(const FactorCost& a, const FactorCost& b, CostRates& r) {
  const double det = a.flops * b.entries - b.flops * a.entries;
  r.factor_flop = (a.seconds * b.entries - b.seconds * a.entries) / det;
  r.factor_entry = (a.flops * b.seconds - b.flops * a.seconds) / det;
  // Noise may give one rate a meaningless sign. Then all of the cost counts as flops.
  if (!(r.factor_flop > 0) || !(r.factor_entry >= 0)) r.factor_flop = b.seconds / b.flops, r.factor_entry = 0;
}

}  // namespace

CostRates measure_rates(const Registry& registry) {
  CostRates r;
  // A small body and a medium one. Both are so small that the measurement is a small part of an author's waiting time.
  const auto s = brick_scene({10, 6, 0, 40}, registry, 1);
  auto& lower = *const_cast<SoftBody*>(s->scene().find_as<SoftBody>("lower"));
  auto& upper = *const_cast<SoftBody*>(s->scene().find_as<SoftBody>("upper"));
  r.sweep_row2 = sweep_rate(*s);
  const SceneWork work = count_work(*s);
  const auto update = [&] {
    for (Surface* f : s->surfaces()) f->update_collision();
  };
  r.vertex = shortest(6, update) / std::max(1, work.surface_vertices);
  measure_elements(lower, s->h(), r);
  const MeasuredFactor small(upper, 8, false), middle(lower, 4, true);
  measure_rows(lower, work, middle, r);
  set_factor_rates(small.cost, middle.cost, r);
  return r;
}

}  // namespace insula
