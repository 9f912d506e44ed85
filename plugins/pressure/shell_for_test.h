// SPDX-License-Identifier: GPL-3.0-or-later
// Shells for tests: closed tubes and spheres with regions and centrelines, and a wall of springs whose anchor points a
// test may move.
#pragma once
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "core/testing/block_mesh.h"

namespace insula::test {

inline constexpr double mmHg = 133.322387415;  ///< Pa

/// A spring from every node to its anchor, the rest position unless a test moves it. The mass is so small that a step
/// is static.
class TestWall final : public ForceModel {
 public:
  Param<Stiffness> stiffness{
      this, {.name = "stiffness", .fallback = "50 N/m", .min = "0 N/m", .max = "1e9 N/m", .doc = "of a node's spring"}};
  std::vector<Vec3> place;

  void attach(PrepareContext&, DeformableBody& body) override { place = body.rest_nodes(); }
  void couplings(std::vector<std::pair<int, int>>&, Tangent) const override {}
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override {
    for (int b : free_of_node) slot_.push_back(b < 0 ? -1 : a.diagonal(b));
  }
  void add_mass(std::vector<double>& mass, std::vector<double>&) const override {
    for (double& m : mass) m += 1e-12;
  }
  void linearise(const double* x, double* force, BlockMatrix* k, double, Tangent) override {
    for (std::size_t i = 0; i < place.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) force[3 * i + c] -= stiffness() * (x[3 * i + c] - place[i][Eigen::Index(c)]);
      if (k && slot_[i] >= 0)
        for (int c = 0; c < 3; ++c) k->block(slot_[i])[4 * c] += stiffness();
    }
  }
  double energy(const double* x) override {
    double e = 0;
    for (std::size_t i = 0; i < place.size(); ++i)
      e += 0.5 * stiffness() * (Eigen::Map<const Vec3>(x + 3 * i) - place[i]).squaredNorm();
    return e;
  }

 private:
  std::vector<int> slot_;
};

/// Every built-in element and <test_wall>.
inline const Registry& with_test_wall() {
  static const Registry registry = [] {
    Registry r;
    register_builtin(r);
    r.add<TestWall>("test_wall", Kind::force_model, "springs for tests");
    return r;
  }();
  return registry;
}

/// A closed tube along z from `low`, `around` corners, closed by flat ends.
inline TriMesh tube(const Vec3& low, double radius, double length, int around, int along) {
  TriMesh m;
  for (int k = 0; k <= along; ++k)
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * (i + 0.31) / around;
      m.vertices.push_back(low + Vec3(radius * std::cos(a), radius * std::sin(a), length * k / along));
    }
  const int bottom = int(m.vertices.size()), top = bottom + 1;
  m.vertices.push_back(low);
  m.vertices.push_back(low + Vec3(0, 0, length));
  for (int i = 0; i < around; ++i) {
    const int j = (i + 1) % around;
    for (int k = 0; k < along; ++k) {
      const int a = k * around + i, b = k * around + j, c = a + around, d = b + around;
      m.triangles.push_back({a, b, d});
      m.triangles.push_back({a, d, c});
    }
    m.triangles.push_back({bottom, j, i});
    m.triangles.push_back({top, along * around + i, along * around + j});
  }
  return m;
}

/// An octahedron subdivided `levels` times, on a sphere.
inline TriMesh ball(const Vec3& centre, double radius, int levels) {
  TriMesh m;
  m.vertices = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)};
  for (int i = 0; i < 4; ++i) {
    m.triangles.push_back({i, (i + 1) % 4, 4});
    m.triangles.push_back({(i + 1) % 4, i, 5});
  }
  for (int l = 0; l < levels; ++l) {
    std::map<std::pair<int, int>, int> middle;
    const auto mid = [&](int a, int b) {
      const auto [at, added] = middle.try_emplace({std::min(a, b), std::max(a, b)}, int(m.vertices.size()));
      if (added) m.vertices.push_back((m.vertices[std::size_t(a)] + m.vertices[std::size_t(b)]).normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> fine;
    for (const auto& t : m.triangles) {
      const int a = mid(t[0], t[1]), b = mid(t[1], t[2]), c = mid(t[2], t[0]);
      fine.insert(fine.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    m.triangles = fine;
  }
  for (Vec3& v : m.vertices) v = centre + radius * v;
  return m;
}

/// A vessel of separate closed parts, each one region with one centreline. The names of the ends join them. Written as
/// vessel.json and wall.ply below `meshes`.
struct TestVessel {
  TriMesh wall;
  nlohmann::json json = {{"unit", "mm"},
                         {"regions", nlohmann::json::array()},
                         {"vertex_region", nlohmann::json::array()},
                         {"caps", nlohmann::json::array()},
                         {"centrelines", nlohmann::json::array()}};
  /// A tube along z; ends whose names end in "let" become caps.
  void add_tube(const std::string& region, const std::string& from, const std::string& to, const Vec3& low,
                double radius, double length, int around = 12, int along = 12) {
    const TriMesh m = tube(low, radius, length, around, along);
    const int v0 = int(wall.vertices.size()), t0 = int(wall.triangles.size());
    wall.vertices.insert(wall.vertices.end(), m.vertices.begin(), m.vertices.end());
    for (const auto& t : m.triangles) wall.triangles.push_back({t[0] + v0, t[1] + v0, t[2] + v0});
    const std::size_t r = json["regions"].size();
    json["regions"].push_back(region);
    for (std::size_t i = 0; i < m.vertices.size(); ++i) json["vertex_region"].push_back(r);
    for (const bool top : {false, true}) {
      const std::string& name = top ? to : from;
      if (!name.ends_with("let")) continue;
      nlohmann::json cap = {{"name", name}, {"triangles", nlohmann::json::array()}};
      for (std::size_t t = 0; t < m.triangles.size(); ++t)
        for (int v : m.triangles[t])
          if (v == int(m.vertices.size()) - (top ? 1 : 2)) cap["triangles"].push_back(t0 + int(t));
      json["caps"].push_back(cap);
    }
    const auto point = [&](double z) { return nlohmann::json{1000 * low.x(), 1000 * low.y(), 1000 * (low.z() + z)}; };
    json["centrelines"].push_back({{"name", region},
                                   {"region", region},
                                   {"from", from},
                                   {"to", to},
                                   {"points", {point(0), point(0.3 * length), point(length)}},
                                   {"radius", {1000 * radius, 1000 * radius, 1000 * radius}}});
  }
  void write(const SceneFolder& folder) const {
    folder.write("meshes/vessel.json", json.dump());
    std::string ply = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        wall.vertices.size(), wall.triangles.size());
    for (const Vec3& v : wall.vertices)
      ply += fmt::format("{:.17g} {:.17g} {:.17g}\n", 1000 * v.x(), 1000 * v.y(), 1000 * v.z());
    for (const auto& t : wall.triangles) ply += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    folder.write("meshes/wall.ply", ply);
  }
};

/// A loaded test scene and the messages of its loading.
struct TestScene {
  SceneFolder folder;
  std::unique_ptr<Simulation> s;
  std::string messages;
  void load(const std::string& xml) {
    auto r = load_simulation_text(xml, folder.path() / "scene.xml", with_test_wall(), 1);
    s = std::move(r.simulation);
    messages = r.diagnostics.format();
  }
  ShellBody& shell(const char* id = "artery") const { return *s->scene().find_as<ShellBody>(id); }
  TestWall& wall(const char* id = "artery") const { return *shell(id).children_of<TestWall>().front(); }
  template <class T>
  T& get(const char* id) const {
    return *s->scene().find_as<T>(id);
  }
  void run(int n) const {
    for (int i = 0; i < n; ++i) s->step();
  }
};

}  // namespace insula::test
