// SPDX-License-Identifier: GPL-3.0-or-later
// Centrelines of a real surface by cheapest paths through a grid in its inside.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <set>

#include <fmt/format.h>

#include "core/base/input_error.h"
#include "import_parts.h"

namespace insula::artery {
namespace {

constexpr int cells_across[] = {90, 160,
                                280};  // along the longest side; more where a thin vessel falls between the nodes
constexpr double max_cells = 1.2e7;
constexpr double most_depth = 1.2;  // of the widest cap's radius: a deeper place is no better, or paths run into a sac

struct InnerGrid {
  Vec3 low;
  double step = 0;
  int n[3] = {0, 0, 0};
  std::vector<char> inside;

  int index(int i, int j, int k) const { return (k * n[1] + j) * n[0] + i; }
  Vec3 point(int v) const { return low + step * Vec3(v % n[0], v / n[0] % n[1], v / (n[0] * n[1])); }

  InnerGrid(const TriMesh& m, int across_longest) {
    Box box;
    for (const Vec3& p : m.vertices) box.extend(p);
    step = box.sizes().maxCoeff() / across_longest;
    low = box.min() - step * Vec3(1.31, 1.37, 1.43);  // lines of the grid run through no vertex of a regular mesh
    for (int a = 0; a < 3; ++a) n[a] = int(std::ceil((box.max()[a] - low[a]) / step)) + 2;
    const std::size_t across = std::size_t(n[0]) * std::size_t(n[1]);
    inside.assign(across * std::size_t(n[2]), 0);
    // Parity along z: where each line of the grid crosses the surface.
    std::vector<std::vector<double>> crossings(across);
    for (const auto& t : m.triangles) {
      const Vec3 &a = m.vertices[std::size_t(t[0])], &b = m.vertices[std::size_t(t[1])],
                 &c = m.vertices[std::size_t(t[2])];
      const double det = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
      if (det == 0) continue;
      const Vec3 least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
      for (int i = int(std::ceil((least.x() - low.x()) / step)); low.x() + i * step <= most.x(); ++i)
        for (int j = int(std::ceil((least.y() - low.y()) / step)); low.y() + j * step <= most.y(); ++j) {
          const double x = low.x() + i * step - a.x(), y = low.y() + j * step - a.y();
          const double u = (x * (c.y() - a.y()) - (c.x() - a.x()) * y) / det,
                       w = ((b.x() - a.x()) * y - x * (b.y() - a.y())) / det;
          if (u >= 0 && w >= 0 && u + w < 1)
            crossings[std::size_t(j * n[0] + i)].push_back(a.z() + u * (b.z() - a.z()) + w * (c.z() - a.z()));
        }
    }
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        auto& line = crossings[std::size_t(j * n[0] + i)];
        std::sort(line.begin(), line.end());
        for (std::size_t c = 0; c + 1 < line.size(); c += 2)
          for (int k = int(std::ceil((line[c] - low.z()) / step)); k < n[2] && low.z() + k * step < line[c + 1]; ++k)
            inside[std::size_t(index(i, j, k))] = 1;
      }
  }
};

void smooth(std::vector<Vec3>& p, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Vec3> old = p;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) p[i] = 0.25 * old[i - 1] + 0.5 * old[i] + 0.25 * old[i + 1];
  }
}

/// The point, moved across the tangent away from the nearest wall until it is `wanted` from it, or no farther.
Vec3 off_the_wall(Vec3 p, const Vec3& tangent, double wanted, const WallPoints& wall) {
  double d = wall.distance(p);
  for (double step = 0.5 * wanted; step > 0.02 * wanted && d < wanted;) {
    Vec3 away = p - wall.nearest(p);
    away -= away.dot(tangent) * tangent;
    if (!(away.norm() > 1e-9)) break;
    const Vec3 to = p + std::min(step, wanted - d) * away.normalized();
    if (const double there = wall.distance(to); there > d) p = to, d = there;
    else step *= 0.5;
  }
  return p;
}

/// Moves points that lie nearer to the wall than most of the path towards the middle. A thin vessel is only a few cells
/// wide, so a path through the cells runs along its wall in places. Ends stay.
void centre(std::vector<Vec3>& p, const WallPoints& wall) {
  for (int round = 0; round < 3 && p.size() > 2; ++round) {  // the usual depth grows as the points move
    std::vector<double> depth;
    for (const Vec3& x : p) depth.push_back(wall.distance(x));
    const auto middle = depth.begin() + std::ptrdiff_t(depth.size() / 2);
    std::nth_element(depth.begin(), middle, depth.end());
    const double usual = 1.1 * *middle;
    const std::vector<Vec3> old = p;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const Vec3 along = old[i + 1] - old[i - 1];
      if (along.norm() > 0) p[i] = off_the_wall(old[i], along.normalized(), usual, wall);
    }
    smooth(p, 4);
  }
}

/// A path through cell centres becomes a smooth curve; its ends stay.
Curve smoothed(std::vector<Vec3> p, const WallPoints& wall, double step) {
  smooth(p, 30);
  centre(p, wall);
  Curve out{p, std::vector<double>(p.size(), 0.0)};
  out = resampled(out, step);
  for (std::size_t i = 0; i < out.size(); ++i) out.radius[i] = std::max(wall.distance(out.points[i]), 1e-3);
  return out;
}

/// Cheapest paths from the inlet, and where they end.
struct Paths {
  InnerGrid grid;
  std::vector<int> cell;    ///< one a cap
  std::vector<int> before;  ///< one a cell
  int lost = -1;            ///< a cap to which no path leads; -1: none
};

Paths find_paths(const Surface& surface, const WallPoints& wall, int across_longest) {
  Paths out{InnerGrid(surface.mesh, across_longest), {}, {}, -1};
  const InnerGrid& grid = out.grid;
  const std::size_t cells = grid.inside.size();
  std::vector<double> depth(cells, 0.0);
  double deepest = 0;
  for (const CapPlane& cap : surface.caps) deepest = std::max(deepest, most_depth * cap.radius);
  for (std::size_t v = 0; v < cells; ++v)
    if (grid.inside[v]) depth[v] = std::min(wall.distance(grid.point(int(v))), deepest);
  const auto cell_at = [&](const CapPlane& cap) {
    const Vec3 want = cap.centre - 1.5 * grid.step * cap.normal;
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < cells; ++v) {
      if (!grid.inside[v]) continue;
      const double d = (grid.point(int(v)) - want).squaredNorm();
      if (d < least) least = d, best = int(v);
    }
    if (best < 0) throw std::runtime_error("the surface has no inside");
    return std::sqrt(least) < cap.radius + 2 * grid.step ? best : -1;  // farther away it is another vessel's
  };

  for (const CapPlane& cap : surface.caps) {
    out.cell.push_back(cell_at(cap));
    if (out.cell.back() < 0) out.lost = int(out.cell.size()) - 1;
  }
  if (out.lost >= 0) return out;

  // Dijkstra from the inlet; equal costs go by cell number.
  const int start = out.cell[0];
  std::vector<double> cost(cells, std::numeric_limits<double>::infinity());
  std::vector<int>& before = out.before;
  before.assign(cells, -1);
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
  cost[std::size_t(start)] = 0;
  queue.emplace(0.0, start);
  while (!queue.empty()) {
    const auto [c, v] = queue.top();
    queue.pop();
    if (c > cost[std::size_t(v)]) continue;
    for (int dk = -1; dk <= 1; ++dk)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int to = v + grid.index(di, dj, dk);  // the grid's border is outside, so this stays within
          if (to == v || !grid.inside[std::size_t(to)]) continue;
          const double d = 0.5 * (depth[std::size_t(v)] + depth[std::size_t(to)]) + 0.1 * grid.step;
          const double through = c + std::sqrt(double(di * di + dj * dj + dk * dk)) * grid.step * grid.step / (d * d);
          if (through < cost[std::size_t(to)])
            cost[std::size_t(to)] = through, before[std::size_t(to)] = v, queue.emplace(through, to);
        }
  }

  for (std::size_t c = 1; c < surface.caps.size() && out.lost < 0; ++c)
    if (!std::isfinite(cost[std::size_t(out.cell[c])])) out.lost = int(c);
  return out;
}

/// Finds the paths. If a coarse grid loses a cap, a finer grid is used.
Paths paths_to_all_caps(const Surface& surface, const WallPoints& wall) {
  Box box;
  for (const Vec3& p : surface.mesh.vertices) box.extend(p);
  const double flatness = box.sizes().prod() / std::pow(box.sizes().maxCoeff(), 3);
  std::optional<Paths> found;
  for (const int across : cells_across) {
    if (found && flatness * std::pow(across, 3) > max_cells) break;
    found = find_paths(surface, wall, across);
    if (found->lost < 0) break;
  }
  if (found->lost >= 0) {
    const CapPlane& cap = surface.caps[std::size_t(found->lost)];
    const std::string why = fmt::format(
        "no way leads from the inlet to {} at ({:.1f}, {:.1f}, {:.1f}), {:.2f} mm across: the vessel is too thin on "
        "the way for a grid of {:.2g} mm. Cut it off before it gets so thin (--cut), or leave out what lies far away",
        cap.name, cap.centre.x(), cap.centre.y(), cap.centre.z(), 2 * cap.radius, found->grid.step);
    throw LostOutlet(why, cap.centre);
  }
  return std::move(*found);
}

/// The union of the paths, a tree of cells. It is traversed from the inlet, fork by fork.
class PathTree {
 public:
  PathTree(const Surface& surface, const WallPoints& wall, const Paths& paths)
      : surface_(surface), wall_(wall), grid_(paths.grid), start_(paths.cell[0]) {
    for (std::size_t c = 1; c < surface.caps.size(); ++c) {
      int v = paths.cell[c];
      outlet_[v] = c;
      for (; paths.before[std::size_t(v)] >= 0; v = paths.before[std::size_t(v)])
        after_[paths.before[std::size_t(v)]].insert(v);
    }
  }
  std::vector<NamedCurve> curves() {
    todo_ = {{start_, *after_.at(start_).begin(), surface_.caps[0].name}};
    std::vector<NamedCurve> out;
    while (!todo_.empty()) {
      const Walk w = todo_.back();
      todo_.pop_back();
      out.push_back(walk(w, out.empty()));
    }
    return out;
  }

 private:
  struct Walk {
    int from, next;
    std::string name;
  };
  /// Follows the tree to the next fork or to an outlet.
  NamedCurve walk(const Walk& w, bool first) {
    std::vector<Vec3> points;
    if (w.from == start_) points.push_back(surface_.caps[0].centre);
    points.push_back(grid_.point(w.from));
    int v = w.next;
    points.push_back(grid_.point(v));
    while (!outlet_.count(v) && after_.at(v).size() == 1) v = *after_.at(v).begin(), points.push_back(grid_.point(v));
    NamedCurve c;
    c.from = w.name;
    if (outlet_.count(v)) {
      c.to = surface_.caps[outlet_[v]].name;
      points.push_back(surface_.caps[outlet_[v]].centre);
      c.name = first ? "parent" : "branch_" + std::to_string(++branches_);
    } else {
      c.to = forks_++ == 0 ? "bifurcation" : "bifurcation_" + std::to_string(forks_);
      c.name = first ? "parent" : "trunk_" + std::to_string(++trunks_);
      for (auto next = after_.at(v).rbegin(); next != after_.at(v).rend(); ++next) todo_.push_back({v, *next, c.to});
    }
    c.region = c.name;
    c.curve = smoothed(points, wall_, 2 * grid_.step);
    return c;
  }

  const Surface& surface_;
  const WallPoints& wall_;
  const InnerGrid& grid_;
  int start_;
  std::map<int, std::set<int>> after_;
  std::map<int, std::size_t> outlet_;
  std::vector<Walk> todo_;
  int forks_ = 0, trunks_ = 0, branches_ = 0;
};

}  // namespace

std::vector<NamedCurve> grid_centrelines(const Surface& surface, const WallPoints& wall) {
  const Paths paths = paths_to_all_caps(surface, wall);
  return PathTree(surface, wall, paths).curves();
}

}  // namespace insula::artery
