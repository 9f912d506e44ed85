// SPDX-License-Identifier: GPL-3.0-or-later
// The cleft between two parts.
#include "cleft.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>

#include "grid_ops.h"

namespace insula::mesh_tool {
namespace {

Vec3 unit(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : v;
}

std::string json(const Vec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.3f, %.3f, %.3f]", v[0], v[1], v[2]);
  return text;
}

// One pass of a 1-2-1 filter along a line of points; the ends stay.
void relax(std::vector<Vec3>& line) {
  const std::vector<Vec3> old = line;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) line[i] = 0.25 * (old[i - 1] + 2.0 * old[i] + old[i + 1]);
}

/// Points of the grid at equal distances from both parts, in a cleft no wider than `width`.
std::vector<Vec3> mid_surface(const PartFields& fields, const Mask& in_a, const Mask& in_b, const FieldOptions& options,
                              double width, double rim) {
  const Grid& grid = fields.grid;
  const Field to_a = distance_to(grid, in_a), to_b = distance_to(grid, in_b);
  std::vector<Vec3> mid;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t at = grid.index(i, j, k);
        const double da = static_cast<double>(to_a[at]), db = static_cast<double>(to_b[at]);
        if (in_a[at] || in_b[at] || std::abs(da - db) > 0.75 * grid.spacing || da + db > width) continue;
        const Vec3 p = grid.point(i, j, k);
        if (options.radius > 0 && options.radius - norm(p - options.centre) < rim) continue;
        mid.push_back(p);
      }
  if (mid.size() < 20) throw std::runtime_error("no cleft found between the two parts");
  return mid;
}

/// Principal direction of the mid-surface perpendicular to the view (power iteration on the 3x3 covariance).
Vec3 long_axis(const std::vector<Vec3>& mid, const Vec3& mean, const Vec3& up) {
  Vec3 axis = unit(cross(up, {0.1, 0.2, 1}));
  for (int iteration = 0; iteration < 100; ++iteration) {
    Vec3 next{};
    for (const Vec3& p : mid) {
      Vec3 d = p - mean;
      d = d - dot(d, up) * up;
      next = next + dot(d, axis) * d;
    }
    axis = unit(next);
  }
  return axis;
}

struct Edges {
  std::vector<Vec3> top, floor;  ///< upper and lower edge of the cleft, station by station
};

Edges edges_of(const std::vector<Vec3>& mid, const Vec3& up, double step) {
  Vec3 mean{};
  for (const Vec3& p : mid) mean = mean + p;
  mean = (1.0 / static_cast<double>(mid.size())) * mean;
  const Vec3 axis = long_axis(mid, mean, up);
  std::map<long, std::vector<Vec3>> bins;
  for (const Vec3& p : mid) bins[std::lround(dot(p - mean, axis) / step)].push_back(p);
  Edges out;
  for (auto& [key, points] : bins) {
    if (points.size() < 20) continue;
    // Means over the highest and lowest twentieth, not single points: less noise.
    std::stable_sort(points.begin(), points.end(),
                     [&](const Vec3& p, const Vec3& q) { return dot(p, up) > dot(q, up); });
    const std::size_t share = std::max<std::size_t>(3, points.size() / 20);
    Vec3 high{}, low{};
    for (std::size_t i = 0; i < share; ++i) high = high + points[i], low = low + points[points.size() - 1 - i];
    out.top.push_back((1.0 / static_cast<double>(share)) * high);
    out.floor.push_back((1.0 / static_cast<double>(share)) * low);
  }
  if (out.top.size() < 2) throw std::runtime_error("the cleft between the two parts is too short");
  relax(out.top);
  relax(out.floor);
  return out;
}

/// Direction out of the smoothed tissue at a point, unit.
Vec3 way_out(const Grid& grid, const Field& tissue, const Vec3& p) {
  Vec3 slope{};
  for (std::size_t c = 0; c < 3; ++c) {
    Vec3 plus = p, minus = p;
    plus[c] += 1, minus[c] -= 1;
    slope[c] = sample(grid, tissue, minus) - sample(grid, tissue, plus);
  }
  return unit(slope);
}

}  // namespace

Cleft describe_cleft(const PartFields& fields, std::size_t a, std::size_t b, const FieldOptions& options,
                     const Vec3& view, double width, double step, double rim) {
  const Grid& grid = fields.grid;
  const std::size_t n = grid.count();
  Mask in_a(n), in_b(n);
  for (std::size_t i = 0; i < n; ++i) in_a[i] = fields.fine[a][i] > 0, in_b[i] = fields.fine[b][i] > 0;
  const auto [top, floor] = edges_of(mid_surface(fields, in_a, in_b, options, width, rim), unit(view), step);
  Cleft cleft;
  Field tissue(n);
  for (std::size_t i = 0; i < n; ++i) tissue[i] = in_a[i] || in_b[i] ? 1.0f : 0.0f;
  smooth(grid, tissue, 5);
  for (std::size_t i = 0; i < top.size(); ++i) {
    const Vec3 d = floor[i] - top[i];
    cleft.stations.push_back({top[i], floor[i], unit(d), norm(d)});
    cleft.centre = cleft.centre + top[i];
    if (i) cleft.length += norm(top[i] - top[i - 1]);
    cleft.outward = cleft.outward + way_out(grid, tissue, top[i]);
  }
  cleft.centre = (1.0 / static_cast<double>(top.size())) * cleft.centre;
  cleft.outward = unit(cleft.outward);
  return cleft;
}

void write_cleft_json(const std::string& path, const Cleft& cleft, const std::string& name_a, const std::string& name_b,
                      const FieldOptions& options) {
  std::ofstream out(path);
  char number[64];
  const auto fixed = [&](double v) {
    std::snprintf(number, sizeof number, "%.3f", v);
    return std::string(number);
  };
  out << "{\n  \"unit\": \"mm\",\n  \"between\": [\"" << name_a << "\", \"" << name_b
      << "\"],\n  \"centre\": " << json(cleft.centre) << ",\n  \"outward_normal\": " << json(cleft.outward)
      << ",\n  \"length\": " << fixed(cleft.length) << ",\n  \"region\": {\"centre\": " << json(options.centre)
      << ", \"radius\": " << fixed(options.radius) << "},\n  \"stations\": [\n";
  for (std::size_t i = 0; i < cleft.stations.size(); ++i) {
    const CleftStation& s = cleft.stations[i];
    out << "    {\"superficial\": " << json(s.superficial) << ", \"deep\": " << json(s.deep)
        << ", \"inward\": " << json(s.inward) << ", \"depth\": " << fixed(s.depth)
        << (i + 1 < cleft.stations.size() ? "},\n" : "}\n");
  }
  out << "  ]\n}\n";
  out.flush();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace insula::mesh_tool
