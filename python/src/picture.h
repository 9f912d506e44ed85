// SPDX-License-Identifier: GPL-3.0-or-later
// A plain picture of the field for programs: surfaces, tools and lines with a depth buffer, lit from the eye. People
// look at the viewer's page.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/sim/simulation.h"

namespace insula::python {

struct Camera {
  Vec3 eye, target, up;
  double field_of_view = 0.35;  ///< vertical, rad
};

/// The scene's view, or one of all its surfaces.
Camera camera_of(const Simulation& simulation);

class Picture {
 public:
  Picture(int height, int width, const Camera& camera);
  void draw(const Simulation& simulation);
  /// Red, green and blue of each pixel, rows from above.
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }

 private:
  using Colour = std::array<double, 3>;
  struct Corner {
    double x, y, inverse_depth, light;
  };
  void draw_mesh(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles, const Colour& c);
  void draw_triangle(const Corner& a, const Corner& b, const Corner& c, const Colour& colour);
  void draw_line(const Vec3& from, const Vec3& to, const Colour& colour);
  void draw_drawable(const DrawableBase& drawable, const Colour& colour);
  bool project(const Vec3& p, Corner& out) const;
  void put(int x, int y, double inverse_depth, const Colour& colour, double light);

  int height_, width_;
  Vec3 eye_;
  Mat3 axes_;  ///< rows: right, up, back
  double focal_;
  std::vector<double> inverse_depth_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace insula::python
