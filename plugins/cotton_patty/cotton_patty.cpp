// SPDX-License-Identifier: GPL-3.0-or-later
/*
# cotton_patty

A moist cotton patty that protects tissue, such as the cortex below a retractor's blade. It has a marker for X-rays and
a thread that leaves the field, so that none is forgotten.

    <cotton_patty id="patty" on="temporal_surface" centre="62 17 -3 mm" along="1 0 0" out="0 0.6 0.8" thread="20 5 5
mm"/>

It is laid on along `-out` while the tissue is at rest. A point of the cloth lies where its line along `-out` meets the
surface. Over a groove the cloth is stretched: its height is at least the mean of that of its neighbours. From then on
each of its points follows the triangle below it:

    x = sum_k b_k x_k + c

with the barycentric coordinates b and the offset c of that moment. The cloth is drawn. It carries no load, and tools
pass through it: a wet patty of 0.5 mm is much softer than the tissue below it.
*/
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/collision/search/aabb_tree.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

class CottonPatty final : public Constraint {
 public:
  static constexpr std::string_view kind_name = "cotton_patty";
  static constexpr int across = 9, lengthwise = 17;  ///< points of the cloth
  static constexpr int thread_points = 12;

  Ref<Surface> on{this, {.name = "on", .doc = "surface that it lies on"}};
  Param<Vec<Length>> centre{this, {.name = "centre", .doc = "near the surface at rest, scene frame"}};
  Param<Vec<Scalar>> along{this, {.name = "along", .fallback = "1 0 0", .doc = "direction of its long side"}};
  Param<Vec<Scalar>> out{this, {.name = "out", .fallback = "0 0 1", .doc = "out of the tissue"}};
  Param<Length> length{
      this, {.name = "length", .fallback = "16 mm", .min = "2 mm", .max = "80 mm", .doc = "of its long side"}};
  Param<Length> width{
      this, {.name = "width", .fallback = "10 mm", .min = "2 mm", .max = "80 mm", .doc = "of its short side"}};
  Param<Length> thickness{
      this, {.name = "thickness", .fallback = "0.5 mm", .min = "0.1 mm", .max = "3 mm", .doc = "of the moist cloth"}};
  Param<Length> reach{this,
                      {.name = "reach",
                       .fallback = "4 mm",
                       .min = "0.5 mm",
                       .max = "20 mm",
                       .doc = "how far above and below its centre the surface is looked for"}};
  Param<Vec<Length>> thread{this,
                            {.name = "thread",
                             .fallback = "0 0 0 mm",
                             .doc = "from the end of the cloth to where the thread leaves the field; 0: no thread"}};

  Patch cloth{this, {.name = "cloth", .doc = "the cloth", .material = "cotton"}};
  Polylines marker{this,
                   {.name = "marker",
                    .doc = "the stripe near a long side that X-rays show",
                    .material = "x_ray_marker",
                    .radius = "0.3 mm",
                    .points_per_line = lengthwise}};
  Polylines string{this,
                   {.name = "string",
                    .doc = "the thread",
                    .material = "x_ray_marker",
                    .radius = "0.15 mm",
                    .points_per_line = thread_points}};

  void prepare(PrepareContext& context) override;
  void connect(PrepareContext& context, Simulation& simulation) override;
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }
  void publish() override;

 private:
  /// A point of the cloth on the surface.
  struct Hold {
    int triangle = -1;
    Vec3 bary = Vec3::Zero();
    Vec3 offset = Vec3::Zero();  ///< m
  };
  struct Hit {
    int triangle;
    Vec3 bary;
    double height;  ///< along `out` from the centre, m
  };
  void list_near();
  Vec3 foot(double i, double j) const;
  std::optional<Hit> highest(const Vec3& foot) const;
  double top_around(int i, int j) const;
  void stretch(std::vector<double>& height) const;
  Vec3 position(const Hold& hold) const;
  static std::size_t at(int i, int j) { return std::size_t(i * across + j); }

  Vec3 up_, side_, long_;
  std::vector<int> near_;  ///< triangles of the surface
  std::vector<Hold> holds_;
};

void CottonPatty::prepare(PrepareContext& context) {
  if (out().norm() < 1e-9) return error(context, out, "must be a direction");
  up_ = out().normalized();
  long_ = along() - along().dot(up_) * up_;
  if (long_.norm() < 1e-6) return error(context, along, "must not be parallel to out");
  long_.normalize();
  side_ = up_.cross(long_);
}

/// Lists the triangles that a line of the cloth may meet.
void CottonPatty::list_near() {
  const TriMesh& mesh = on->rest();
  // Half a step more than the cloth, which top_around() looks at.
  const Vec3 half(0.5 * length() * (1 + 1.0 / (lengthwise - 1)), 0.5 * width() * (1 + 1.0 / (across - 1)), reach());
  Aabb cloth_box;
  cloth_box.add(half);
  cloth_box.add(-half);
  near_.clear();
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    Aabb box;
    for (const int v : mesh.triangles[std::size_t(t)]) {
      const Vec3 x = mesh.vertices[std::size_t(v)] - centre();
      box.add(Vec3(x.dot(long_), x.dot(side_), x.dot(up_)));
    }
    if (box.overlaps(cloth_box)) near_.push_back(t);
  }
}

/// Where the line through a foot along `out` meets the surface at rest, highest within reach.
std::optional<CottonPatty::Hit> CottonPatty::highest(const Vec3& foot) const {
  const TriMesh& mesh = on->rest();
  std::optional<Hit> best;
  for (const int t : near_) {
    const auto& n = mesh.triangles[std::size_t(t)];
    const Vec3& a = mesh.vertices[std::size_t(n[0])];
    const Vec3 u = mesh.vertices[std::size_t(n[1])] - a, v = mesh.vertices[std::size_t(n[2])] - a;
    // foot + s up = a + p u + q v
    Mat3 m;
    m << u, v, -up_;
    const double det = m.determinant();
    if (std::abs(det) < 1e-18) continue;
    const Vec3 x = m.inverse() * (foot - a);
    if (x[0] < 0 || x[1] < 0 || x[0] + x[1] > 1 || std::abs(x[2]) > reach()) continue;
    if (!best || x[2] > best->height) best = Hit{t, Vec3(1 - x[0] - x[1], x[0], x[1]), x[2]};
  }
  return best;
}

/// The point of the plane through the centre that belongs to a point of the cloth; half steps lie between them.
Vec3 CottonPatty::foot(double i, double j) const {
  return centre() + (i / (lengthwise - 1) - 0.5) * length() * long_ + (j / (across - 1) - 0.5) * width() * side_;
}

/// The highest of the surface at a point of the cloth and half a step around it, so that no ridge comes through.
double CottonPatty::top_around(int i, int j) const {
  double top = -reach();
  for (const double di : {-0.5, 0.0, 0.5})
    for (const double dj : {-0.5, 0.0, 0.5})
      if (const auto hit = highest(foot(i + di, j + dj))) top = std::max(top, hit->height);
  return top;
}

/// Spans grooves: no point hangs lower than the mean of its neighbours. Gauss-Seidel of the obstacle problem.
void CottonPatty::stretch(std::vector<double>& height) const {
  const std::vector<double> ground = height;
  for (int sweep = 0; sweep < 200; ++sweep)
    for (int i = 1; i + 1 < lengthwise; ++i)
      for (int j = 1; j + 1 < across; ++j) {
        const double mean =
            0.25 * (height[at(i - 1, j)] + height[at(i + 1, j)] + height[at(i, j - 1)] + height[at(i, j + 1)]);
        height[at(i, j)] = std::max(ground[at(i, j)], mean);
      }
}

void CottonPatty::connect(PrepareContext& context, Simulation&) {
  std::vector<std::optional<Hit>> hits;
  std::vector<double> height;
  double lowest = reach();
  list_near();
  for (int i = 0; i < lengthwise; ++i)
    for (int j = 0; j < across; ++j) {
      hits.push_back(highest(foot(i, j)));
      height.push_back(hits.back() ? top_around(i, j) : -reach());
      if (hits.back()) lowest = std::min(lowest, height.back());
    }
  const std::optional<Hit>& middle = hits[at(lengthwise / 2, across / 2)];
  if (!middle) return error(context, centre, "centre: the surface is not within reach of it along out");
  for (double& z : height) z = std::max(z, lowest);
  stretch(height);
  holds_.clear();
  for (int i = 0; i < lengthwise; ++i)
    for (int j = 0; j < across; ++j) {
      // A point beside the surface hangs on with the triangle below the middle.
      const Hit& hit = hits[at(i, j)] ? *hits[at(i, j)] : *middle;
      Hold hold{hit.triangle, hit.bary, Vec3::Zero()};
      const Vec3 wanted = foot(i, j) + height[at(i, j)] * up_;
      const auto& n = on->rest().triangles[std::size_t(hit.triangle)];
      Vec3 below = Vec3::Zero();
      for (int k = 0; k < 3; ++k) below += hit.bary[k] * on->rest().vertices[std::size_t(n[std::size_t(k)])];
      // The rim lies on the tissue, so that no edge stands off.
      const bool rim = i == 0 || j == 0 || i == lengthwise - 1 || j == across - 1;
      hold.offset = wanted - below + (rim ? 0.1 : 1.0) * thickness() * up_;
      holds_.push_back(hold);
    }
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i + 1 < lengthwise; ++i)
    for (int j = 0; j + 1 < across; ++j) {
      const int a = int(at(i, j)), b = int(at(i + 1, j)), c = int(at(i + 1, j + 1)), d = int(at(i, j + 1));
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  cloth.set_triangles(std::move(triangles), holds_.size());
}

Vec3 CottonPatty::position(const Hold& hold) const {
  const auto& n = on->rest().triangles[std::size_t(hold.triangle)];
  Vec3 x = hold.offset;
  for (int k = 0; k < 3; ++k) {
    const MaterialPoint& p = on->points()[std::size_t(n[std::size_t(k)])];
    x += hold.bary[k] * p.body->position(p);
  }
  return x;
}

void CottonPatty::publish() {
  marker.resize(1);
  string.resize(thread().norm() > 0 ? 1 : 0);
  for (int i = 0; i < lengthwise; ++i)
    for (int j = 0; j < across; ++j) {
      const Vec3 x = position(holds_[at(i, j)]);
      cloth.set(at(i, j), x, 0);
      if (j == 1) marker.set(0, std::size_t(i), x + 0.5 * marker.radius() * up_, 0);
    }
  if (string.count() == 0) return;
  const Vec3 end = position(holds_[at(lengthwise - 1, across / 2)]);
  for (int k = 0; k < thread_points; ++k) {
    const double s = double(k) / (thread_points - 1);
    string.set(0, std::size_t(k), end + s * thread(), 0);
  }
}

}  // namespace
}  // namespace insula

INSULA_PLUGIN(cotton_patty) {
  registry.add_material({"cotton", "solid", {0.90, 0.87, 0.80, 1}, 0.95, 0, 0.3});
  registry.add_material({"x_ray_marker", "solid", {0.10, 0.28, 0.62, 1}, 0.7, 0, 0});
  registry.add<insula::CottonPatty>("cotton_patty", insula::Kind::constraint,
                                    "a cotton patty that lies on tissue and moves with it");
}
