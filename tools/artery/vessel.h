// SPDX-License-Identifier: GPL-3.0-or-later
// A finished vessel: wall, picture, regions, caps, centrelines and what was measured on it; how it is made and written.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "case_table.h"
#include "core/base/input_error.h"
#include "curve.h"
#include "surface.h"

namespace insula::artery {

struct NamedCurve {
  std::string name, region, from, to;
  Curve curve;
};

struct Neck {
  Vec3 centre, normal;  ///< normal towards the dome
  double diameter = 0;
};

struct NeckPlane {
  Vec3 centre, normal;  ///< mm; unit, towards the dome
};

/// Where a neck may be, and how it was found.
struct NeckProposal {
  std::string method;
  NeckPlane plane;
  double diameter = 0;   ///< mm, of the circle of equal area
  double agreement = 1;  ///< of its dome with the chosen one: Dice coefficient of their areas, 0 to 1
  bool planar = true;    ///< its plane alone parts a dome, so that it may be given as the neck
};

struct Vessel {
  Surface wall;
  TriMesh picture;
  std::vector<std::string> regions;
  std::vector<int> region;  ///< a wall vertex's
  std::vector<NamedCurve> centrelines;
  std::optional<Neck> neck;
  std::vector<NeckProposal> proposals;  ///< the first is the neck; none where it was given
  double dome_height = 0;
  std::optional<std::pair<Vec3, double>> bleb;  ///< centre, radius
  std::map<std::string, double> dimensions;     ///< measured on the made mesh, mm and degrees
};

/// The vessel of a table's entry. Throws std::runtime_error when its dimensions make no sound surface.
Vessel make_case(const CaseSpec& spec);

struct ImportOptions {
  double edge_length = 0;  ///< mm; 0: chosen for about so many vertices:
  double vertices = 1700;
  std::optional<NeckPlane> neck;       ///< in place of the one that is found
  Vec3 inlet = Vec3::Constant(1e300);  ///< the cap nearest to this point; by default the widest
};
/// A cap to which no path leads from the inlet: the vessel is too thin on the way.
struct LostOutlet : InputError {
  LostOutlet(const std::string& message, const Vec3& cap) : InputError(message), centre(cap) {}
  Vec3 centre;
};
/// The vessel of a closed surface whose openings are flat caps. Throws LostOutlet, std::runtime_error.
Vessel import_surface(const TriMesh& surface, const ImportOptions& options);
/// The same where the caps are known: a closed surface whose triangles are marked, two caps or more.
Vessel vessel_of(Surface surface, const ImportOptions& options);
/// How sure a found neck is, 0 to 1: the mean agreement of the other proposals. 1 where the neck was given.
double neck_confidence(const std::vector<NeckProposal>& proposals);
/// The weak tip of the sac: vertices within `radius` mm of the dome become the region "bleb". Does nothing without a
/// sac.
void add_bleb(Vessel& vessel, double radius);

/// Equivalent diameter (of the circle of equal area) of the loop that a plane cuts out of the wall about a point on it.
/// Segments farther than `reach` from the point are left out. 0 when there is no loop.
double section_diameter(const TriMesh& mesh, const Vec3& point, const Vec3& normal, double reach);
/// Neighbours of each vertex, in a fixed order.
std::vector<std::vector<int>> neighbours(const TriMesh& mesh);
/// The marked vertices in connected pieces, by their first vertex. `next`: neighbours().
std::vector<std::vector<int>> connected_pieces(const std::vector<std::vector<int>>& next, std::vector<char> marked);
/// Each region but the ends keeps its largest connected piece; smaller ones go to the region they touch most.
void join_fragments(Vessel& vessel);
/// Fills the dimensions that every vessel has.
void measure(Vessel& vessel);

/// Writes wall.ply, picture.ply and vessel.json; the same vessel gives the same bytes. Throws std::runtime_error.
void write_vessel(const Vessel& vessel, const std::filesystem::path& folder);

}  // namespace insula::artery
