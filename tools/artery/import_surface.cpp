// SPDX-License-Identifier: GPL-3.0-or-later
// A real surface becomes a vessel: caps, even triangles, centrelines, and the sac as what lies far from all
// centrelines.
#include <algorithm>
#include <cmath>

#include "import_parts.h"

namespace insula::artery {
namespace {

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
    for (std::size_t k = 0; k < 3 && s.patch[t] < 0; ++k)
      wall_edges[{s.mesh.triangles[t][k], s.mesh.triangles[t][(k + 1) % 3]}] = 1;
  for (std::size_t t = 0; t < s.patch.size(); ++t)
    for (std::size_t k = 0; k < 3 && s.patch[t] >= 0; ++k) {
      const int a = s.mesh.triangles[t][k], b = s.mesh.triangles[t][(k + 1) % 3];
      if (wall_edges.count({b, a}))
        out[std::size_t(s.patch[t])].push_back({s.mesh.vertices[std::size_t(a)], s.mesh.vertices[std::size_t(b)]});
    }
  return out;
}

/// Regions of the vessels by the nearest centreline. Returns how far each vertex is from it, in radii of that vessel.
std::vector<double> name_vessels(Vessel& v) {
  std::vector<double> usual;  // a vessel's radius: the median, so that the sac beside it does not count
  for (const NamedCurve& c : v.centrelines) {
    std::vector<double> r = c.curve.radius;
    std::nth_element(r.begin(), r.begin() + std::ptrdiff_t(r.size() / 2), r.end());
    usual.push_back(r[r.size() / 2]);
    v.regions.push_back(c.region);
  }
  std::vector<double> out;
  for (const Vec3& p : v.wall.mesh.vertices) {
    double best = 1e300;
    int region = 0;
    for (std::size_t c = 0; c < v.centrelines.size(); ++c) {
      const Curve& curve = v.centrelines[c].curve;
      for (std::size_t k = 0; k < curve.size(); ++k) {
        const double ratio =
            (p - curve.points[k]).norm() / std::clamp(curve.radius[k], 0.85 * usual[c], 1.15 * usual[c]);
        if (ratio < best) best = ratio, region = int(c);
      }
    }
    v.region.push_back(region);
    out.push_back(best);
  }
  return out;
}

}  // namespace

Vessel import_surface(const TriMesh& mesh, const ImportOptions& options) {
  TriMesh numbered = mesh;
  number_by_use(numbered);
  return vessel_of(with_flat_caps(numbered), options);
}

Vessel vessel_of(Surface original, const ImportOptions& options) {
  Vessel v;
  if (original.caps.size() < 2)
    throw std::runtime_error("the surface has " + std::to_string(original.caps.size()) +
                             " flat caps; two or more are needed (an inlet and an outlet)");
  std::size_t inlet = 0;
  if (options.inlet.cwiseAbs().maxCoeff() < 1e100)
    for (std::size_t c = 1; c < original.caps.size(); ++c)
      if ((original.caps[c].centre - options.inlet).norm() < (original.caps[inlet].centre - options.inlet).norm())
        inlet = c;
  std::swap(original.caps[0], original.caps[inlet]);
  for (int& p : original.patch) p = p == 0 ? int(inlet) : p == int(inlet) ? 0 : p;
  for (std::size_t c = 0; c < original.caps.size(); ++c)
    original.caps[c].name = c == 0 ? "inlet" : "outlet_" + std::to_string(c);

  const WallPoints wall(original);
  const auto rim = rims(original);
  const auto caps = original.caps;
  RemeshGuide guide;
  double edge = options.edge_length;
  if (!(edge > 0))
    edge = std::sqrt(expected_vertices(original.mesh, [](const Vec3&) { return 1.0; }) / options.vertices);
  guide.edge_length = [edge](const Vec3&) { return edge; };
  guide.on_wall = [&wall](const Vec3& p) { return wall.nearest(p); };
  guide.on_rim = [&rim](int c, const Vec3& p) { return nearest_on_segments(rim[std::size_t(c)], p); };
  guide.on_cap = [&caps](int c, const Vec3& p) -> Vec3 {
    return p - (p - caps[std::size_t(c)].centre).dot(caps[std::size_t(c)].normal) * caps[std::size_t(c)].normal;
  };
  v.wall = original;
  remesh(v.wall, guide, 10);
  v.picture = subdivided(v.wall, guide).mesh;
  v.centrelines = grid_centrelines(v.wall, WallPoints(v.wall));
  const std::vector<double> radii = name_vessels(v);
  if (options.neck) sac_beyond(v, *options.neck);
  else v.proposals = propose_necks(v, radii);
  const std::vector<VertexKind> kinds = vertex_kinds(v.wall);
  v.regions.push_back("ends");
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i].cap >= 0) v.region[i] = int(v.regions.size()) - 1;
  join_fragments(v);
  measure(v);
  return v;
}

}  // namespace insula::artery
