// SPDX-License-Identifier: GPL-3.0-or-later
// One soft body with co-rotational elements, stepped by itself: for closed forms of elasticity and time integration.
#pragma once
#include <functional>
#include <memory>
#include <stdexcept>

#include "core/mechanics/soft_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/single_body.h"

namespace insula::test {

struct Material {
  double young = 1000, poisson = 0, density = 1000, rayleigh_mass = 0, rayleigh_stiffness = 0;
  const char* tangent = "rotated";
};

/// Nodes for which `fixed` is true do not move.
inline std::unique_ptr<SoftBody> soft_body(TetMesh mesh, const Material& m,
                                           std::function<bool(const Vec3&)> fixed = nullptr) {
  auto body = std::make_unique<SoftBody>();
  body->set_mesh(std::move(mesh));
  auto fem = builtin().create("corotational_fem");
  set_quantity(*fem, "young", m.young);
  set_quantity(*fem, "poisson", m.poisson);
  set_quantity(*fem, "density", m.density);
  set_quantity(*fem, "rayleigh_mass", m.rayleigh_mass);
  set_quantity(*fem, "rayleigh_stiffness", m.rayleigh_stiffness);
  dynamic_cast<Param<Choice>&>(*fem->find_param("tangent")).set(m.tangent);
  fem->parent = body.get();
  body->children.push_back(std::move(fem));
  if (const std::string wrong = finish(*body, std::move(fixed)); !wrong.empty()) throw std::runtime_error(wrong);
  return body;
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
