// SPDX-License-Identifier: GPL-3.0-or-later
// Walls for tests: sheets, cylinders and spheres of triangles, one shell body with membranes, stepped by itself.
#pragma once
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "core/base/random.h"
#include "core/mechanics/shell_body.h"
#include "core/testing/example.h"
#include "core/testing/single_body.h"

namespace insula::test {

struct Wall {
  double thickness = 1e-3, young = 1e6, poisson = 0.3, density = 1000, added_mass = 0, mass_damping = 0,
         stiffness_damping = 0;
  std::string regions = {};
  std::string spots = {};
  double spot_radius = 1e-3;
};

inline void add_membrane(ShellBody& body, const Wall& w) {
  auto m = builtin().create("membrane");
  set_quantity(*m, "thickness", w.thickness);
  set_quantity(*m, "young", w.young);
  set_quantity(*m, "poisson", w.poisson);
  set_quantity(*m, "density", w.density);
  set_quantity(*m, "added_mass", w.added_mass);
  set_quantity(*m, "mass_damping", w.mass_damping);
  set_quantity(*m, "stiffness_damping", w.stiffness_damping);
  dynamic_cast<Param<std::string>&>(*m->find_param("regions")).set(w.regions);
  dynamic_cast<Param<std::string>&>(*m->find_param("spots")).set(w.spots);
  set_quantity(*m, "spot_radius", w.spot_radius);
  // A linear problem is then solved in one step.
  m->find_param("tangent")->assign("patches", {});
  m->id = "membrane#" + std::to_string(body.children.size() + 1);
  m->parent = &body;
  body.children.push_back(std::move(m));
}

inline std::unique_ptr<ShellBody> shell(TriMesh mesh, const Wall& w, std::function<bool(const Vec3&)> fixed = nullptr) {
  auto body = std::make_unique<ShellBody>();
  body->set_mesh(std::move(mesh));
  add_membrane(*body, w);
  if (const std::string wrong = finish(*body, std::move(fixed)); !wrong.empty()) throw std::runtime_error(wrong);
  return body;
}

/// Elastic force on the nodes at positions x.
inline VecX elastic_force(DeformableBody& body, const VecX& x) {
  VecX f = VecX::Zero(x.size());
  for (ForceModel* m : body.forces()) m->linearise(x.data(), f.data(), nullptr, 0, Tangent::system);
  return f;
}

/// Pressure on the deformed wall: the gradient of the volume times p.
inline void press(ShellBody& body, double p, const VecX& x) {
  body.external.setZero();
  for (const auto& t : body.wall_triangles()) {
    const auto at = [&](int k) -> Vec3 { return x.segment<3>(3 * t[std::size_t(k)]); };
    for (int k = 0; k < 3; ++k)
      body.external.segment<3>(3 * t[std::size_t(k)]) += p / 6 * at((k + 1) % 3).cross(at((k + 2) % 3));
  }
}

/// How a rectangle is meshed: all diagonals in one direction, criss-cross, or all in one direction with perturbed nodes
/// (not Delaunay).
enum class Cut { one_way, criss_cross, shaken };

/// Parameters (u, v) in [0, 1]^2 on an nu x nv grid, mapped by `place`. `shake` is in parts of a cell; rims stay
/// straight.
inline TriMesh sheet(int nu, int nv, Cut cut, const std::function<Vec3(double, double)>& place, double shake = 0.25,
                     bool around = false) {
  TriMesh m;
  Random random(7);
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i < (around ? nu : nu + 1); ++i) {
      double u = double(i) / nu, v = double(j) / nv;
      if (cut == Cut::shaken && j > 0 && j < nv && (around || (i > 0 && i < nu))) {
        u += shake * random.uniform(-1, 1) / nu;
        v += shake * random.uniform(-1, 1) / nv;
      }
      m.vertices.push_back(place(u, v));
    }
  const int row = around ? nu : nu + 1;
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const int k = (i + 1) % row, a = j * row + i, b = j * row + k, c = a + row, d = b + row;
      if (cut == Cut::criss_cross && (i + j) % 2 == 0) {
        m.triangles.push_back({a, b, c});
        m.triangles.push_back({b, d, c});
      } else {
        m.triangles.push_back({a, b, d});
        m.triangles.push_back({a, d, c});
      }
    }
  return m;
}

inline TriMesh plate(double lx, double ly, int nx, int ny, Cut cut) {
  return sheet(nx, ny, cut, [=](double u, double v) { return Vec3(lx * u, ly * v, 0); });
}

inline TriMesh cylinder(double radius, double length, int around, int along, Cut cut = Cut::one_way) {
  return sheet(
      around, along, cut,
      [=](double u, double v) {
        const double a = 2 * std::numbers::pi * u;
        return Vec3(radius * std::cos(a), radius * std::sin(a), length * v);
      },
      0.25, true);
}

/// An icosahedron on a sphere. Each triangle is divided into four, `times` times.
inline TriMesh icosphere(double radius, int times) {
  TriMesh m;
  const double g = 0.5 * (1 + std::sqrt(5.0));
  for (const double s : {1.0, -1.0})
    for (const double t : {g, -g})
      for (const Vec3& x : {Vec3(0, s, t), Vec3(s, t, 0), Vec3(t, 0, s)}) m.vertices.push_back(x);
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      for (int k = 0; k < 12; ++k) {
        const Vec3 &a = m.vertices[std::size_t(i)], &b = m.vertices[std::size_t(j)], &c = m.vertices[std::size_t(k)];
        const bool sides = std::abs((b - a).norm() - 2) < 1e-9 && std::abs((c - b).norm() - 2) < 1e-9 &&
                           std::abs((a - c).norm() - 2) < 1e-9;
        if (i < j && i < k && sides && (b - a).cross(c - a).dot(a) > 0) m.triangles.push_back({i, j, k});
      }
  for (int n = 0; n < times; ++n) {
    std::map<std::pair<int, int>, int> middle;
    const auto between = [&](int i, int j) {
      const auto [it, fresh] = middle.try_emplace(std::minmax(i, j), int(m.vertices.size()));
      if (fresh) m.vertices.push_back(0.5 * (m.vertices[std::size_t(i)] + m.vertices[std::size_t(j)]));
      return it->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& t : m.triangles) {
      const int a = between(t[0], t[1]), b = between(t[1], t[2]), c = between(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    m.triangles = std::move(finer);
  }
  for (Vec3& x : m.vertices) x *= radius / x.norm();
  return m;
}

}  // namespace insula::test
