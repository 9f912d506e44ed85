// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of force models: energy, force, stiffness and, for internal forces, invariance under rigid motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "core/mechanics/soft_body.h"
#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {
namespace {

/// The model, bound to a separate matrix without fixed nodes.
struct Bench {
  DeformableBody& body;
  ForceModel& model;
  BlockMatrix matrix;
  int n;

  Bench(DeformableBody& b, ForceModel& m) : body(b), model(m), n(3 * b.nodes()) {
    std::vector<std::pair<int, int>> pairs;
    model.couplings(pairs, Tangent::exact);
    model.couplings(pairs, Tangent::system);
    matrix.set_pattern(body.nodes(), std::move(pairs));
    std::vector<int> all(std::size_t(body.nodes()));
    std::iota(all.begin(), all.end(), 0);
    model.bind(matrix, all);
  }
  VecX force(const VecX& x) {
    VecX f = VecX::Zero(n);
    model.linearise(x.data(), f.data(), nullptr, 0, Tangent::system);
    return f;
  }
  MatX stiffness(const VecX& x, double h, Tangent which) {
    VecX f = VecX::Zero(n);
    matrix.set_zero();
    model.linearise(x.data(), f.data(), &matrix, h, which);
    return dense();
  }
  /// Force that depends on velocity, and C if it is requested.
  VecX damping_force(const VecX& x, const VecX& v, double h, MatX* damping = nullptr) {
    VecX f = VecX::Zero(n);
    matrix.set_zero();
    model.linearise_damping(x.data(), v.data(), f.data(), damping ? &matrix : nullptr, h);
    if (damping) *damping = dense();
    return f;
  }
  MatX dense() const {
    MatX k = MatX::Zero(n, n);
    for (int j = 0; j < matrix.nodes(); ++j) {
      const int end = j + 1 < matrix.nodes() ? matrix.column_start(j + 1) : matrix.slots();
      for (int s = matrix.column_start(j); s < end; ++s) {
        const Eigen::Map<const Mat3> block(matrix.block(s));
        k.block<3, 3>(3 * matrix.row(s), 3 * j) = block;
        if (matrix.row(s) != j) k.block<3, 3>(3 * j, 3 * matrix.row(s)) = block.transpose();
      }
    }
    return k;
  }
};

void check_balanced(Findings& findings, const Bench& b, const VecX& x, const VecX& f, double reference) {
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), centre = Vec3::Zero();
  double size = 0;
  const int nodes = b.body.nodes();
  for (int i = 0; i < nodes; ++i) centre += x.segment<3>(3 * i) / nodes;
  for (int i = 0; i < nodes; ++i) {
    const Vec3 r = x.segment<3>(3 * i) - centre, fi = f.segment<3>(3 * i);
    sum += fi;
    moment += r.cross(fi);
    size = std::max(size, r.norm());
  }
  findings.within("forces add up to nothing", sum.norm(), reference, 1e-10);
  findings.within("moments add up to nothing", moment.norm(), reference * size, 1e-10);
}

/// Fourth-order central differences of the energy at a sample of the degrees of freedom.
void check_force(Findings& findings, Bench& b, const VecX& x, const VecX& f, Random& random) {
  const double e = 1e-3 * shortest_edge(b.body), largest = f.lpNorm<Eigen::Infinity>();
  for (int trial = 0; trial < 60; ++trial) {
    const int i = int(random.below(std::uint32_t(b.n)));
    const auto energy = [&](double d) {
      VecX y = x;
      y[i] += d;
      return b.model.energy(y.data());
    };
    const double slope = (8 * (energy(e) - energy(-e)) - (energy(2 * e) - energy(-2 * e))) / (12 * e);
    findings.within("force = minus energy gradient", std::abs(f[i] + slope), largest, 1e-7,
                    fmt::format("degree of freedom {}: {:.6g} N, expected {:.6g} N", i, f[i], -slope));
  }
}

/// Stiffness against differences of the force, along random directions; then the tangent that the step uses.
void check_stiffness(Findings& findings, Bench& b, const VecX& x, Random& random) {
  const double e = 1e-3 * shortest_edge(b.body);
  const MatX exact = b.stiffness(x, 0, Tangent::exact);
  findings.within("exact stiffness is symmetric", (exact - exact.transpose()).norm(), exact.norm(), 1e-12);
  for (int trial = 0; trial < 10; ++trial) {
    VecX d(b.n);
    for (int i = 0; i < b.n; ++i) d[i] = random.uniform(-1, 1);
    const VecX slope =
        (8 * (b.force(x + e * d) - b.force(x - e * d)) - (b.force(x + 2 * e * d) - b.force(x - 2 * e * d))) / (12 * e);
    const VecX product = exact * d;
    findings.within("exact stiffness = force gradient", (product + slope).norm(), product.norm(), 1e-6);
  }
  const MatX system = b.stiffness(x, 0, Tangent::system);
  findings.within("the step's tangent is symmetric", (system - system.transpose()).norm(), system.norm(), 1e-12);
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(system, Eigen::EigenvaluesOnly).eigenvalues();
  findings.expect(values[0] > -1e-10 * values[b.n - 1], "the step's tangent has a negative eigenvalue",
                  fmt::format("{:.3g}, the largest {:.3g} N/m", values[0], values[b.n - 1]));
  const double h = 0.01, factor = 1 + b.model.stiffness_damping() / h;
  findings.within("the step's tangent has the promised damping",
                  (b.stiffness(x, h, Tangent::system) - factor * system).norm(), system.norm() * factor, 1e-12);
}

void check_state(Findings& findings, Bench& b, const VecX& x, std::uint64_t seed) {
  Random random(seed);
  const VecX f = b.force(x);
  const double largest = f.lpNorm<Eigen::Infinity>();
  if (!findings.expect(f.allFinite(), "its force is not finite") ||
      !findings.expect(largest > 0, "a deformed state gives no force"))
    return;
  if (b.model.internal()) check_balanced(findings, b, x, f, f.lpNorm<1>());
  check_force(findings, b, x, f, random);
  check_stiffness(findings, b, x, random);
}

/// Rigid motions, also far ones and without a warm start.
void check_rigid_motions(Findings& findings, Bench& b, const VecX& rest, double reference) {
  Random random(5);
  for (int trial = 0; trial < 10; ++trial) {
    const Vec3 turn(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)),
        shift(random.uniform(-0.1, 0.1), 0.05, -0.02);
    const Quat q = from_rotation_vector(turn);
    VecX x(rest.size());
    for (int i = 0; i < b.body.nodes(); ++i) x.segment<3>(3 * i) = q * rest.segment<3>(3 * i) + shift;
    b.model.reset();
    if (b.model.internal())
      findings.within("rigid motion gives no force", b.force(x).lpNorm<Eigen::Infinity>(), reference, 1e-10);
    findings.expect(b.model.energy(x.data()) >= 0, "its energy is negative");
  }
}

/// The same laws about another stress-free configuration.
void check_prestrain(Findings& findings, Bench& b, const VecX& rest, double reference) {
  const VecX moved = 0.5 * (deformed(b.body, 0.1, 4) - rest);
  const VecX before = b.force(rest);
  if (!b.model.prestrain(moved.data())) return;
  findings.expect((b.force(rest) - before).lpNorm<Eigen::Infinity>() > 1e-3 * reference,
                  "a prestrain gives no force at rest");
  for (std::uint64_t seed = 5; seed <= 6; ++seed) {
    findings.at("prestrained, deformed state " + std::to_string(seed));
    b.model.reset();
    check_state(findings, b, deformed(b.body, 0.1, seed), seed);
  }
  findings.at("");
  const VecX back = -moved;
  b.model.prestrain(back.data());
  b.model.reset();
  findings.within("prestrains add up", (b.force(rest) - before).lpNorm<Eigen::Infinity>(), reference, 1e-10);
}

/// Lasting changes of a model in a run are in its state, and reset() undoes them.
void check_memory(Findings& findings, const std::filesystem::path& scene, const std::string& id) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  auto* model = s->scene().find_as<ForceModel>(id);
  ASSERT_TRUE(model);
  auto* body = dynamic_cast<DeformableBody*>(model->parent);
  ASSERT_TRUE(body);
  const VecX x = deformed(*body, 0.02, 9);
  const auto answer = [&] {  // energy alone: it has no warm start
    return model->energy(x.data());
  };
  const auto state = [&] {
    std::vector<double> out;
    model->append_state(out);
    return out;
  };
  const double energy = answer();
  const std::vector<double> before = state();
  run_script(*s, 75);
  const double now = answer(), least = 1e-9 * std::abs(energy);
  findings.expect(std::abs(now - energy) <= least || state() != before,
                  "its law changes with something that append_state() does not tell",
                  fmt::format("{:.6g} J after a run, {:.6g} J before it", now, energy));
  model->reset();
  findings.expect(std::abs(answer() - energy) <= least && state() == before,
                  "reset() does not undo what finish() changed",
                  fmt::format("{:.6g} J after reset, {:.6g} J at the start", answer(), energy));
}

VecX random_vector(Random& random, int n, double scale) {
  VecX d(n);
  for (int i = 0; i < n; ++i) d[i] = scale * random.uniform(-1, 1);
  return d;
}

/// Damping of the model's own, in a state without history.
void check_damping(Findings& findings, Bench& b, const VecX& x, std::uint64_t seed) {
  constexpr double h = 0.01;
  Random random(seed);
  const double speed = 0.1 * shortest_edge(b.body) / h;
  const VecX v = random_vector(random, b.n, speed);
  MatX damping;
  const VecX f = b.damping_force(x, v, h, &damping);
  if (!findings.expect(f.norm() > 0, "has_damping(), but velocity gives no force")) return;
  findings.within("force with and without its damping matrix", (f - b.damping_force(x, v, h)).norm(), f.norm(), 1e-14);
  if (b.model.internal()) check_balanced(findings, b, x, f, f.lpNorm<1>());
  findings.expect(f.dot(v) < 0, "the damping adds energy", fmt::format("power {:.3g} W", f.dot(v)));
  findings.within("damping is symmetric", (damping - damping.transpose()).norm(), damping.norm(), 1e-12);
  for (int trial = 0; trial < 10; ++trial) {
    const VecX d = random_vector(random, b.n, 1);
    const double e = 1e-3 * speed;
    const VecX product = damping * d;
    const VecX slope = (b.damping_force(x, v + e * d, h) - b.damping_force(x, v - e * d, h)) / (2 * e);
    findings.within("damping = minus force gradient by velocity", (product + slope).norm(), product.norm(), 1e-6);
  }
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(damping, Eigen::EigenvaluesOnly).eigenvalues();
  findings.expect(values[0] > -1e-10 * values[b.n - 1], "the damping has a negative eigenvalue",
                  fmt::format("{:.3g}, the largest {:.3g} N s/m", values[0], values[b.n - 1]));
}

/// The sum of the stresses times the volumes of a solid's elements is the virial of its nodal forces.
void check_stress(Findings& findings, Bench& b, const VecX& x) {
  const auto* solid = dynamic_cast<const SoftBody*>(&b.body);
  if (!solid) return;
  const auto& tets = solid->rest().tets;
  std::vector<Mat3> stress(tets.size(), Mat3::Zero());
  if (!b.model.add_stress(x.data(), stress)) return;
  const auto at = [&](int node) -> Vec3 { return x.segment<3>(3 * node); };
  Mat3 sum = Mat3::Zero();
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const Vec3 a = at(tets[t][0]), d = at(tets[t][1]) - a, e = at(tets[t][2]) - a, f = at(tets[t][3]) - a;
    sum += d.cross(e).dot(f) / 6 * stress[t];
  }
  const VecX force = b.force(x);
  Mat3 virial = Mat3::Zero();
  for (int i = 0; i < b.body.nodes(); ++i) virial -= force.segment<3>(3 * i) * at(i).transpose();
  findings.within("stress times volume = virial of the forces", (sum - virial).norm(), virial.norm(), 1e-9);
}

}  // namespace

void check_force_model(const std::filesystem::path& scene, const std::string& element) {
  auto simulation = load(scene);
  ASSERT_TRUE(simulation);
  int found = 0;
  Findings none("<" + element + ">");
  for (ForceModel* m : simulation->scene().all<ForceModel>()) {
    if (m->element != element) continue;
    auto* body = dynamic_cast<DeformableBody*>(m->parent);
    ASSERT_TRUE(body);
    ++found;
    Findings findings("<" + element + "> " + m->id);
    Bench bench(*body, *m);
    const VecX rest = body->q();
    double reference = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      findings.at("deformed state " + std::to_string(seed));
      const VecX x = deformed(*body, 0.1, seed);
      m->reset();
      reference = bench.force(x).lpNorm<Eigen::Infinity>();
      check_state(findings, bench, x, seed);
      check_stress(findings, bench, x);
      if (m->has_damping()) check_damping(findings, bench, x, seed);
    }
    findings.at("");
    check_rigid_motions(findings, bench, rest, reference);
    findings.expect(m->stiffness_damping() >= 0, "its stiffness damping is negative");
    check_prestrain(findings, bench, rest, reference);
    check_memory(findings, scene, m->id);
  }
  none.expect(found > 0, "its example holds none of it");
}

}  // namespace insula::test
