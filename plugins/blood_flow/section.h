// SPDX-License-Identifier: GPL-3.0-or-later
// A cross-section of a vessel as a material polygon. The rest wall is cut by a plane, and the corners are stored as
// points on wall edges. Area and perimeter can then be measured on the deformed wall in every step.
#pragma once
#include <array>
#include <vector>

#include "core/base/math.h"

namespace insula {

struct Lumen {
  double area = 0;       ///< m2
  double perimeter = 0;  ///< m
};

struct Section {
  struct Corner {
    int a, b;       ///< nodes of the edge
    double weight;  ///< of b
  };
  std::vector<Corner> corners;
  Vec3 place(const VecX& q, std::size_t corner) const;
  /// Area and perimeter of the polygon of the wall's middle surface.
  Lumen wall(const VecX& q) const;
  /// The same for the space inside the wall: a strip of half its thickness is subtracted along the perimeter. Two flat
  /// walls that touch leave nothing. A circle of radius r leaves a circle of r - thickness / 2.
  Lumen lumen(const VecX& q, double thickness) const;
  /// Middle of the polygon's perimeter. There must be corners.
  Vec3 centre(const VecX& q) const;
};

/// The loop around `at` in which the plane cuts the triangles, or the smallest one if there are several. Empty if there
/// is none or if it is open.
Section cut(const std::vector<Vec3>& nodes, const std::vector<std::array<int, 3>>& triangles, const Vec3& at,
            const Vec3& normal);

/// Pressure drop per flow and length, Pa s/m4: Poiseuille's law with the hydraulic diameter, 2 mu P^2 / A^3. A circle
/// has 8 mu / (pi r^4). A slit is underestimated by a third.
double resistance_per_length(const Lumen& lumen, double viscosity);

}  // namespace insula
