// SPDX-License-Identifier: GPL-3.0-or-later
// Embedding of points in a tetrahedral mesh by barycentric coordinates.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/input_error.h"
#include "core/model/geometry/box_tree.h"
#include "core/model/geometry/triangle_distance.h"
#include "core/model/mesh.h"

namespace insula {
namespace {

// Weights of extrapolated points stay within [-limit, 1 + limit]: beyond that a node's motion would be magnified.
constexpr double extrapolation_limit = 1.0;
// A point this little outside (as a weight) counts as inside: rounding at shared faces.
constexpr double inside_tolerance = 1e-10;

using Weights = std::array<double, 4>;

Weights barycentric(const TetMesh& mesh, int tet, const Vec3& p) {
  const auto& t = mesh.tets[std::size_t(tet)];
  const Vec3& a = mesh.nodes[std::size_t(t[0])];
  const Vec3 b = mesh.nodes[std::size_t(t[1])] - a, c = mesh.nodes[std::size_t(t[2])] - a,
             d = mesh.nodes[std::size_t(t[3])] - a;
  const Vec3 r = p - a;
  const Vec3 cd = c.cross(d);
  const double volume6 = b.dot(cd);
  const double wb = r.dot(cd) / volume6, wc = b.dot(r.cross(d)) / volume6, wd = b.dot(c.cross(r)) / volume6;
  return {1 - wb - wc - wd, wb, wc, wd};
}

double least(const Weights& w) { return std::min({w[0], w[1], w[2], w[3]}); }

/// Moves `w` towards the weights `near` of the nearest point until it is within the limit; the sum stays 1.
Weights drawn_in(const Weights& near, const Weights& w) {
  double s = 1;
  for (int i = 0; i < 4; ++i) {
    const double step = w[i] - near[i];
    if (near[i] + step > 1 + extrapolation_limit) s = std::min(s, (1 + extrapolation_limit - near[i]) / step);
    if (near[i] + step < -extrapolation_limit) s = std::min(s, (-extrapolation_limit - near[i]) / step);
  }
  if (s == 1) return w;
  Weights out;
  for (int i = 0; i < 4; ++i) out[i] = near[i] + s * (w[i] - near[i]);
  return out;
}

const Vec3& node(const TetMesh& mesh, int i) { return mesh.nodes[std::size_t(i)]; }

BoxTree tree_of_tetrahedra(const TetMesh& mesh) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.tets.size());
  for (const auto& t : mesh.tets) {
    Box box;
    for (int i : t) box.extend(node(mesh, i));
    const Vec3 margin = Vec3::Constant(1e-9 * box.diagonal().norm());
    boxes.emplace_back(box.min() - margin, box.max() + margin);
  }
  return BoxTree(boxes);
}

/// The boundary's triangles, each with its tetrahedron.
class Boundary {
 public:
  explicit Boundary(const TetMesh& mesh) : mesh_(mesh), triangles_(boundary_triangles(mesh)) {
    // boundary_triangles() keeps the order of tetrahedra.
    owner_.reserve(triangles_.size());
    std::vector<Box> boxes;
    boxes.reserve(triangles_.size());
    std::size_t t = 0;
    for (const auto& triangle : triangles_) {
      while (!holds(t, triangle)) ++t;
      owner_.push_back(int(t));
      Box box;
      for (int i : triangle) box.extend(node(mesh, i));
      boxes.push_back(box);
    }
    tree_.emplace(boxes);
  }
  /// Finds the triangle nearest to p.
  int nearest(const Vec3& p) const {
    return tree_->nearest(p, [&](int item) { return (nearest_on(item, p) - p).squaredNorm(); });
  }
  Vec3 nearest_on(int triangle, const Vec3& p) const {
    const auto& f = triangles_[std::size_t(triangle)];
    return nearest_on_triangle(p, node(mesh_, f[0]), node(mesh_, f[1]), node(mesh_, f[2]));
  }
  int owner(int triangle) const { return owner_[std::size_t(triangle)]; }

 private:
  bool holds(std::size_t tet, const std::array<int, 3>& triangle) const {
    return std::all_of(triangle.begin(), triangle.end(), [&](int i) {
      return std::find(mesh_.tets[tet].begin(), mesh_.tets[tet].end(), i) != mesh_.tets[tet].end();
    });
  }

  const TetMesh& mesh_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> owner_;
  std::optional<BoxTree> tree_;
};

/// Finds the tetrahedron that contains p, and p's weights in it; -1 if p is outside of all.
int tetrahedron_at(const TetMesh& mesh, const BoxTree& tets, const Vec3& p, Weights& weights) {
  int best = -1;
  double best_least = -inside_tolerance;
  tets.containing(p, [&](int tet) {
    const Weights w = barycentric(mesh, tet, p);
    const double l = least(w);
    if (l > best_least || (l == best_least && tet < best)) best = tet, weights = w, best_least = l;
    return l > 0;  // strictly inside: no other tetrahedron of a valid mesh can contain it
  });
  return best;
}

}  // namespace

Embedding embed(const TetMesh& mesh, const std::vector<Vec3>& points) {
  if (mesh.tets.empty()) throw InputError("points cannot be embedded in a mesh without tetrahedra");
  const BoxTree tets = tree_of_tetrahedra(mesh);
  const Boundary boundary(mesh);
  Embedding out;
  out.nodes.reserve(points.size());
  out.weights.reserve(points.size());
  for (const Vec3& p : points) {
    if (!p.allFinite()) throw InputError("a point to embed is not finite");
    Weights weights{};
    int best = tetrahedron_at(mesh, tets, p, weights);
    if (best < 0) {
      const int k = boundary.nearest(p);
      const Vec3 foot = boundary.nearest_on(k, p);
      best = boundary.owner(k);
      weights = drawn_in(barycentric(mesh, best, foot), barycentric(mesh, best, p));
      out.outside_m = std::max(out.outside_m, (p - foot).norm());
    }
    out.nodes.push_back(mesh.tets[std::size_t(best)]);
    out.weights.push_back(weights);
  }
  return out;
}

}  // namespace insula
