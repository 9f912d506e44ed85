// SPDX-License-Identifier: GPL-3.0-or-later
// Three methods find the neck. How far their sacs agree tells how sure it is.
#include <algorithm>
#include <numeric>

#include "import_parts.h"

namespace insula::artery {
namespace {

// Times the vessel's radius from its centreline: no vessel any more. A flat sac has the lower ones only.
constexpr double bulges[] = {1.45, 1.35, 1.27};
constexpr double tube = 1.2;  // the same: outside of the vessels' tubes

/// Whether a vertex belongs to the dome: neck or sac.
std::vector<char> dome_of(const Vessel& v) {
  std::vector<char> out;
  for (const int r : v.region) out.push_back(v.regions[std::size_t(r)] == "sac" || v.regions[std::size_t(r)] == "neck");
  return out;
}

double dice(const TriMesh& m, const std::vector<char>& a, const std::vector<char>& b) {
  double of_a = 0, of_b = 0, of_both = 0;
  for (const auto& t : m.triangles) {
    const auto all = [&](const std::vector<char>& set) {
      return std::all_of(t.begin(), t.end(), [&](int i) { return set[std::size_t(i)] != 0; });
    };
    const Vec3 &p = m.vertices[std::size_t(t[0])], &q = m.vertices[std::size_t(t[1])],
               &r = m.vertices[std::size_t(t[2])];
    const double area = 0.5 * (q - p).cross(r - p).norm();
    of_a += area * all(a), of_b += area * all(b), of_both += area * (all(a) && all(b));
  }
  return of_a + of_b > 0 ? 2 * of_both / (of_a + of_b) : 0;
}

/// Whether the plane alone parts a dome; if so, `v` gets it as its sac.
bool parted(Vessel& v, const NeckPlane& plane) {
  try {
    sac_beyond(v, plane);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// The proposal of a line on the wall, whose dome `v` has.
NeckProposal of_line(const std::string& method, const Vessel& bare, const Vessel& v) {
  NeckProposal out{method, {v.neck->centre, v.neck->normal}, v.neck->diameter, 1, false};
  Vessel by_plane = bare;
  if (out.planar = parted(by_plane, out.plane); out.planar) out.diameter = by_plane.neck->diameter;
  return out;
}

/// Whether the other two methods find one dome, and the narrowest section parts another: the base of a branch.
bool contradicted(const TriMesh& m, const std::vector<char>& narrowest, const std::vector<char>& cut,
                  const std::vector<char>& tubes) {
  constexpr double same = 0.7, other = 0.3;
  return dice(m, cut, tubes) > same && dice(m, narrowest, cut) < other && dice(m, narrowest, tubes) < other;
}

}  // namespace

std::vector<NeckProposal> propose_necks(Vessel& v, const std::vector<double>& radii) {
  const TriMesh& m = v.wall.mesh;
  const Vessel bare = v;
  Vessel cut = bare;
  for (const double bulge : bulges)
    if (!cut.neck) find_sac(cut, sac_by_cut(bare.wall, radii, bulge));
  if (!cut.neck) return {};
  std::vector<char> outside(m.vertices.size());
  for (const int i : largest_bulge(m, radii, tube)) outside[std::size_t(i)] = 1;
  Vessel tubes = bare;
  find_sac(tubes, outside);

  Vessel narrowest = bare;
  if (const std::optional<NeckPlane> plane = narrowest_neck(cut, radii)) sac_beyond(narrowest, *plane);
  const std::vector<char> of_cut = dome_of(cut), of_tubes = dome_of(tubes);
  std::vector<NeckProposal> out;
  if (narrowest.neck && !contradicted(m, dome_of(narrowest), of_cut, of_tubes)) {
    v = narrowest;
    out.push_back({"narrowest section", {v.neck->centre, v.neck->normal}, v.neck->diameter});
  } else {
    v = cut;
  }
  const std::vector<char> chosen = dome_of(v);
  out.push_back(of_line("shortest line", bare, cut));
  out.back().agreement = dice(m, chosen, of_cut);
  if (tubes.neck) {
    out.push_back(of_line("vessels' tubes", bare, tubes));
    out.back().agreement = dice(m, chosen, of_tubes);
  }
  return out;
}

double neck_confidence(const std::vector<NeckProposal>& proposals) {
  if (proposals.empty()) return 1;
  constexpr std::size_t methods = 3;  // one that finds no neck agrees with none
  const double sum = std::accumulate(proposals.begin() + 1, proposals.end(), 0.0,
                                     [](double s, const NeckProposal& p) { return s + p.agreement; });
  return sum / double(methods - 1);
}

}  // namespace insula::artery
