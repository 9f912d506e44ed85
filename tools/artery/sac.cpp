// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of a real vessel is the sac: what bulges out of all centrelines, or what lies beyond a plane.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "import_parts.h"
#include "neck_planes.h"

namespace insula::artery {
namespace {

constexpr double widest_half_band = 0.45;  // mm, of the neck, to either side of its plane
constexpr double band_of_height = 0.3;     // of a low dome's height, the same
constexpr double most_of_bleb = 0.3;       // of the sac's vertices that the weak spot may take

/// The vertices beyond a plane, in connected pieces.
std::vector<std::vector<int>> pieces_beyond(const TriMesh& m, const std::vector<std::vector<int>>& next,
                                            const NeckPlane& plane) {
  std::vector<char> beyond(m.vertices.size());
  for (std::size_t i = 0; i < beyond.size(); ++i) beyond[i] = height(m.vertices[i], plane) > 0;
  return connected_pieces(next, std::move(beyond));
}

/// Where edges leave the set through the plane, in order of their angle about the middle: right for a loop that is
/// star-shaped.
Loop loop_of(const TriMesh& m, const std::vector<std::vector<int>>& next, const std::vector<int>& set,
             const NeckPlane& plane) {
  std::vector<Vec3> points;
  Loop out;
  for (const int i : set)
    for (const int n : next[std::size_t(i)]) {
      const double a = height(m.vertices[std::size_t(i)], plane), b = height(m.vertices[std::size_t(n)], plane);
      if (b > 0) continue;
      points.push_back(m.vertices[std::size_t(i)] +
                       a / (a - b) * (m.vertices[std::size_t(n)] - m.vertices[std::size_t(i)]));
      out.centre += points.back();
    }
  if (points.size() < 3) return {};
  out.centre /= double(points.size());
  const Vec3 u = plane.normal.unitOrthogonal(), w = plane.normal.cross(u);
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    const Vec3 x = a - out.centre, y = b - out.centre;
    return std::atan2(x.dot(w), x.dot(u)) < std::atan2(y.dot(w), y.dot(u));
  });
  for (std::size_t k = 0; k < points.size(); ++k)
    out.area += 0.5 * (points[k] - out.centre).cross(points[(k + 1) % points.size()] - out.centre).dot(plane.normal);
  return out;
}

}  // namespace

std::vector<int> dome_beyond(const TriMesh& m, const std::vector<std::vector<int>>& next, const NeckPlane& plane,
                             Loop& loop) {
  std::vector<int> best;
  double least = 1e300;
  for (auto& set : pieces_beyond(m, next, plane)) {
    const Loop l = loop_of(m, next, set, plane);
    const double d = (l.centre - plane.centre).norm();
    if (l.area > 0 && d < least) least = d, best = std::move(set), loop = l;
  }
  return best;
}

bool holds_a_cap(const Surface& s, const std::vector<int>& set) {
  std::vector<char> in(s.mesh.vertices.size());
  for (const int i : set) in[std::size_t(i)] = 1;
  for (std::size_t t = 0; t < s.patch.size(); ++t)
    if (s.patch[t] >= 0)
      for (const int i : s.mesh.triangles[t])
        if (in[std::size_t(i)]) return true;
  return false;
}

namespace {

/// The line from just before the neck to the dome; its radius is that of equal sections. It does not begin in the
/// vessel: sections there are wider than any of the sac, and flow is judged by those up to the widest.
void add_sac_line(Vessel& v, const std::vector<int>& sac) {
  const TriMesh& m = v.wall.mesh;
  const Vec3 centre = v.neck->centre, normal = v.neck->normal;
  Vec3 dome = centre;
  double top = -1e300, least = 1e300;
  for (const int i : sac) {
    const double h = (m.vertices[std::size_t(i)] - centre).dot(normal);
    if (h > top) top = h, dome = m.vertices[std::size_t(i)];
  }
  std::string start = "neck";
  for (const NamedCurve& c : v.centrelines)  // the nearest fork; without one the network joins it to the nearest vessel
    if (c.to.starts_with("bifurcation") && (c.curve.points.back() - centre).norm() < least)
      least = (c.curve.points.back() - centre).norm(), start = c.to;
  Curve line = resampled(Curve{{centre - 0.25 * normal, centre, dome}, {0, 0, 0}}, std::max(0.05 * top, 1e-6));
  for (std::size_t k = 0; k < line.size(); ++k) {
    const bool below = (line.points[k] - centre).dot(normal) < 0;
    const double section = below ? v.neck->diameter : section_diameter(m, line.points[k], normal, 3 * v.neck->diameter);
    line.radius[k] =
        0.5 * std::max(section, 0.15 * v.neck->diameter);  // the line ends in the wall, where the section is none
  }
  v.centrelines.push_back({"sac", "sac", start, "dome", line});
}

}  // namespace

void find_sac(Vessel& v, const std::vector<char>& of_sac) {
  const TriMesh& m = v.wall.mesh;
  const auto next = neighbours(m);
  std::vector<int> sac;
  for (std::size_t i = 0; i < of_sac.size(); ++i)
    if (of_sac[i]) sac.push_back(int(i));
  if (sac.size() < min_sac_vertices) return;
  const int sac_region = int(v.regions.size()) + 1, neck_region = sac_region - 1;
  v.regions.insert(v.regions.end(), {"neck", "sac"});
  for (const int i : sac) v.region[std::size_t(i)] = sac_region;
  std::vector<int> rim;
  for (const int i : sac)
    if (std::any_of(next[std::size_t(i)].begin(), next[std::size_t(i)].end(),
                    [&](int n) { return v.region[std::size_t(n)] < neck_region; }))
      rim.push_back(i);
  Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
  for (const int i : rim) centre += m.vertices[std::size_t(i)] / double(rim.size());
  // The rim may dip over a branch. The area that it encloses as a vector is that of the sac's triangles together.
  for (const auto& t : m.triangles)
    if (std::all_of(t.begin(), t.end(), [&](int i) { return of_sac[std::size_t(i)] != 0; }))
      normal += 0.5 * (m.vertices[std::size_t(t[1])] - m.vertices[std::size_t(t[0])])
                          .cross(m.vertices[std::size_t(t[2])] - m.vertices[std::size_t(t[0])]);
  if (rim.empty() || normal.norm() < 1e-9) return;
  normal.normalize();
  for (const int i : rim) v.region[std::size_t(i)] = neck_region;
  const double diameter = section_diameter(m, centre, normal, 1e300);
  double mean = 0;
  for (const int i : rim) mean += 2 * (m.vertices[std::size_t(i)] - centre).norm() / double(rim.size());
  v.neck = Neck{centre, normal, diameter > 0 && diameter < 1.5 * mean ? diameter : mean};
  add_sac_line(v, sac);
}

void sac_beyond(Vessel& v, const NeckPlane& given) {
  const TriMesh& m = v.wall.mesh;
  const auto next = neighbours(m);
  NeckPlane plane{given.centre, given.normal.normalized()};
  Loop loop;
  const std::vector<int> dome = dome_beyond(m, next, plane, loop);
  if (dome.size() < min_sac_vertices)
    throw std::runtime_error("the neck's plane cuts off no dome: nothing of the wall lies beyond it");
  if (holds_a_cap(v.wall, dome))
    throw std::runtime_error(
        "the neck's plane parts no dome from the vessel: an opening lies on its dome side; turn the plane, or move it "
        "towards the dome");
  double top = 0;
  for (const int i : dome) top = std::max(top, height(m.vertices[std::size_t(i)], plane));
  const double half_band = std::min(widest_half_band, band_of_height * top);
  const int neck_region = int(v.regions.size()), sac_region = neck_region + 1;
  v.regions.insert(v.regions.end(), {"neck", "sac"});
  std::vector<int> ring;  // grows from the dome's side of the plane to the other
  for (const int i : dome) {
    const auto& around = next[std::size_t(i)];
    const bool border = std::any_of(around.begin(), around.end(),
                                    [&](int n) { return height(m.vertices[std::size_t(n)], plane) <= 0; });
    const bool near = border || height(m.vertices[std::size_t(i)], plane) <= half_band;
    v.region[std::size_t(i)] = near ? neck_region : sac_region;
    if (near) ring.push_back(i);
  }
  double reach = 0;  // a branch that runs along in the plane is no neck
  for (const int i : ring) reach = std::max(reach, (m.vertices[std::size_t(i)] - loop.centre).norm() + half_band);
  for (std::size_t k = 0; k < ring.size(); ++k)
    for (const int n : next[std::size_t(ring[k])])
      if (v.region[std::size_t(n)] < neck_region && height(m.vertices[std::size_t(n)], plane) > -half_band &&
          (m.vertices[std::size_t(n)] - loop.centre).norm() < reach)
        v.region[std::size_t(n)] = neck_region, ring.push_back(n);
  v.neck = Neck{loop.centre, plane.normal, 2 * std::sqrt(loop.area / std::numbers::pi)};
  add_sac_line(v, dome);
}

void add_bleb(Vessel& v, double radius) {
  const auto sac = std::find(v.regions.begin(), v.regions.end(), "sac");
  if (sac == v.regions.end() || std::find(v.regions.begin(), v.regions.end(), "bleb") != v.regions.end()) return;
  const int sac_region = int(sac - v.regions.begin()), ends = int(v.regions.size()) - 1;
  const Vec3 dome = v.centrelines.back().curve.points.back();
  std::vector<double> distances;  // of the sac's vertices from the tip
  for (std::size_t i = 0; i < v.region.size(); ++i)
    if (v.region[i] == sac_region) distances.push_back((v.wall.mesh.vertices[i] - dome).norm());
  if (distances.empty()) return;
  // A small sac does not become all weak spot.
  const auto last = distances.begin() + std::ptrdiff_t(most_of_bleb * double(distances.size()));
  std::nth_element(distances.begin(), last, distances.end());
  radius = std::min(radius, *last);
  v.regions.insert(v.regions.begin() + ends, "bleb");  // the ends stay last
  for (std::size_t i = 0; i < v.region.size(); ++i) {
    if (v.region[i] == ends) v.region[i] = ends + 1;
    if (v.region[i] == sac_region && (v.wall.mesh.vertices[i] - dome).norm() < radius) v.region[i] = ends;
  }
  v.bleb = {dome, radius};
  join_fragments(v);
}

}  // namespace insula::artery
