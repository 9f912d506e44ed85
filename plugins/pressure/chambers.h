// SPDX-License-Identifier: GPL-3.0-or-later
// The inside of a closed shell divided into chambers, each with its exact volume and the volume's gradient.
//
// A chamber is bounded by its triangles and by a cone over each border with other chambers. The apex of the cone is the
// mean of the border's nodes. Each chamber is then a closed polyhedron, so a uniform pressure in one chamber has
// neither a resultant force nor a moment. The cones of neighbours cancel, and the chambers' volumes add up to that of
// the shell.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/mechanics/shell_body.h"

namespace insula {

class Chambers {
 public:
  /// groups: names of the regions of each chamber. Triangles of regions in no group go to the adjacent chamber.
  void build(const ShellBody& body, const std::vector<std::vector<std::string>>& groups);

  int count() const { return int(chambers_.size()); }
  const std::string& name(int c) const { return chambers_[std::size_t(c)].name; }
  int find(std::string_view name) const;                                       ///< -1 if there is none
  int of_region(int region) const { return of_region_[std::size_t(region)]; }  ///< the chamber of most of its triangles
  double area(int c) const { return chambers_[std::size_t(c)].area; }          ///< of its wall and caps at rest, m2
  const std::vector<int>& nodes(int c) const { return chambers_[std::size_t(c)].nodes; }

  double volume(int c, const VecX& q) const;  ///< m3
  /// d volume / d node, m2, one for each node of nodes(c). `out` is resized.
  void gradient(int c, const VecX& q, std::vector<Vec3>& out) const;
  /// Finds the blocks of `a`, the body's matrix, that the second derivatives fill.
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node);
  /// a += sum_c scale * pressure[c] * d2(volume c)/dq2, N/m. At an edge between two chambers the mean of their
  /// pressures acts. The gradient of the load is thus exact for equal pressures, and is always symmetric.
  void add_second_derivative(const VecX& q, std::span<const double> pressure, double scale, BlockMatrix& a) const;

 private:
  struct Chamber {
    std::string name;
    double area = 0;
    std::vector<int> nodes;                     ///< ascending
    std::vector<std::array<int, 3>> triangles;  ///< indices into `nodes`
    struct Cone {
      int a, b, border;  ///< edge as in the cone's outward triangle (apex, a, b)
    };
    std::vector<Cone> cones;
    std::vector<std::vector<int>> border;  ///< of each border: its nodes, indices into `nodes`
  };
  void assign(const ShellBody& body, const std::vector<std::vector<std::string>>& groups, std::vector<int>& of);
  void add_borders(const std::vector<std::array<int, 3>>& triangles, const std::vector<int>& of,
                   std::size_t node_count);

  /// An edge between two free nodes. Its block of the matrix has the row of one node and the column of the other.
  struct CoupledEdge {
    int slot;
    int left, right;  ///< apex of the triangle that runs from row to column, and of the other one; nodes
    int left_chamber, right_chamber;  ///< of these triangles
  };
  std::vector<CoupledEdge> edges_;
  std::vector<std::array<int, 3>> triangles_;  ///< of all chambers
  std::vector<int> of_triangle_;               ///< their chambers
  std::vector<Chamber> chambers_;
  std::vector<int> of_region_;
  Vec3 origin_ = Vec3::Zero();  ///< near the vessel, for the accuracy of the volumes
};

}  // namespace insula
