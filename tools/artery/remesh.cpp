// SPDX-License-Identifier: GPL-3.0-or-later
// Isotropic remeshing with sharp rims on CGAL's surface mesh, and the self-intersection test. The only file that needs
// CGAL.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface.h"

namespace insula::artery {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using V = Mesh::Vertex_index;
using H = Mesh::Halfedge_index;
using E = Mesh::Edge_index;
using F = Mesh::Face_index;

double smallest_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto at = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    return std::atan2((q - p).cross(r - p).norm(), (q - p).dot(r - p));
  };
  return std::min({at(a, b, c), at(b, c, a), at(c, a, b)});
}

class Remesher {
 public:
  Remesher(const Surface& s, const RemeshGuide& guide) : guide_(guide) {
    for (const Vec3& p : s.mesh.vertices) m_.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
    patch_ = m_.add_property_map<F, int>("f:patch", -1).first;
    for (std::size_t t = 0; t < s.mesh.triangles.size(); ++t) {
      const auto& tri = s.mesh.triangles[t];
      const F f = m_.add_face(V(unsigned(tri[0])), V(unsigned(tri[1])), V(unsigned(tri[2])));
      if (f == Mesh::null_face()) throw std::runtime_error("the surface is no manifold");
      patch_[f] = s.patch[t];
    }
  }

  void run(int rounds) {
    for (int i = 0; i < rounds; ++i) {
      split_long();
      collapse_short();
      split_chords();
      even_valences();
      relax(3);
      for (const V v : m_.vertices())
        if (!at(v).allFinite())
          throw std::runtime_error(
              "triangles without an area are in the way: make the surface anew from a grid (--rebuild 0.2)");
    }
    for (int i = 0; i < 12; ++i) {
      flip_for_angles();
      improve_angles();
    }
  }

  Surface take(const std::vector<CapPlane>& caps) {
    m_.collect_garbage();
    Surface out;
    out.caps = caps;
    for (const V v : m_.vertices()) out.mesh.vertices.push_back(at(v));
    for (const F f : m_.faces()) {
      const H h = m_.halfedge(f);
      out.mesh.triangles.push_back(
          {int(unsigned(m_.source(h))), int(unsigned(m_.target(h))), int(unsigned(m_.target(m_.next(h))))});
      out.patch.push_back(patch_[f]);
    }
    number_by_use(out.mesh);
    return out;
  }

 private:
  Vec3 at(V v) const {
    const auto& p = m_.point(v);
    return {p.x(), p.y(), p.z()};
  }
  void put(V v, const Vec3& p) { m_.point(v) = Kernel::Point_3(p[0], p[1], p[2]); }
  bool is_rim(H h) const { return patch_[m_.face(h)] != patch_[m_.face(m_.opposite(h))]; }
  double length(H h) const { return (at(m_.target(h)) - at(m_.source(h))).norm(); }
  double wanted(const Vec3& p) const { return guide_.edge_length(p); }

  VertexKind kind(V v) const {
    VertexKind k{patch_[m_.face(m_.halfedge(v))], false};
    for (const H h : CGAL::halfedges_around_target(v, m_)) {
      const int other = patch_[m_.face(h)];
      if (other != k.cap) k.rim = true, k.cap = std::max(k.cap, other);
    }
    return k;
  }
  Vec3 placed(const VertexKind& k, const Vec3& p) const {
    if (k.rim) return guide_.on_rim(k.cap, p);
    return k.cap >= 0 ? guide_.on_cap(k.cap, p) : guide_.on_wall(p);
  }
  std::vector<E> edges() const { return {m_.edges().begin(), m_.edges().end()}; }

  void split(H h) {
    const bool rim = is_rim(h);
    const int left = patch_[m_.face(h)], right = patch_[m_.face(m_.opposite(h))];
    const Vec3 middle = 0.5 * (at(m_.source(h)) + at(m_.target(h)));
    const H fresh = CGAL::Euler::split_edge(h, m_);  // ends at the new vertex
    const V v = m_.target(fresh);
    put(v, placed({std::max(left, right), rim}, middle));
    const H a = CGAL::Euler::split_face(fresh, m_.next(h), m_);
    patch_[m_.face(a)] = patch_[m_.face(m_.opposite(a))] = left;
    const H o = m_.opposite(h);  // ends at the new vertex
    const H b = CGAL::Euler::split_face(o, m_.next(m_.next(o)), m_);
    patch_[m_.face(b)] = patch_[m_.face(m_.opposite(b))] = right;
  }

  void split_long() {
    for (int again = 0; again < 6; ++again) {
      bool any = false;
      for (const E e : edges()) {
        const H h = m_.halfedge(e);
        if (length(h) <= 4.0 / 3 * wanted(0.5 * (at(m_.source(h)) + at(m_.target(h))))) continue;
        split(h);
        any = true;
      }
      if (!any) break;
    }
  }

  /// An edge inside a patch whose ends both lie on the rim would pin a triangle flat against it.
  void split_chords() {
    for (const E e : edges()) {
      const H h = m_.halfedge(e);
      if (!is_rim(h) && kind(m_.source(h)).rim && kind(m_.target(h)).rim) split(h);
    }
  }

  bool turns_over(V moved, V merged, const Vec3& to) const {
    for (const H h : CGAL::halfedges_around_target(moved, m_)) {
      const V a = m_.source(h), b = m_.target(m_.next(h));
      if (a == merged || b == merged) continue;
      const Vec3 before = (at(b) - at(moved)).cross(at(a) - at(moved)), after = (at(b) - to).cross(at(a) - to);
      if (!(before.dot(after) > 0.5 * before.norm() * after.norm()) || after.norm() < 1e-8) return true;
      if ((at(a) - to).norm() > 4.0 / 3 * wanted(0.5 * (at(a) + to))) return true;
    }
    return false;
  }

  void collapse_short() {
    for (int again = 0; again < 4; ++again) {
      bool any = false;
      for (const E e : edges()) {
        if (m_.is_removed(e)) continue;
        const H h = m_.halfedge(e);
        const V a = m_.source(h), b = m_.target(h);
        const Vec3 middle = 0.5 * (at(a) + at(b));
        if (length(h) >= 0.8 * wanted(middle)) continue;
        const VertexKind ka = kind(a), kb = kind(b);
        if (ka.rim && kb.rim && !is_rim(h)) continue;
        if (is_rim(h) && rim_size(h) <= 10) continue;
        Vec3 to;
        if (is_rim(h)) to = placed(ka, middle);
        else if (ka.rim) to = at(a);
        else if (kb.rim) to = at(b);
        else to = placed(ka, middle);
        if (turns_over(a, b, to) || turns_over(b, a, to) || !CGAL::Euler::does_satisfy_link_condition(e, m_)) continue;
        put(CGAL::Euler::collapse_edge(e, m_), to);
        any = true;
      }
      if (!any) break;
    }
  }

  int rim_size(H start) const {
    int n = 0;
    H h = start;
    do {
      ++n;
      H next = m_.next(h);
      while (!is_rim(next)) next = m_.next(m_.opposite(next));
      h = next;
    } while (h != start && n < 1000);
    return n;
  }

  bool can_flip(H h) const {
    if (is_rim(h)) return false;
    const V c = m_.target(m_.next(h)), d = m_.target(m_.next(m_.opposite(h)));
    return c != d && m_.halfedge(c, d) == Mesh::null_halfedge();
  }
  bool flip_keeps_shape(H h) const {
    const Vec3 a = at(m_.source(h)), b = at(m_.target(h)), c = at(m_.target(m_.next(h))),
               d = at(m_.target(m_.next(m_.opposite(h))));
    const Vec3 n1 = (b - a).cross(c - a), n2 = (d - a).cross(b - a), m1 = (d - a).cross(c - a),
               m2 = (c - b).cross(d - b);
    const Vec3 n = n1.normalized() + n2.normalized();
    return m1.norm() > 1e-8 && m2.norm() > 1e-8 && m1.normalized().dot(n) > 1.2 && m2.normalized().dot(n) > 1.2;
  }

  void even_valences() {
    const auto excess = [&](V v) { return int(m_.degree(v)) - 6; };
    for (const E e : edges()) {
      const H h = m_.halfedge(e);
      if (!can_flip(h)) continue;
      const V a = m_.source(h), b = m_.target(h), c = m_.target(m_.next(h)), d = m_.target(m_.next(m_.opposite(h)));
      if (kind(c).rim && kind(d).rim) continue;
      const auto sq = [](int x) { return x * x; };
      const int before = sq(excess(a)) + sq(excess(b)) + sq(excess(c)) + sq(excess(d));
      const int after = sq(excess(a) - 1) + sq(excess(b) - 1) + sq(excess(c) + 1) + sq(excess(d) + 1);
      if (after < before && m_.degree(a) > 4 && m_.degree(b) > 4 && flip_keeps_shape(h)) CGAL::Euler::flip_edge(h, m_);
    }
  }

  Vec3 relaxed(V v, const VertexKind& k) const {
    const Vec3 p = at(v);
    if (k.rim) {
      Vec3 sum = Vec3::Zero();
      for (const H h : CGAL::halfedges_around_target(v, m_))
        if (is_rim(h)) sum += 0.5 * at(m_.source(h));
      return sum;
    }
    Vec3 sum = Vec3::Zero(), normal = Vec3::Zero(), neighbours = Vec3::Zero();
    double weight = 0;
    for (const H h : CGAL::halfedges_around_target(v, m_)) {
      const Vec3 a = at(m_.source(h)), b = at(m_.target(m_.next(h)));
      neighbours += a / double(m_.degree(v));
      const Vec3 twice = (b - p).cross(a - p), centre = (a + b + p) / 3;
      const double l = wanted(centre), w = twice.norm() / (l * l * l);
      sum += w * centre, weight += w, normal += twice;
    }
    if (!(weight > 0)) return neighbours;  // triangles without an area are opened
    const Vec3 n = normal.normalized(), d = sum / weight - p;
    return p + d - d.dot(n) * n;
  }

  void relax(int times) {
    for (int i = 0; i < times; ++i) {
      std::vector<std::pair<V, Vec3>> moves;
      for (const V v : m_.vertices()) {
        const VertexKind k = kind(v);
        moves.emplace_back(v, placed(k, relaxed(v, k)));
      }
      for (const auto& [v, p] : moves) put(v, p);
    }
  }

  double star_angle(V v, const Vec3& p) const {
    double least = std::numbers::pi;
    for (const H h : CGAL::halfedges_around_target(v, m_)) {
      const Vec3 a = at(m_.source(h)), b = at(m_.target(m_.next(h))), old = at(v);
      if ((b - p).cross(a - p).dot((b - old).cross(a - old)) <= 0) return 0;
      least = std::min(least, smallest_angle(p, a, b));
    }
    return least;
  }

  void flip_for_angles() {
    for (const E e : edges()) {
      const H h = m_.halfedge(e);
      if (!can_flip(h) || !flip_keeps_shape(h)) continue;
      const V a = m_.source(h), b = m_.target(h), c = m_.target(m_.next(h)), d = m_.target(m_.next(m_.opposite(h)));
      if (m_.degree(a) <= 4 || m_.degree(b) <= 4 || (kind(c).rim && kind(d).rim)) continue;
      const double before = std::min(smallest_angle(at(a), at(b), at(c)), smallest_angle(at(a), at(b), at(d)));
      const double after = std::min(smallest_angle(at(c), at(d), at(a)), smallest_angle(at(c), at(d), at(b)));
      if (after > before + 1e-6) CGAL::Euler::flip_edge(h, m_);
    }
  }

  void improve_angles() {
    for (const V v : m_.vertices()) {
      const double before = star_angle(v, at(v));
      if (before > 38 * std::numbers::pi / 180) continue;
      const VertexKind k = kind(v);
      const Vec3 target = relaxed(v, k), from = at(v);
      for (const double share : {1.0, 0.5, 0.25, -0.25}) {
        const Vec3 p = placed(k, from + share * (target - from));
        if (star_angle(v, p) > before + 1e-6) {
          put(v, p);
          break;
        }
      }
    }
  }

  RemeshGuide guide_;
  Mesh m_;
  Mesh::Property_map<F, int> patch_;
};

}  // namespace

void remesh(Surface& surface, const RemeshGuide& guide, int rounds) {
  Remesher r(surface, guide);
  r.run(rounds);
  surface = r.take(surface.caps);
}

Quality quality(const TriMesh& mesh) {
  Quality q;
  Mesh m;
  for (const Vec3& p : mesh.vertices) m.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
  q.min_angle_deg = 180, q.shortest = 1e300;
  bool manifold = true;
  for (const auto& t : mesh.triangles) {
    manifold = m.add_face(V(unsigned(t[0])), V(unsigned(t[1])), V(unsigned(t[2]))) != Mesh::null_face() && manifold;
    const Vec3 &a = mesh.vertices[std::size_t(t[0])], &b = mesh.vertices[std::size_t(t[1])],
               &c = mesh.vertices[std::size_t(t[2])];
    const double angle = smallest_angle(a, b, c) * 180 / std::numbers::pi;
    q.min_angle_deg = std::min(q.min_angle_deg, angle);
    q.mean_min_angle_deg += angle / double(mesh.triangles.size());
    for (const double l : {(a - b).norm(), (b - c).norm(), (c - a).norm()})
      q.shortest = std::min(q.shortest, l), q.longest = std::max(q.longest, l);
  }
  q.closed = manifold && CGAL::is_closed(m);
  q.euler = int(m.number_of_vertices()) - int(m.number_of_edges()) + int(m.number_of_faces());
  std::vector<char> seen(m.number_of_faces());
  for (const F start : m.faces()) {
    if (seen[start]) continue;
    ++q.components;
    std::vector<F> stack{start};
    seen[start] = 1;
    while (!stack.empty()) {
      const H h0 = m.halfedge(stack.back());
      stack.pop_back();
      for (const H h : CGAL::halfedges_around_face(h0, m)) {
        const F f = m.face(m.opposite(h));
        if (f != Mesh::null_face() && !seen[f]) seen[f] = 1, stack.push_back(f);
      }
    }
  }
  q.self_intersecting = !manifold || CGAL::Polygon_mesh_processing::does_self_intersect(m);
  return q;
}

}  // namespace insula::artery
