// SPDX-License-Identifier: GPL-3.0-or-later
// A real surface becomes a vessel: caps, even triangles, centrelines, and the sac as what lies far from all centrelines.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "import_parts.h"

namespace insula::artery {
namespace {

constexpr double wanted_vertices = 1700;
constexpr double bulge = 1.45;            // times the vessel's radius from its centreline: no vessel any more
constexpr double least_sac_share = 0.03;  // of the surface's area

Vec3 nearest_on_segments(const std::vector<std::array<Vec3, 2>>& segments, const Vec3& p) {
  Vec3 best = p;
  double least = 1e300;
  for (const auto& [a, b] : segments) {
    const double w = std::clamp((p - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-30), 0.0, 1.0);
    const Vec3 q = a + w * (b - a);
    if ((q - p).squaredNorm() < least) least = (q - p).squaredNorm(), best = q;
  }
  return best;
}

std::vector<std::vector<std::array<Vec3, 2>>> rims(const Surface& s) {
  std::map<std::pair<int, int>, int> wall_edges;
  std::vector<std::vector<std::array<Vec3, 2>>> out(s.caps.size());
  for (std::size_t t = 0; t < s.patch.size(); ++t)
    for (std::size_t k = 0; k < 3 && s.patch[t] < 0; ++k) wall_edges[{s.mesh.triangles[t][k], s.mesh.triangles[t][(k + 1) % 3]}] = 1;
  for (std::size_t t = 0; t < s.patch.size(); ++t)
    for (std::size_t k = 0; k < 3 && s.patch[t] >= 0; ++k) {
      const int a = s.mesh.triangles[t][k], b = s.mesh.triangles[t][(k + 1) % 3];
      if (wall_edges.count({b, a})) out[std::size_t(s.patch[t])].push_back({s.mesh.vertices[std::size_t(a)], s.mesh.vertices[std::size_t(b)]});
    }
  return out;
}

/// Regions of the vessels by the nearest centreline; what bulges out of all of them comes back marked.
std::vector<char> name_vessels(Vessel& v) {
  std::vector<double> usual;  // a vessel's radius: the median, so that the sac beside it does not count
  for (const NamedCurve& c : v.centrelines) {
    std::vector<double> r = c.curve.radius;
    std::nth_element(r.begin(), r.begin() + std::ptrdiff_t(r.size() / 2), r.end());
    usual.push_back(r[r.size() / 2]);
    v.regions.push_back(c.region);
  }
  std::vector<char> out;
  for (const Vec3& p : v.wall.mesh.vertices) {
    double best = 1e300;
    int region = 0;
    for (std::size_t c = 0; c < v.centrelines.size(); ++c) {
      const Curve& curve = v.centrelines[c].curve;
      for (std::size_t k = 0; k < curve.size(); ++k) {
        const double ratio = (p - curve.points[k]).norm() / std::clamp(curve.radius[k], 0.85 * usual[c], 1.15 * usual[c]);
        if (ratio < best) best = ratio, region = int(c);
      }
    }
    v.region.push_back(region);
    out.push_back(best > bulge);
  }
  return out;
}

/// The largest connected set of bulging vertices, when it is large enough, becomes the sac with its neck.
void find_sac(Vessel& v, std::vector<char> bulging) {
  const TriMesh& m = v.wall.mesh;
  const auto next = neighbours(m);
  std::vector<int> sac;
  for (std::size_t start = 0; start < bulging.size(); ++start) {
    if (!bulging[start]) continue;
    std::vector<int> set{int(start)};
    bulging[start] = 0;
    for (std::size_t i = 0; i < set.size(); ++i)
      for (const int n : next[std::size_t(set[i])])
        if (bulging[std::size_t(n)]) bulging[std::size_t(n)] = 0, set.push_back(n);
    if (set.size() > sac.size()) sac = set;
  }
  if (double(sac.size()) < least_sac_share * double(m.vertices.size())) return;
  const int sac_region = int(v.regions.size()) + 1, neck_region = sac_region - 1;
  v.regions.insert(v.regions.end(), {"neck", "sac"});
  for (const int i : sac) v.region[std::size_t(i)] = sac_region;
  std::vector<int> rim;
  for (const int i : sac)
    if (std::any_of(next[std::size_t(i)].begin(), next[std::size_t(i)].end(), [&](int n) { return v.region[std::size_t(n)] < neck_region; })) rim.push_back(i);
  Vec3 centre = Vec3::Zero(), middle = Vec3::Zero();
  for (const int i : rim) centre += m.vertices[std::size_t(i)] / double(rim.size());
  for (const int i : sac) middle += m.vertices[std::size_t(i)] / double(sac.size());
  Mat3 spread = Mat3::Zero();
  for (const int i : rim) spread += (m.vertices[std::size_t(i)] - centre) * (m.vertices[std::size_t(i)] - centre).transpose();
  Vec3 normal = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(0);
  if (normal.dot(middle - centre) < 0) normal = -normal;
  for (const int i : rim) v.region[std::size_t(i)] = neck_region;
  const double diameter = section_diameter(m, centre, normal, 1e300);
  double mean = 0;
  for (const int i : rim) mean += 2 * (m.vertices[std::size_t(i)] - centre).norm() / double(rim.size());
  v.neck = Neck{centre, normal, diameter > 0 && diameter < 1.5 * mean ? diameter : mean};
  Vec3 dome = middle, from = centre;
  double height = -1e300, least = 1e300;
  for (const int i : sac) {
    const double h = (m.vertices[std::size_t(i)] - centre).dot(normal);
    if (h > height) height = h, dome = m.vertices[std::size_t(i)];
  }
  std::string start = "neck";
  for (const NamedCurve& c : v.centrelines)
    for (const Vec3& p : c.curve.points)
      if ((p - centre).norm() < least) least = (p - centre).norm(), from = p, start = c.name;
  Curve line = resampled(Curve{{from, centre, dome}, {0, 0, 0}}, std::max(0.05 * height, 1e-6));
  for (std::size_t k = 0; k < line.size(); ++k) {
    const bool below = (line.points[k] - centre).dot(normal) < 0;
    const double section = below ? v.neck->diameter : section_diameter(m, line.points[k], normal, 3 * v.neck->diameter);
    line.radius[k] = 0.5 * std::max(section, 0.15 * v.neck->diameter);  // the line ends in the wall, where the section is none
  }
  v.centrelines.push_back({"sac", "sac", start, "dome", line});
}

}  // namespace

Vessel import_surface(const TriMesh& mesh, const ImportOptions& options) {
  Vessel v;
  TriMesh numbered = mesh;
  number_by_use(numbered);
  Surface original = with_flat_caps(numbered);
  if (original.caps.size() < 2)
    throw std::runtime_error("the surface has " + std::to_string(original.caps.size()) + " flat caps; two or more are needed (an inlet and an outlet)");
  std::size_t inlet = 0;
  if (options.inlet.cwiseAbs().maxCoeff() < 1e100)
    for (std::size_t c = 1; c < original.caps.size(); ++c)
      if ((original.caps[c].centre - options.inlet).norm() < (original.caps[inlet].centre - options.inlet).norm()) inlet = c;
  std::swap(original.caps[0], original.caps[inlet]);
  for (int& p : original.patch) p = p == 0 ? int(inlet) : p == int(inlet) ? 0 : p;
  for (std::size_t c = 0; c < original.caps.size(); ++c) original.caps[c].name = c == 0 ? "inlet" : "outlet_" + std::to_string(c);

  const WallPoints wall(original);
  const auto rim = rims(original);
  const auto caps = original.caps;
  RemeshGuide guide;
  double edge = options.edge_length;
  if (!(edge > 0)) edge = std::sqrt(expected_vertices(original.mesh, [](const Vec3&) { return 1.0; }) / wanted_vertices);
  guide.edge_length = [edge](const Vec3&) { return edge; };
  guide.on_wall = [&wall](const Vec3& p) { return wall.nearest(p); };
  guide.on_rim = [&rim](int c, const Vec3& p) { return nearest_on_segments(rim[std::size_t(c)], p); };
  guide.on_cap = [&caps](int c, const Vec3& p) -> Vec3 { return p - (p - caps[std::size_t(c)].centre).dot(caps[std::size_t(c)].normal) * caps[std::size_t(c)].normal; };
  v.wall = original;
  remesh(v.wall, guide, 10);
  v.picture = subdivided(v.wall, guide).mesh;
  v.centrelines = grid_centrelines(v.wall, WallPoints(v.wall));
  find_sac(v, name_vessels(v));
  const std::vector<VertexKind> kinds = vertex_kinds(v.wall);
  v.regions.push_back("ends");
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i].cap >= 0) v.region[i] = int(v.regions.size()) - 1;
  join_fragments(v);
  measure(v);
  return v;
}

}  // namespace insula::artery
