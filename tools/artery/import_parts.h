// SPDX-License-Identifier: GPL-3.0-or-later
// What the import of a real surface is made of: flat caps, and centrelines between them.
#pragma once
#include <array>
#include <map>
#include <memory>

#include "core/model/geometry/box_tree.h"
#include "vessel.h"

namespace insula::artery {

/// Marks the flat caps of a closed surface: connected triangles nearly in one plane, round, at whose rim the
/// surface turns away (a rim that smoothing has rounded will do).
/// The widest comes first. Caps are named later.
Surface with_flat_caps(const TriMesh& mesh);

/// Nearest points on the wall, without the caps.
class WallPoints {
 public:
  explicit WallPoints(const Surface& surface);
  Vec3 nearest(const Vec3& p) const;
  double distance(const Vec3& p) const { return (nearest(p) - p).norm(); }

 private:
  std::vector<std::array<Vec3, 3>> triangles_;
  std::unique_ptr<BoxTree> tree_;
};

/// Centrelines from cap 0 to all other caps, as a tree: paths through a grid inside the surface on which a step costs
/// its length over the squared distance to the wall, so that they keep to the middle.
std::vector<NamedCurve> grid_centrelines(const Surface& surface, const WallPoints& wall);

/// The largest connected set of bulging vertices, if it is large enough, becomes the sac; the plane through its border
/// is the neck.
void find_sac(Vessel& vessel, std::vector<char> bulging);
/// What lies beyond a plane becomes the sac, what lies near it the neck. `vessel` has no sac yet. Throws
/// std::runtime_error when the plane parts no dome from the vessel.
void sac_beyond(Vessel& vessel, const NeckPlane& plane);
/// The plane near that of the vessel's neck whose section is narrowest, not far up the dome.
NeckPlane narrowest_neck(const Vessel& vessel);

}  // namespace insula::artery
