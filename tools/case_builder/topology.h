// SPDX-License-Identifier: GPL-3.0-or-later
// How triangles hang together: pieces, sides, borders. Each function repairs one kind of fault and says how often it
// did.
#pragma once
#include <vector>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// Vertices closer than `distance` become one; triangles that collapse go. Returns how many vertices went.
int weld(TriMesh& mesh, double distance);
/// Triangles with the same three vertices as one before them go, whichever way they turn. Returns how many.
int drop_doubles(TriMesh& mesh);

struct BadEdges {
  int count = 0;  ///< edges of three or more triangles
  Vec3 first = Vec3::Zero();
};
BadEdges non_manifold_edges(const TriMesh& mesh);

/// Piece of each triangle (joined by edges), numbered from the largest area down.
struct Pieces {
  std::vector<int> of;
  std::vector<double> area;
};
Pieces pieces_of(const TriMesh& mesh);
void keep_piece(TriMesh& mesh, const Pieces& pieces, int piece);

/// Turns triangles until neighbours agree, in each piece as most of it lies. Returns how many were turned, or -1 when a
/// piece has only one side (a Moebius band).
int agree(TriMesh& mesh);
/// Vertices at which two fans of triangles meet in a point become two. Returns how many.
int part_fans(TriMesh& mesh);

/// Closed lines of border edges, each in the direction in which triangles fill them outward-facing (against the wall's
/// own).
std::vector<std::vector<int>> border_loops(const TriMesh& mesh);

/// Adds the vertices and triangles of another mesh.
void append(TriMesh& to, const TriMesh& more);
double area(const TriMesh& mesh);
double signed_volume(const TriMesh& mesh);
void turn_inside_out(TriMesh& mesh);

}  // namespace insula::case_builder
