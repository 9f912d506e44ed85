// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the state of a simulation is sound: elements inverted or collapsed, tools inside of bodies, numbers that are
// not finite.
#pragma once
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "core/collision/search/collision_mesh.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/sim/simulation.h"
#include "plugins/contact/contact.h"

namespace insula::test {

/// The worst value, and the object that has it.
struct Worst {
  double value = 0;
  std::string whose = "-";
  void most(double v, const std::string& w) {
    if (v > value || std::isnan(v)) {
      value = v;
      whose = w;
    }
  }
  void least(double v, const std::string& w) {
    if (v < value || std::isnan(v)) {
      value = v;
      whose = w;
    }
  }
};

/// State of all bodies; 1 if there is none of a kind.
struct ElementState {
  int inverted = 0;      ///< tetrahedra
  Worst volume{1, "-"};  ///< least volume of a tetrahedron over its volume at rest
  Worst area{1, "-"};    ///< least area of a wall's triangle over its area at rest
  Worst inside{1, "-"};  ///< least volume that a closed wall encloses, over that at rest; below 0: turned inside out
};

inline Vec3 node(const DeformableBody& b, int i) { return b.q().segment<3>(3 * i); }

inline ElementState look_at_elements(const Simulation& s) {
  ElementState out;
  for (const Body* body : s.bodies()) {
    if (const auto* soft = dynamic_cast<const SoftBody*>(body)) {
      const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        return (b - a).cross(c - a).dot(d - a);
      };
      const auto& rest = soft->rest();
      for (std::size_t i = 0; i < rest.tets.size(); ++i) {
        const auto& t = rest.tets[i];
        const double now = volume(node(*soft, t[0]), node(*soft, t[1]), node(*soft, t[2]), node(*soft, t[3]));
        const auto at = [&](int k) { return rest.nodes[std::size_t(t[std::size_t(k)])]; };
        if (!(now > 0)) ++out.inverted;
        out.volume.least(now / volume(at(0), at(1), at(2), at(3)), soft->id + " " + std::to_string(i));
      }
    } else if (const auto* shell = dynamic_cast<const ShellBody*>(body)) {
      const auto& rest = shell->rest_nodes();
      for (std::size_t i = 0; i < shell->wall_triangles().size(); ++i) {
        const auto& t = shell->wall_triangles()[i];
        const double now =
            (node(*shell, t[1]) - node(*shell, t[0])).cross(node(*shell, t[2]) - node(*shell, t[0])).norm();
        const Vec3 a = rest[std::size_t(t[0])], b = rest[std::size_t(t[1])], c = rest[std::size_t(t[2])];
        out.area.least(now / (b - a).cross(c - a).norm(), shell->id + " " + std::to_string(i));
      }
      const Vec3 origin = rest[0];
      double now = 0, then = 0;
      for (const auto& t : shell->rest().triangles) {
        now += (node(*shell, t[0]) - origin).dot((node(*shell, t[1]) - origin).cross(node(*shell, t[2]) - origin));
        const Vec3 a = rest[std::size_t(t[0])] - origin, b = rest[std::size_t(t[1])] - origin,
                   c = rest[std::size_t(t[2])] - origin;
        then += a.dot(b.cross(c));
      }
      if (!shell->model().caps.empty()) out.inside.least(now / then, shell->id);
    }
  }
  return out;
}

inline bool all_finite(const Simulation& s) {
  std::vector<double> state;
  for (const Body* b : s.bodies())
    if (const auto* moving = dynamic_cast<const DynamicBody*>(b)) moving->append_state(state);
  for (double d : state)
    if (!std::isfinite(d)) return false;
  return true;
}

/// Depth of tools and clips in the surfaces with which they have contact.
class DepthGauge {
 public:
  explicit DepthGauge(const Simulation& s) {
    for (const Constraint* c : s.constraints()) {
      const auto* contact = dynamic_cast<const Contact*>(c);
      if (!contact) continue;
      for (const Contact::Pair& p : contact->pairs())
        if (p.tool_a && p.b) {
          pairs_.push_back(&p);
          if (!meshes_.count(p.b)) add(p.b);
        }
    }
  }
  /// Largest depth of a core (the piece without its rounding) behind a surface, m, for the tools or the clips.
  Worst deepest(bool clips) {
    for (auto& [surface, m] : meshes_) {
      surface->update();
      m->mesh.update(surface->positions(), {});
    }
    Worst out;
    for (const Contact::Pair* p : pairs_) {
      if (!p->active() || p->tool_a->implant() != clips) continue;
      const Closed& m = *meshes_.at(p->b);
      const Pose pose = p->tool_a->link_pose(p->link_a);
      for (const RoundedPiece& piece : p->pieces_a) {
        const auto look = [&](const Vec3& local) {
          const double depth = m.depth(pose.apply(local));
          if (depth > out.value) out.most(depth, p->tool_a->id + " in " + p->b->id);
        };
        // A flat blade may be pierced between its corners, so all lines between them are tested.
        for (std::size_t a = 0; a < piece.core.size(); ++a) {
          look(piece.core[a]);
          for (std::size_t b = 0; b < a; ++b) {
            const Vec3 edge = piece.core[a] - piece.core[b];
            const int n = int(std::ceil(edge.norm() / 0.8e-3));
            for (int i = 1; i < n; ++i) look(piece.core[b] + double(i) / n * edge);
          }
        }
      }
    }
    return out;
  }

 private:
  struct Closed {
    CollisionMesh mesh;
    std::set<std::pair<int, int>> border;  ///< edges of one triangle
    std::set<int> rim;                     ///< their vertices
    double depth(const Vec3& p) const {
      const NearestPoint e = mesh.nearest(p, 0, 15e-3);
      if (e.triangle < 0 || !e.behind) return 0;
      // Beyond the border of an open surface, front and back are undefined.
      const TriangleFeature f = feature_of(e.bary);
      const auto& t = mesh.triangle(e.triangle);
      const int a = t[std::size_t(f.corner)], b = t[std::size_t((f.corner + 1) % 3)];
      if (f.kind == FeatureKind::vertex && rim.count(a)) return 0;
      if (f.kind == FeatureKind::edge && border.count({std::min(a, b), std::max(a, b)})) return 0;
      return e.distance;
    }
  };
  void add(Surface* s) {
    auto m = std::make_unique<Closed>();
    m->mesh.build(s->rest().vertices, s->triangles());
    std::map<std::pair<int, int>, int> uses;
    for (const auto& t : s->triangles())
      for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    for (const auto& [edge, n] : uses)
      if (n == 1) {
        m->border.insert(edge);
        m->rim.insert(edge.first);
        m->rim.insert(edge.second);
      }
    meshes_[s] = std::move(m);
  }
  std::vector<const Contact::Pair*> pairs_;
  std::map<Surface*, std::unique_ptr<Closed>> meshes_;  ///< looked up, and maxima taken: their order tells nothing
};

}  // namespace insula::test
