// SPDX-License-Identifier: GPL-3.0-or-later
// What this machine needs for one of each: the code that steps run, timed on two bricks.
#include <algorithm>

#include "core/linalg/direct_solver.h"
#include "core/mechanics/soft_body.h"
#include "tools/workbench/cost_model.h"
#include "tools/workbench/scaling_scene.h"
#include "tools/workbench/shortest.h"

namespace insula {
CostRates measure_rates(const Registry& registry) {
  CostRates r;
  // A small body and a middle one: their factors tell flops from entries. Each of them is small enough that all of this
  // is a part of what an author waits for.
  const auto s = brick_scene({10, 6, 0, 40}, registry, 1);
  auto& lower = *const_cast<SoftBody*>(s->scene().find_as<SoftBody>("lower"));
  auto& upper = *const_cast<SoftBody*>(s->scene().find_as<SoftBody>("upper"));
  double solve = 1e9;
  for (int i = 0; i < 4; ++i) {
    s->step();
    const StepReport& now = s->report();
    if (i > 0 && now.solve.sweeps > 0)
      solve = std::min(solve, now.stage_ms[stage_solve] * 1e-3 / (now.solve.sweeps * double(now.rows) * now.rows));
  }
  const SceneWork work = count_work(*s);
  r.vertex = shortest(6,
                      [&] {
                        for (Surface* f : s->surfaces()) f->update_collision();
                      }) /
             std::max(1, work.surface_vertices);
  r.sweep_row2 = solve < 1e9 ? solve : 1e-9;

  BlockMatrix a = lower.system();
  std::vector<double> force(3 * std::size_t(lower.nodes()));
  const double tets = double(lower.rest().tets.size());
  ForceModel& model = *lower.forces().front();
  r.tetrahedron =
      shortest(4, [&] { model.linearise(lower.q().data(), force.data(), &a, s->h(), Tangent::system); }) / tets;
  r.tetrahedron_force =
      shortest(4, [&] { model.linearise(lower.q().data(), force.data(), nullptr, s->h(), Tangent::system); }) / tets;

  struct Factor {
    double seconds, flops, entries;
  } factor[2];
  for (int k = 0; k < 2; ++k) {
    const SoftBody& body = k == 0 ? upper : lower;
    const auto solver = make_direct_solver(false);
    solver->analyse(body.system());
    factor[k] = {1e9, solver->cost().factor_flops, double(solver->cost().factor_entries)};
    double compliance = 1e9;
    for (int i = 0; i < (k == 0 ? 8 : 4); ++i) {
      factor[k].seconds = std::min(factor[k].seconds, shortest(1, [&] { solver->factorise(body.system()); }));
      if (k == 1)
        compliance = std::min(compliance, shortest(1, [&] {
                                solver->compute_compliance(body.rows, body.free_of_node());
                              }));  // with a factor of its own: else rows keep what they have
    }
    if (k == 0) continue;
    std::vector<double> x(3 * std::size_t(body.nodes()), 1.0);
    r.solve_entry = shortest(6, [&] { solver->solve(x.data()); }) / factor[k].entries;
    const BodyWork& b = work.bodies.front();
    r.compliance_flop = compliance / std::max(1.0, b.compliance_flops);
    std::vector<double> w(std::size_t(work.standing_rows + 8) * std::size_t(work.standing_rows + 8));
    r.compliance_row2 = shortest(4, [&] { solver->add_compliance(body.rows, w.data(), work.standing_rows + 8); }) /
                        std::max(1.0, double(body.rows.count()) * body.rows.count());
  }
  const double det = factor[0].flops * factor[1].entries - factor[1].flops * factor[0].entries;
  r.factor_flop = (factor[0].seconds * factor[1].entries - factor[1].seconds * factor[0].entries) / det;
  r.factor_entry = (factor[0].flops * factor[1].seconds - factor[1].flops * factor[0].seconds) / det;
  // Noise may give one of them a senseless sign: then all is flops.
  if (!(r.factor_flop > 0) || !(r.factor_entry >= 0))
    r.factor_flop = factor[1].seconds / factor[1].flops, r.factor_entry = 0;
  return r;
}

}  // namespace insula
