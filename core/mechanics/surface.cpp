// SPDX-License-Identifier: GPL-3.0-or-later
// Embedding of a surface in its body.
#include "core/mechanics/surface.h"

#include "core/base/input_error.h"
#include "core/collision/search/aabb_tree.h"
#include "core/collision/shapes/closest.h"
#include "core/mechanics/barycentric_embedding.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"

namespace insula {

Surface::Surface() = default;
Surface::~Surface() = default;

void Surface::prepare(PrepareContext& context) {
  body_ = dynamic_cast<Body*>(parent);
  if (!body_) return error(context, "a surface belongs inside a body");
  auto* soft = dynamic_cast<SoftBody*>(body_);
  auto* shell = dynamic_cast<ShellBody*>(body_);
  try {
    if (!mesh.empty()) {
      rest_ = read_surface(mesh(), mesh_unit());
    } else if (soft) {
      rest_.triangles = boundary_triangles(soft->rest());
      std::vector<int> number(soft->rest().nodes.size(), -1);
      for (auto& t : rest_.triangles)
        for (int& i : t) {
          if (number[std::size_t(i)] < 0) {
            number[std::size_t(i)] = int(rest_.vertices.size());
            rest_.vertices.push_back(soft->rest().nodes[std::size_t(i)]);
          }
          i = number[std::size_t(i)];
        }
    } else if (shell) {
      rest_ = shell->rest();
    } else {
      return error(context, "this body has no mesh of its own: the surface needs a file (mesh=\"...\")");
    }
  } catch (const InputError& e) {
    return error(context, mesh, e.what());
  }
  points_.assign(rest_.vertices.size(), {});
  if (soft) {
    if (soft->rest().tets.empty()) return;  // its own error is reported
    const Embedding e = embed(soft->rest(), rest_.vertices);
    // Extrapolation would move points far from the tetrahedra too much. The unit or frame is probably wrong.
    if (e.outside_m > 0.005)
      return error(context, mesh,
                   "the surface reaches " + std::to_string(e.outside_m * 1000) +
                       " mm outside the body's tetrahedra; is its unit or frame another one?");
    for (std::size_t i = 0; i < points_.size(); ++i)
      points_[i] = {body_, 4, 0, e.nodes[i], embedding_weights(e.weights[i]), Vec3::Zero()};
  } else if (shell) {
    if (shell->rest().triangles.empty()) return;  // its own error is reported
    if (!attach_to_shell(*shell))
      return error(context, mesh,
                   "the surface lies more than 5 mm off the body's wall; is its unit or frame another one?");
  } else {
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i] = {body_, 0, 0, {}, {}, rest_.vertices[i]};
  }
  positions_ = rest_.vertices;
  expected_.assign(positions_.size(), Vec3::Zero());
}

// A vertex follows the nearest triangle of the wall and keeps its distance to it; the vertices of the body's own
// surface are its nodes.
bool Surface::attach_to_shell(const ShellBody& shell) {
  const TriMesh& wall = shell.rest();
  if (mesh.empty()) {
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i] = {body_, 1, 0, {int(i)}, {1}, Vec3::Zero()};
    return true;
  }
  AabbTree tree;
  tree.build(wall.vertices, wall.triangles);
  tree.refit(wall.vertices, {});
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec3& x = rest_.vertices[i];
    double least2 = 0.005 * 0.005;
    int best = -1;
    std::array<double, 4> bary{};
    tree.nearest(x, nullptr, least2, [&](int t, double& limit2) {
      const auto& v = wall.triangles[std::size_t(t)];
      const Vec3 &a = wall.vertices[std::size_t(v[0])], &b = wall.vertices[std::size_t(v[1])],
                 &c = wall.vertices[std::size_t(v[2])];
      const Vec3 w = closest_on_triangle(x, a, b, c);
      const Vec3 p = w[0] * a + w[1] * b + w[2] * c;
      const double d2 = (p - x).squaredNorm();
      if (d2 >= limit2) return;
      limit2 = d2;
      best = t;
      bary = {w[0], w[1], w[2]};
    });
    if (best < 0) return false;
    bary = embedding_weights(bary);
    const auto& v = wall.triangles[std::size_t(best)];
    Vec3 at = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) at += bary[k] * wall.vertices[std::size_t(v[k])];
    points_[i] = {body_, 3, 0, {v[0], v[1], v[2]}, bary, x - at};
  }
  return true;
}

void Surface::update() {
  if (body_->blocks() == 0) return;
  if (collision_) collision_->keep_positions();
  for (std::size_t i = 0; i < points_.size(); ++i) positions_[i] = body_->position(points_[i]);
}

void Surface::update_collision() {
  if (body_->blocks() == 0) return;
  if (!collision_) {
    if (contact()) update();
    return;
  }
  if (embedding_) {
    embedding_->place(static_cast<const DeformableBody&>(*body_), positions_.data(), expected_.data(), motion_);
    return collision_->update(positions_, expected_, motion_);
  }
  for (int i : moving_) {
    positions_[std::size_t(i)] = body_->position(points_[std::size_t(i)]);
    expected_[std::size_t(i)] = body_->expected_displacement(points_[std::size_t(i)]);
  }
  collision_->update(positions_, expected_);
}

void Surface::will_collide() {
  if (collision_) return;
  collision_ = std::make_unique<CollisionMesh>();
  collision_->build(rest_.vertices, rest_.triangles);
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (body_->can_move(points_[i])) moving_.push_back(int(i));
  if (!dynamic_cast<const DeformableBody*>(body_)) return;
  embedding_ = std::make_unique<BarycentricEmbedding>();
  embedding_->build(points_, moving_, *collision_);
}

void Surface::add_row(BodyRows& rows, int triangle, const Vec3& bary, const Vec3& d) const {
  if (body_->blocks() == 0) return;
  // The three vertices often share nodes, so merging them keeps rows short.
  std::array<int, 12> node;
  std::array<double, 12> weight;
  int count = 0;
  const auto& t = rest_.triangles[std::size_t(triangle)];
  for (int k = 0; k < 3; ++k) {
    if (bary[k] == 0) continue;
    const MaterialPoint& p = points_[std::size_t(t[std::size_t(k)])];
    for (int i = 0; i < p.count; ++i) {
      const double w = bary[k] * p.weight[std::size_t(i)];
      if (w == 0) continue;
      int at = 0;
      while (at < count && node[std::size_t(at)] != p.node[std::size_t(i)]) ++at;
      if (at == count) {
        node[std::size_t(count)] = p.node[std::size_t(i)];
        weight[std::size_t(count++)] = 0;
      }
      weight[std::size_t(at)] += w;
    }
  }
  for (int i = 0; i < count; ++i) rows.add(node[std::size_t(i)], weight[std::size_t(i)] * d);
}

}  // namespace insula
