// SPDX-License-Identifier: GPL-3.0-or-later
// What the import of a real surface is made of: flat caps, and centrelines between them.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>

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

/// A vertex nearer to a centreline than so many of its vessel's radii is of that vessel's wall.
inline constexpr double of_a_vessel = 1.15;
/// The vertices of the sac. They lie within the shortest closed line that parts the top of the largest bulge from the
/// walls of all vessels. Empty when nothing bulges so far.
/// radii: of each vertex, its distance from the nearest centreline, in radii of that vessel.
/// bulge: where a bulge begins, in the same unit.
std::vector<char> sac_by_cut(const Surface& surface, const std::vector<double>& radii, double bulge);
/// The largest connected set of vertices farther than `limit` radii from all centrelines.
std::vector<int> largest_bulge(const TriMesh& mesh, const std::vector<double>& radii, double limit);
/// The given vertices become the sac. The plane through their border is the neck.
void find_sac(Vessel& vessel, const std::vector<char>& of_sac);
/// What lies beyond a plane becomes the sac, what lies near it the neck. `vessel` has no sac yet. Throws
/// std::runtime_error when the plane parts no dome from the vessel.
void sac_beyond(Vessel& vessel, const NeckPlane& plane);
/// The plane near that of the vessel's neck whose section is narrowest, not far up the dome, with no wall of a vessel
/// on its dome side. Nothing where every plane leaves an opening or much of a vessel there. radii: as above.
std::optional<NeckPlane> narrowest_neck(const Vessel& vessel, const std::vector<double>& radii);
/// Necks by three methods, the best first: the narrowest section near the shortest line, the plane of that line
/// (sac_by_cut), and the border of what lies outside of the vessels' tubes (Piccinelli et al. 2012). Empty when nothing
/// bulges. `vessel` has no sac yet, and gets that of the first one. Where no plane parts what bulges, or the narrowest
/// one parts something else than the others find, this is the shortest line.
std::vector<NeckProposal> propose_necks(Vessel& vessel, const std::vector<double>& radii);

}  // namespace insula::artery
