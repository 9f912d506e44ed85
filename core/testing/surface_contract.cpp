// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of surfaces: their points follow their body.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {
namespace {

/// Sets the body's configuration and updates the surface.
void put(Surface& surface, DeformableBody& body, const VecX& q) {
  body.q() = q;
  surface.update();
}

void check_rigid_motion(Findings& findings, Surface& surface, DeformableBody& body) {
  const VecX rest = body.q();
  const Quat turn = from_rotation_vector(Vec3(0.3, -1.1, 0.7));
  const Vec3 shift(0.01, 0.02, -0.03);
  const std::vector<Vec3> start = surface.positions();
  VecX moved = rest;
  for (int i = 0; i < body.nodes(); ++i) moved.segment<3>(3 * i) = turn * rest.segment<3>(3 * i) + shift;
  put(surface, body, moved);
  for (std::size_t i = 0; i < start.size(); ++i)
    findings.expect((surface.positions()[i] - (turn * start[i] + shift)).norm() < 1e-12,
                    "a vertex does not follow a rigid motion", fmt::format("vertex {}", i));
  put(surface, body, rest);
}

/// A row at a triangle's point is the derivative of that point; positions are linear in q, so the difference is exact.
void check_rows_of(Findings& findings, Surface& surface, DeformableBody& body, const VecX& q) {
  const VecX rest = body.q();
  for (std::size_t t = 0; t < surface.triangles().size(); t += 1 + surface.triangles().size() / 50) {
    const Vec3 bary(0.2, 0.5, 0.3), d(0.6, 0, 0.8);
    const auto along = [&] {
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 3; ++k)
        x += bary[k] * surface.positions()[std::size_t(surface.triangles()[t][std::size_t(k)])];
      return d.dot(x);
    };
    put(surface, body, rest);
    const double at_rest = along();
    put(surface, body, q);
    const double moved = along();
    BodyRows rows;
    rows.clear();
    rows.open(0);
    surface.add_row(rows, int(t), bary, d);
    double predicted = 0;
    for (std::size_t e = 0; e < rows.block.size(); ++e)
      predicted += rows.coeff[e].dot(q.segment<3>(3 * rows.block[e]) - rest.segment<3>(3 * rows.block[e]));
    findings.expect(std::abs(moved - at_rest - predicted) <= 1e-13,
                    "a row of a triangle's point is not the derivative of its position",
                    fmt::format("triangle {}: {:.17g} m, expected {:.17g} m", t, predicted, moved - at_rest));
  }
  put(surface, body, rest);
}

/// The step computes all positions at once, with the bits of each single point, and measures their motion.
void check_step(Findings& findings, Simulation& s, Surface& surface, DeformableBody& body, const VecX& rest,
                const VecX& q) {
  s.step();
  surface.will_collide();
  surface.update_collision();
  const std::vector<Vec3> before = surface.positions();
  body.q() = q;
  body.v() = 7 * (q - rest);
  surface.update_collision();
  double farthest = 0, farthest_free = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const MaterialPoint& p = surface.points()[i];
    if (!body.can_move(p)) continue;
    findings.expect(surface.positions()[i] == body.position(p) &&
                        surface.expected_displacements()[i] == body.expected_displacement(p),
                    "a vertex in the step has other bits than by itself", fmt::format("vertex {}", i));
    farthest = std::max(farthest, (surface.positions()[i] - before[i]).norm());
    farthest_free = std::max(farthest_free, surface.expected_displacements()[i].norm());
  }
  findings.expect(std::abs(surface.collision().moved(~std::uint64_t(0)) - farthest) <= 1e-12,
                  "it does not know how far it moved");
  findings.expect(std::abs(surface.collision().farthest_free() - farthest_free) <= 1e-12 && farthest_free > 0,
                  "it does not know how far its free motion goes");
  s.reset();  // the step moved the other surfaces too
  for (Surface* other : s.surfaces()) other->update();
}

}  // namespace

void check_surfaces(const std::filesystem::path& scene) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  for (Surface* surface : s->surfaces()) {
    Findings findings("surface " + surface->id);
    if (!findings.expect(surface->positions().size() == surface->rest().vertices.size(),
                         "its positions are not as many as its vertices"))
      continue;
    surface->update();
    for (std::size_t i = 0; i < surface->positions().size(); ++i)
      findings.expect((surface->positions()[i] - surface->rest().vertices[i]).norm() < 1e-3,
                      "a vertex starts elsewhere than at rest", fmt::format("vertex {}", i));
    auto* body = dynamic_cast<DeformableBody*>(&surface->body());
    if (!body || (dynamic_cast<ShellBody*>(body) && !surface->mesh.empty()))
      continue;  // an image beside the wall keeps its distance
    const VecX rest = body->q(), q = deformed(*body, 0.2, 3);
    check_rigid_motion(findings, *surface, *body);
    check_rows_of(findings, *surface, *body, q);
    check_step(findings, *s, *surface, *body, rest, q);
  }
}

}  // namespace insula::test
