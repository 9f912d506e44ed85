// SPDX-License-Identifier: GPL-3.0-or-later
// One soft body with co-rotational elements, stepped by itself: for closed forms of elasticity and time integration.
#pragma once
#include <functional>
#include <memory>
#include <stdexcept>

#include "core/mechanics/soft_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula::test {

struct Material {
  double young = 1000, poisson = 0, density = 1000, rayleigh_mass = 0, rayleigh_stiffness = 0;
  const char* tangent = "rotated";
};

class HoldWhere final : public Support {
 public:
  std::function<bool(const Vec3&)> where;
  void fix(PrepareContext&, const std::vector<Vec3>& rest, std::vector<char>& fixed) override {
    for (std::size_t i = 0; i < rest.size(); ++i) fixed[i] = fixed[i] || where(rest[i]);
  }
};

/// Nodes for which `held` is true do not move.
inline std::unique_ptr<SoftBody> soft_body(TetMesh mesh, const Material& m,
                                           std::function<bool(const Vec3&)> fixed = nullptr) {
  auto body = std::make_unique<SoftBody>();
  body->set_mesh(std::move(mesh));
  auto fem = builtin().create("corotational_fem");
  const auto set = [&](const char* name, double value) {
    dynamic_cast<QuantityParam&>(*fem->find_param(name)).set(value);
  };
  set("young", m.young);
  set("poisson", m.poisson);
  set("density", m.density);
  set("rayleigh_mass", m.rayleigh_mass);
  set("rayleigh_stiffness", m.rayleigh_stiffness);
  dynamic_cast<Param<Choice>&>(*fem->find_param("tangent")).set(m.tangent);
  fem->parent = body.get();
  body->children.push_back(std::move(fem));
  if (fixed) {
    auto support = std::make_unique<HoldWhere>();
    support->where = std::move(fixed);
    support->parent = body.get();
    body->children.push_back(std::move(support));
  }
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, 0.01};
  body->prepare(context);
  body->connect(context);
  if (!diagnostics.ok()) throw std::runtime_error(diagnostics.format());
  return body;
}

inline void step(SoftBody& body, double h, const Vec3& gravity = Vec3::Zero()) {
  StepContext context;
  context.h = h;
  context.gravity = gravity;
  body.rows.clear();
  body.free_motion(context);
  body.apply(context, body.rows, nullptr);
}

/// Newton steps of the static problem: implicit Euler with a step so long that inertia vanishes.
inline void settle(SoftBody& body, int steps) {
  for (int i = 0; i < steps; ++i) {
    body.v().setZero();
    step(body, 1e6);
  }
}

/// A force (N) spread evenly over the boundary triangles whose corners all satisfy `where` (rest positions).
inline void load_face(SoftBody& body, const Vec3& force, const std::function<bool(const Vec3&)>& where) {
  const auto& x = body.rest().nodes;
  double area = 0;
  for (int pass = 0; pass < 2; ++pass)
    for (const auto& t : boundary_triangles(body.rest())) {
      const Vec3 &a = x[std::size_t(t[0])], &b = x[std::size_t(t[1])], &c = x[std::size_t(t[2])];
      if (!where(a) || !where(b) || !where(c)) continue;
      const double s = 0.5 * (b - a).cross(c - a).norm();
      if (pass == 0) area += s;
      else
        for (int n : t) body.external.segment<3>(3 * n) += s / (3 * area) * force;
    }
}

inline Vec3 mean_displacement(const SoftBody& body, const std::function<bool(const Vec3&)>& where) {
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (int i = 0; i < body.nodes(); ++i)
    if (where(body.rest().nodes[std::size_t(i)])) {
      sum += body.q().segment<3>(3 * i) - body.rest().nodes[std::size_t(i)];
      ++n;
    }
  return sum / n;
}

}  // namespace insula::test
