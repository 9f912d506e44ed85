// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of surfaces as SVG: triangles in the order of their depth, lit from the eye.
#pragma once
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula::case_builder {

struct Drawn {
  TriMesh mesh;
  std::vector<std::array<int, 3>> colour;  ///< of each triangle, 0..255; one for all
  double opacity = 1;
  bool flat = false;  ///< not lit: planes
};

/// What an eye far away in the direction `from` sees, `up` upwards, `width` pixels wide, about `centre` with that
/// radius (mm).
std::string svg_picture(const std::vector<Drawn>& things, const Vec3& from, const Vec3& up, const Vec3& centre,
                        double radius, int width);

/// A disc, for planes.
TriMesh disc(const Vec3& centre, const Vec3& normal, double radius);

}  // namespace insula::case_builder
