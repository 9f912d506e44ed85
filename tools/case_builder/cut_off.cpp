// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/openings.h"

namespace insula::case_builder {
namespace {

using Edge = std::pair<int, int>;

/// A closed line of triangles that a plane crosses, and where it crosses their edges.
struct Ring {
  std::vector<int> triangles;
  std::vector<Vec3> points;
  Vec3 centre = Vec3::Zero();
};

class Cutter {
 public:
  Cutter(const TriMesh& m, const Vec3& point, const Vec3& normal) : m_(m) {
    for (const Vec3& p : m.vertices) {
      const double h = (p - point).dot(normal);
      over_.push_back(std::abs(h) < 1e-9 ? 1e-9 : h);
    }
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) left_[{m.triangles[t][k], m.triangles[t][(k + 1) % 3]}] = int(t);
  }
  bool beyond(int v) const { return over_[std::size_t(v)] > 0; }
  double share(int a, int b) const { return over_[std::size_t(a)] / (over_[std::size_t(a)] - over_[std::size_t(b)]); }
  Vec3 crossing(int a, int b) const {
    if (a > b) std::swap(a, b);
    return m_.vertices[std::size_t(a)] + share(a, b) * (m_.vertices[std::size_t(b)] - m_.vertices[std::size_t(a)]);
  }
  /// From triangle to triangle, over the edges that go from before the plane to beyond it, seen from inside of each.
  std::vector<Ring> rings() const {
    std::vector<Ring> out;
    std::vector<char> done(m_.triangles.size());
    for (std::size_t start = 0; start < done.size(); ++start) {
      Ring ring;
      for (int t = int(start); t >= 0 && !done[std::size_t(t)];) {
        const auto& tri = m_.triangles[std::size_t(t)];
        int next = -1;
        for (std::size_t k = 0; k < 3; ++k) {
          const int a = tri[k], b = tri[(k + 1) % 3];
          if (beyond(a) || !beyond(b)) continue;
          ring.points.push_back(crossing(a, b));
          const auto at = left_.find({b, a});
          next = at == left_.end() ? -1 : at->second;
        }
        if (ring.points.size() == ring.triangles.size()) break;  // not crossed
        done[std::size_t(t)] = 1;
        ring.triangles.push_back(t);
        t = next;
      }
      if (ring.triangles.size() < 3) continue;
      double whole = 0;
      for (std::size_t k = 0; k < ring.points.size(); ++k) {
        const Vec3 &a = ring.points[k], &b = ring.points[(k + 1) % ring.points.size()];
        ring.centre += (b - a).norm() * 0.5 * (a + b), whole += (b - a).norm();
      }
      ring.centre /= whole;
      out.push_back(std::move(ring));
    }
    return out;
  }
  /// Triangles that are connected with the far side of the ring without its triangles; false if they reach its near
  /// side too.
  bool far_side(const Ring& ring, std::vector<char>& far) const {
    std::vector<char> in_ring(m_.triangles.size());
    for (const int t : ring.triangles) in_ring[std::size_t(t)] = 1;
    far.assign(m_.triangles.size(), 0);
    std::vector<int> list, near;
    for (const int t : ring.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = m_.triangles[std::size_t(t)][k], b = m_.triangles[std::size_t(t)][(k + 1) % 3];
        const auto at = left_.find({b, a});
        if (at == left_.end() || in_ring[std::size_t(at->second)] || beyond(a) != beyond(b)) continue;
        if (!beyond(a)) near.push_back(at->second);
        else if (!far[std::size_t(at->second)]) far[std::size_t(at->second)] = 1, list.push_back(at->second);
      }
    for (std::size_t i = 0; i < list.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& tri = m_.triangles[std::size_t(list[i])];
        const auto at = left_.find({tri[(k + 1) % 3], tri[k]});
        if (at == left_.end() || in_ring[std::size_t(at->second)] || far[std::size_t(at->second)]) continue;
        far[std::size_t(at->second)] = 1, list.push_back(at->second);
      }
    return std::none_of(near.begin(), near.end(), [&](int t) { return far[std::size_t(t)]; });
  }

 private:
  const TriMesh& m_;
  std::vector<double> over_;
  std::map<Edge, int> left_;
};

/// The part of the surface in front of the plane, with its new rim.
class Remains {
 public:
  Remains(const artery::Surface& s, const Cutter& cutter) : s_(s), cutter_(cutter), to_(s.caps.size(), -1) {
    out.mesh.vertices = s.mesh.vertices;
  }
  artery::Surface out;
  std::vector<Edge> rim;  ///< edges opposite to the wall's direction

  void keep(std::size_t t) { add(s_.mesh.triangles[t], s_.patch[t]); }
  void cut(std::size_t t) {
    const auto tri = s_.mesh.triangles[t];
    std::vector<int> polygon;
    int leaves = -1, enters = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = tri[k], b = tri[(k + 1) % 3];
      if (!cutter_.beyond(a)) polygon.push_back(a);
      if (cutter_.beyond(a) == cutter_.beyond(b)) continue;
      const int x = crossing(a, b);
      polygon.push_back(x);
      (cutter_.beyond(a) ? enters : leaves) = x;
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) add({polygon[0], polygon[k], polygon[k + 1]}, s_.patch[t]);
    rim.emplace_back(enters, leaves);  // the wall's edge is leaves -> enters
  }
  /// Closes the rim with a fan of triangles around `centre`. Returns the fan's area along n, mm2.
  double close(const Vec3& centre, const Vec3& n) {
    const int hub = int(out.mesh.vertices.size()), cap = int(out.caps.size());
    out.mesh.vertices.push_back(centre);
    double size = 0;
    for (const auto& [a, b] : rim) {
      size +=
          0.5 * (out.mesh.vertices[std::size_t(a)] - centre).cross(out.mesh.vertices[std::size_t(b)] - centre).dot(n);
      out.mesh.triangles.push_back({a, b, hub});
      out.patch.push_back(cap);
    }
    return size;
  }

 private:
  void add(const std::array<int, 3>& t, int patch) {
    if (patch >= 0 && to_[std::size_t(patch)] < 0)
      to_[std::size_t(patch)] = int(out.caps.size()), out.caps.push_back(s_.caps[std::size_t(patch)]);
    out.mesh.triangles.push_back(t);
    out.patch.push_back(patch < 0 ? -1 : to_[std::size_t(patch)]);
  }
  int crossing(int a, int b) {
    const auto [at, fresh] = made_.emplace(std::minmax(a, b), int(out.mesh.vertices.size()));
    if (fresh) out.mesh.vertices.push_back(cutter_.crossing(a, b));
    return at->second;
  }

  const artery::Surface& s_;
  const Cutter& cutter_;
  std::vector<int> to_;  ///< new number of each cap, -1: none yet
  std::map<Edge, int> made_;
};

}  // namespace

void cut_off(artery::Surface& s, const Vec3& point, const Vec3& normal, const std::string& name) {
  const Vec3 n = normal.normalized();
  const Cutter cutter(s.mesh, point, n);
  const std::string where = fmt::format("({:.1f}, {:.1f}, {:.1f})", point.x(), point.y(), point.z());
  std::vector<Ring> rings = cutter.rings();
  if (rings.empty()) throw InputError("the plane at " + where + " does not meet the vessel");
  const Ring ring = *std::min_element(rings.begin(), rings.end(), [&](const Ring& a, const Ring& b) {
    return (a.centre - point).norm() < (b.centre - point).norm();
  });
  std::vector<char> far;
  if (!cutter.far_side(ring, far))
    throw InputError("the plane at " + where +
                     " does not part the vessel in two; move it along the vessel, to where that is a single tube");
  std::vector<char> in_ring(s.patch.size());
  for (const int t : ring.triangles) in_ring[std::size_t(t)] = 1;
  Remains remains(s, cutter);
  for (std::size_t t = 0; t < s.patch.size(); ++t) {
    if (far[t]) continue;
    if (in_ring[t]) remains.cut(t);
    else remains.keep(t);
  }
  const double size = remains.close(ring.centre, n);
  if (!(size > 0)) throw InputError("the plane at " + where + " meets the vessel too flatly to cut it");
  remains.out.caps.push_back({name, ring.centre, n, std::sqrt(size / std::numbers::pi)});
  s = std::move(remains.out);
  artery::number_by_use(s.mesh);
}

}  // namespace insula::case_builder
