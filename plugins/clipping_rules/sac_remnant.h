// SPDX-License-Identifier: GPL-3.0-or-later
// The part of an aneurysm that blood still reaches when blades hold the wall together somewhere.
//
// Blood comes from the vessels that the neck adjoins. It reaches every vertex of the aneurysm's wall that a path along
// the wall's edges joins to those vessels without passing between the blades. So a blade that is too short leaves the
// whole dome open, a blade that lies obliquely leaves a wedge, and a blade that lies too high leaves a rim.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/model/wall_model.h"

namespace insula {

class SacRemnant {
 public:
  static constexpr int sectors = 24;                ///< of the neck's circumference
  static constexpr double rim_half_width = 0.5e-3;  ///< of the wall that counts as the neck, to each side, m

  /// A vertex of the wall that belongs to the aneurysm: of the regions "neck", "sac" and "bleb".
  struct Vertex {
    int node;       ///< of the wall
    int sector;     ///< by its azimuth about the neck's axis at rest
    double area;    ///< of the wall at rest, m2
    double height;  ///< above the neck's plane at rest, m; negative below it
    bool bleb;
    bool border;  ///< joined to a vertex of a vessel: blood enters here
  };
  /// Shares from 0 to 1.
  struct Open {
    double neck = 1;  ///< sectors in which blood rises more than the tolerance above the neck's plane
    double sac = 1;   ///< of the wall's area above the neck's plane, both at rest
    double bleb = 1;  ///< of the bleb's vertices; 0 without a bleb
  };

  /// False if the wall has no neck or no region "sac". Allocates all that measure() needs.
  bool attach(const WallModel& wall);
  const std::vector<Vertex>& vertices() const { return vertices_; }
  /// Two neighbouring vertices, as indices among vertices(), the smaller first.
  using Edge = std::array<int, 2>;
  const std::vector<Edge>& edges() const { return edges_; }
  /// `held[i]`: vertices()[i] lies between closed blades. `cut[e]`: edges()[e] passes between them, though its ends do
  /// not. `height[i]`: where a vertex is now above the neck's plane, m. `tolerance`: height of a remnant that does not
  /// count, m. Allocates nothing.
  Open measure(std::span<const char> held, std::span<const char> cut, std::span<const double> height,
               double tolerance) const;

 private:
  void join(const WallModel& wall, std::span<const int> own);  ///< own[node]: index among vertices(), or -1
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<int> first_, edge_of_;  ///< edges of vertex i: edge_of_[first_[i]] to edge_of_[first_[i + 1] - 1]
  mutable std::vector<char> reached_;
  mutable std::vector<int> front_;
};

}  // namespace insula
