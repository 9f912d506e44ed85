// SPDX-License-Identifier: GPL-3.0-or-later
// Image operations on a regular grid: exact distances, Gaussian smoothing, components, geodesic growth.
#pragma once

#include "volume.h"

namespace insula::mesh_tool {

// Euclidean distance (mm) of each node to the nearest node of the set; 1e6 when the set is empty.
// Separable lower envelope of parabolas: Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions",
// 2012.
Field distance_to(const Grid& grid, const Mask& set);

// Signed distance (mm): positive inside the mask, zero half-way between an inside and an outside node.
Field signed_distance(const Grid& grid, const Mask& mask);

// Separable Gaussian of standard deviation sigma (mm), truncated at three sigma; the border value is repeated.
void smooth(const Grid& grid, Field& field, double sigma);

// The 6-connected component of a node of the set; nothing if it is none.
Mask component(const Grid& grid, const Mask& mask, std::size_t of);

// Keeps the largest 6-connected component.
Mask largest_component(const Grid& grid, const Mask& mask);

// Fills what the outside (from the grid's border, 6-connected) cannot reach.
Mask fill_holes(const Grid& grid, const Mask& mask);

// Morphological closing of radius r (mm) as a level function: positive inside the closed set, mm near its border.
Field closing_level(const Grid& grid, const Mask& mask, double radius);

// Grows the seeds (class > 0) over the whole grid along shortest paths, an edge costing its length times the mean of
// `cost` at its ends; returns the class of the seed that arrives first. Ties go to the lower node index.
std::vector<unsigned char> grow(const Grid& grid, const std::vector<unsigned char>& seeds, const Field& cost);

}  // namespace insula::mesh_tool
