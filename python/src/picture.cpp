// SPDX-License-Identifier: GPL-3.0-or-later
// The depth buffer holds 1/z, which is linear in the picture.
#include "python/src/picture.h"

#include <algorithm>
#include <cmath>

#include "core/mechanics/rigid_body.h"

namespace insula::python {
namespace {

constexpr double nearest = 0.01;  ///< m: what is nearer to the eye is not drawn
constexpr double ambient = 0.25;

std::array<double, 3> colour_of(const Simulation& simulation, const std::string& material) {
  for (const Material& m : simulation.scene().materials())
    if (m.name == material) return {m.rgba[0], m.rgba[1], m.rgba[2]};
  return {0.7, 0.7, 0.7};
}

}  // namespace

Camera camera_of(const Simulation& simulation) {
  if (const ViewSettings* v = simulation.view()) return {v->eye(), v->target(), v->up(), v->field_of_view()};
  Eigen::AlignedBox3d box;
  for (const Surface* s : simulation.surfaces())
    for (const Vec3& p : s->rest().vertices) box.extend(p);
  const Vec3 centre = box.isEmpty() ? Vec3::Zero().eval() : box.center();
  const double size = box.isEmpty() ? 0.1 : std::max(1e-3, box.diagonal().norm());
  return {centre + size * Vec3(1.6, 1.2, 0.8), centre, Vec3::UnitZ(), 0.5236};
}

Picture::Picture(int height, int width, const Camera& camera)
    : height_(height), width_(width), eye_(camera.eye), focal_(0.5 * height / std::tan(camera.field_of_view / 2)) {
  const Vec3 back = (camera.eye - camera.target).normalized(), right = camera.up.cross(back).normalized();
  axes_ << right.transpose(), back.cross(right).transpose(), back.transpose();
  const std::size_t n = std::size_t(height) * std::size_t(width);
  inverse_depth_.assign(n, 0);
  pixels_.assign(3 * n, 0);
}

bool Picture::project(const Vec3& p, Corner& out) const {
  const Vec3 q = axes_ * (p - eye_);
  if (-q.z() < nearest) return false;
  out.inverse_depth = -1 / q.z();
  out.x = 0.5 * width_ + focal_ * q.x() * out.inverse_depth;
  out.y = 0.5 * height_ - focal_ * q.y() * out.inverse_depth;
  out.light = 1;
  return true;
}

void Picture::put(int x, int y, double inverse_depth, const Colour& colour, double light) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  const std::size_t at = std::size_t(y) * std::size_t(width_) + std::size_t(x);
  if (inverse_depth <= inverse_depth_[at]) return;
  inverse_depth_[at] = inverse_depth;
  for (std::size_t k = 0; k < 3; ++k)
    pixels_[3 * at + k] = std::uint8_t(std::lround(255 * std::clamp(colour[k] * light, 0.0, 1.0)));
}

void Picture::draw_triangle(const Corner& a, const Corner& b, const Corner& c, const Colour& colour) {
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0) return;
  const auto first = [](double v) { return std::max(0, int(std::ceil(v - 0.5))); };
  const auto last = [](double v, int n) { return std::min(double(n - 1), std::floor(v - 0.5)); };
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
  for (int y = first(top); y <= last(bottom, height_); ++y)
    for (int x = first(left); x <= last(right, width_); ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
      const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      put(x, y, u * a.inverse_depth + v * b.inverse_depth + w * c.inverse_depth, colour,
          u * a.light + v * b.light + w * c.light);
    }
}

void Picture::draw_mesh(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles,
                        const Colour& colour) {
  std::vector<Vec3> normals(vertices.size(), Vec3::Zero());
  for (const auto& t : triangles) {
    const Vec3 &a = vertices[std::size_t(t[0])], &b = vertices[std::size_t(t[1])], &c = vertices[std::size_t(t[2])];
    for (const int k : t) normals[std::size_t(k)] += (b - a).cross(c - a);
  }
  std::vector<Corner> corners(vertices.size());
  std::vector<char> seen(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    seen[i] = project(vertices[i], corners[i]);
    const double facing = std::abs(normals[i].normalized().dot((eye_ - vertices[i]).normalized()));
    corners[i].light = ambient + (1 - ambient) * facing;
  }
  for (const auto& t : triangles) {
    const std::size_t a = std::size_t(t[0]), b = std::size_t(t[1]), c = std::size_t(t[2]);
    if (seen[a] && seen[b] && seen[c]) draw_triangle(corners[a], corners[b], corners[c], colour);
  }
}

void Picture::draw_line(const Vec3& from, const Vec3& to, const Colour& colour) {
  Corner a, b;
  if (!project(from, a) || !project(to, b)) return;
  // A little nearer, so that a line on a surface is seen.
  const double reach = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
  const int n = std::min(4 * (width_ + height_), 1 + int(reach));
  for (int k = 0; k <= n; ++k) {
    const double s = double(k) / n;
    put(int(std::floor(a.x + s * (b.x - a.x))), int(std::floor(a.y + s * (b.y - a.y))),
        1.001 * (a.inverse_depth + s * (b.inverse_depth - a.inverse_depth)), colour, 1);
  }
}

void Picture::draw_drawable(const DrawableBase& drawable, const Colour& colour) {
  const std::vector<float>& data = drawable.data();
  const auto at = [&](std::size_t i) { return Vec3(data[i], data[i + 1], data[i + 2]); };
  if (drawable.kind() == DrawableKind::polylines) {
    const std::size_t width = std::size_t(drawable.floats_per_element());
    for (std::size_t line = 0; line + width <= data.size(); line += width)
      if (data[line + 3] >= 0)
        for (std::size_t i = line; i + 8 <= line + width; i += 4) draw_line(at(i), at(i + 4), colour);
  } else if (const auto* patch = dynamic_cast<const Patch*>(&drawable)) {
    std::vector<Vec3> vertices;
    for (std::size_t i = 0; i + 4 <= data.size(); i += 4) vertices.push_back(at(i));
    draw_mesh(vertices, patch->triangles(), colour);
  }
}

void Picture::draw(const Simulation& simulation) {
  std::vector<Vec3> vertices;
  for (const Surface* s : simulation.surfaces()) {
    vertices.clear();
    for (const MaterialPoint& p : s->points()) vertices.push_back(s->body().position(p));
    draw_mesh(vertices, s->triangles(), colour_of(simulation, s->material()));
  }
  for (const Body* b : simulation.bodies()) {
    const auto* rigid = dynamic_cast<const RigidBody*>(b);
    if (!rigid || !rigid->active()) continue;
    for (const ToolPart& part : rigid->tool().parts) {
      const Pose root = rigid->link_pose(0), link = rigid->tool().link_pose(part.link, rigid->opening());
      vertices.clear();
      for (const Vec3& p : part.mesh.vertices) vertices.push_back(root.apply(link.apply(p)));
      draw_mesh(vertices, part.mesh.triangles, {part.rgba[0], part.rgba[1], part.rgba[2]});
    }
  }
  for (const auto& d : simulation.drawables())
    draw_drawable(*d.drawable, colour_of(simulation, d.drawable->material()));
}

}  // namespace insula::python
