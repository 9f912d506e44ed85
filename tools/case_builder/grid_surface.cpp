// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/grid_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/geometry/box_tree.h"
#include "core/model/geometry/triangle_distance.h"
#include "tools/artery/import_parts.h"
#include "tools/case_builder/handles.h"
#include "tools/case_builder/paint.h"
#include "tools/mesh_lobes/grid_ops.h"

namespace insula::case_builder {
namespace {

using mesh_tool::Field;
using mesh_tool::Grid;
using mesh_tool::Mask;
using mesh_tool::operator-;
constexpr double max_nodes = 6e7;

constexpr double wanted_triangles = 20000, even_triangles = 9000;

/// The border of what is positive, in cubes of the grid's spacing, or larger ones where that would give far more
/// triangles than are needed.
TriMesh zero_set(const Grid& grid, const Field& inside, std::vector<Note>& notes) {
  double faces = 0;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i + 1 < grid.size[0]; ++i)
        faces += (inside[grid.index(i, j, k)] > 0) != (inside[grid.index(i + 1, j, k)] > 0);
  const double area = 2 * faces * grid.spacing * grid.spacing;  // a third of the walls face along x
  const double step = std::clamp(std::sqrt(10 * area / wanted_triangles), grid.spacing, 4 * grid.spacing);
  Grid nodes{{}, grid.origin, step};
  for (std::size_t a = 0; a < 3; ++a)
    nodes.size[a] = int(std::ceil((grid.spacing * (grid.size[a] - 1) - step) / step)) + 1;
  Field sampled(nodes.count());
  std::size_t n = 0;
  for (int k = 0; k < nodes.size[2]; ++k)
    for (int j = 0; j < nodes.size[1]; ++j)
      for (int i = 0; i < nodes.size[0]; ++i)
        sampled[n++] = float(mesh_tool::sample(grid, inside, nodes.point(i, j, k)));
  if (const PartedHandles parted = part_handles(nodes, sampled); parted.nodes > 0)
    notes.push_back({Note::Kind::repair,
                     fmt::format("Vessels that had grown together were parted at their thinnest place, near {}.",
                                 place(parted.first)),
                     "Look whether that is where two walls touch. If it is not, part them in the segmentation."});
  artery::NodeValues values{Vec3(nodes.origin[0], nodes.origin[1], nodes.origin[2]), step, nodes.size, {}};
  for (const float v : sampled) values.value.push_back(-v);
  TriMesh mesh = artery::extract(std::move(values));
  artery::number_by_use(mesh);
  return mesh;
}

/// The same surface in even triangles: those of a grid are slivers whose normals say little, and flat ends are known by
/// normals.
TriMesh evened(const TriMesh& mesh) {
  const artery::Surface given{mesh, std::vector<int>(mesh.triangles.size(), -1), {}};
  const artery::WallPoints wall(given);
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += 0.5 * (mesh.vertices[std::size_t(t[1])] - mesh.vertices[std::size_t(t[0])])
                      .cross(mesh.vertices[std::size_t(t[2])] - mesh.vertices[std::size_t(t[0])])
                      .norm();
  const double edge = std::sqrt(area / even_triangles * 4 / std::sqrt(3.0));
  artery::RemeshGuide guide;
  guide.edge_length = [edge](const Vec3&) { return edge; };
  guide.on_wall = [&wall](const Vec3& p) { return wall.nearest(p); };
  artery::Surface out = given;
  artery::remesh(out, guide, 4);
  return out.mesh;
}

/// The node of the set that is nearest to a point.
std::size_t nearest_node(const Grid& grid, const Mask& mask, const Point& to) {
  std::size_t best = 0, n = 0;
  double least = 1e300;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i, ++n) {
        if (!mask[n]) continue;
        const double away = mesh_tool::norm(grid.point(i, j, k) - to);
        if (away < least) least = away, best = n;
      }
  return best;
}

/// The connected set that is the vessel: the largest, or the one nearest to the seed.
Mask vessel_part(const Grid& grid, const Mask& mask, const Options& o, std::vector<Note>& notes) {
  const auto count = [](const Mask& m) { return std::size_t(std::count(m.begin(), m.end(), 1)); };
  Mask part = o.seed ? mesh_tool::component(grid, mask, nearest_node(grid, mask, *o.seed))
                     : mesh_tool::largest_component(grid, mask);
  const std::size_t whole = count(mask), kept = count(part);
  if (kept < whole)
    notes.push_back({Note::Kind::repair,
                     fmt::format("The vessel's voxels are in several pieces; the {} one was kept, {:.1f} % of them.",
                                 o.seed ? "wanted" : "largest", 100.0 * double(kept) / double(whole)),
                     kept * 2 < whole ? "If this is another one than meant, name a point in it with --seed." : ""});
  return part;
}

/// Where the vessel meets the faces of the volume: the middle of each patch there, drawn in by `inset`, and the way
/// out.
std::vector<Plane> border_ends(const mesh_tool::NiftiVolume& v, const std::function<bool(float)>& is_vessel,
                               const TriMesh& surface, double inset) {
  std::vector<Plane> out;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, w = (axis + 2) % 3,
              layer = face % 2 ? v.size[std::size_t(axis)] - 1 : 0;
    const int nu = v.size[std::size_t(u)], nw = v.size[std::size_t(w)];
    std::vector<char> open(std::size_t(nu) * std::size_t(nw));
    for (int j = 0; j < nw; ++j)
      for (int i = 0; i < nu; ++i) {
        int at[3];
        at[axis] = layer, at[u] = i, at[w] = j;
        open[std::size_t(j) * std::size_t(nu) + std::size_t(i)] = is_vessel(v.at(at[0], at[1], at[2]));
      }
    for (int start = 0; start < nu * nw; ++start) {
      if (!open[std::size_t(start)]) continue;
      std::vector<int> patch{start};
      open[std::size_t(start)] = 0;
      double si = 0, sj = 0;
      for (std::size_t k = 0; k < patch.size(); ++k) {
        const int i = patch[k] % nu, j = patch[k] / nu;
        si += i, sj += j;
        for (const auto& [a, b] : {std::pair(i - 1, j), std::pair(i + 1, j), std::pair(i, j - 1), std::pair(i, j + 1)})
          if (a >= 0 && a < nu && b >= 0 && b < nw && open[std::size_t(b) * std::size_t(nu) + std::size_t(a)])
            open[std::size_t(b) * std::size_t(nu) + std::size_t(a)] = 0, patch.push_back(b * nu + a);
      }
      if (patch.size() < 9) continue;
      double at[3];
      at[axis] = layer, at[u] = si / double(patch.size()), at[w] = sj / double(patch.size());
      Vec3 p, outward;
      for (int r = 0; r < 3; ++r) {
        p[r] = v.to_world[std::size_t(4 * r + 3)];
        for (int a = 0; a < 3; ++a) p[r] += v.to_world[std::size_t(4 * r + a)] * at[a];
        outward[r] = (face % 2 ? 1 : -1) * v.to_world[std::size_t(4 * r + axis)];
      }
      outward.normalize();
      p -= inset * outward;
      // A speck that was left out also meets the border: only ends of the surface that was kept count.
      double near = 1e300;
      for (const Vec3& q : surface.vertices) near = std::min(near, (q - p).norm());
      const double wide = std::sqrt(double(patch.size()) / 3.14159) * inset;
      if (near < 1.5 * wide + inset) out.push_back({p.x(), p.y(), p.z(), outward.x(), outward.y(), outward.z()});
    }
  }
  return out;
}

std::string labels_there(const mesh_tool::NiftiVolume& v) {
  std::map<float, std::size_t> count;
  for (const float x : v.value)
    if (x != 0 && count.size() < 64) ++count[x];
  std::string out;
  int said = 0;
  for (const auto& [label, n] : count)
    if (said++ < 12) out += fmt::format("{}{:g} ({} voxels)", out.empty() ? "" : ", ", label, n);
  return out.empty() ? "it holds nothing but 0" : "there are: " + out;
}

/// A volume, and the rule which of its voxels belong to the vessel.
class VesselVolume {
 public:
  VesselVolume(const std::filesystem::path& file, const mesh_tool::NiftiVolume& v, const Options& o)
      : file_(file), v_(v), o_(o) {
    for (std::size_t a = 0; a < 3; ++a)
      voxel_[a] = std::sqrt(v.to_world[a] * v.to_world[a] + v.to_world[4 + a] * v.to_world[4 + a] +
                            v.to_world[8 + a] * v.to_world[8 + a]);
    check_voxels();
    for (const float x : v.value) {
      if (!std::isfinite(x)) fail(file, "holds a value that is not finite");
      least_ = std::min(least_, x), most_ = std::max(most_, x);
    }
    if (!o.label && !o.threshold) ask_for_level();
    level_ = o.label ? *o.label : *o.threshold;
  }
  bool is_vessel(float x) const { return o_.label ? x == float(level_) : double(x) >= level_; }
  double fine() const { return *std::min_element(voxel_.begin(), voxel_.end()); }
  double coarse() const { return *std::max_element(voxel_.begin(), voxel_.end()); }

  /// A grid of cubes with the smallest side of a voxel. It covers the box of the vessel and some voxels more. Nodes
  /// outside of the volume are not vessel, so vessels that leave the volume end flat.
  Grid grid(std::vector<Note>& notes) const {
    const auto [from, to] = box();
    Grid grid;
    grid.spacing = fine();
    double nodes = 1;
    for (int a = 0; a < 3; ++a)
      grid.origin[std::size_t(a)] = from[a],
      nodes *= grid.size[std::size_t(a)] = int(std::ceil((to[a] - from[a]) / grid.spacing)) + 1;
    if (nodes > max_nodes)
      fail(file_,
           "the vessel fills too large a box; name a point in it (--seed) and take what is near it "
           "(--around \"30 mm\"), or cut out the region around the aneurysm first");
    if (coarse() > 1.05 * fine())
      notes.push_back({Note::Kind::repair,
                       fmt::format("Voxels of {:.3g} x {:.3g} x {:.3g} mm were brought to cubes of {:.3g} mm.",
                                   voxel_[0], voxel_[1], voxel_[2], fine()),
                       ""});
    return grid;
  }

  /// Marks the grid's nodes in the vessel.
  Mask sampled(const Grid& grid) const {
    Mask mask(grid.count(), 0);
    std::size_t n = 0;
    for (int k = 0; k < grid.size[2]; ++k)
      for (int j = 0; j < grid.size[1]; ++j)
        for (int i = 0; i < grid.size[0]; ++i, ++n) {
          const auto p = grid.point(i, j, k);
          if (o_.label) mask[n] = is_vessel(v_.nearest(p)) && v_.nearest(p) != 0;
          else mask[n] = float(v_.linear(p) - level_) >= 0;
        }
    return mask;
  }

 private:
  void check_voxels() const {
    if (o_.any_size || (fine() >= 0.02 && coarse() <= 2)) return;
    fail(file_, fmt::format("its voxels are {:.4g} x {:.4g} x {:.4g} mm; for an artery of 3 mm 0.05 to 1 mm are usual. "
                            "Is the unit in its header right? --any-size takes it all the same",
                            voxel_[0], voxel_[1], voxel_[2]));
  }
  [[noreturn]] void ask_for_level() const {
    bool whole = true;
    std::map<float, int> labels;
    for (const float x : v_.value) {
      whole = whole && x == std::floor(x);
      if (labels.size() < 9) labels[x] = 1;
    }
    fail(file_,
         whole && labels.size() < 9
             ? "say which label is the vessel, --label N; " + labels_there(v_)
             : fmt::format("say from which grey value on it is vessel, --threshold N; values run from {:g} to {:g}",
                           least_, most_));
  }
  /// Takes a ball into a box of voxels, as far as the volume goes.
  void extend(int (&low)[3], int (&high)[3], const Point& p, double radius) const {
    for (std::size_t a = 0; a < 3; ++a) {
      double at = v_.from_world[4 * a + 3];
      for (std::size_t r = 0; r < 3; ++r) at += v_.from_world[4 * a + r] * p[r];
      const double half = radius / voxel_[a], last = v_.size[a] - 1;
      low[a] = std::min(low[a], int(std::clamp(std::floor(at - half), 0.0, last)));
      high[a] = std::max(high[a], int(std::clamp(std::ceil(at + half), 0.0, last)));
    }
  }
  /// Two opposite corners of the vessel's box in world coordinates, with a margin of three voxels.
  std::pair<Vec3, Vec3> box() const {
    int low[3] = {1 << 30, 1 << 30, 1 << 30}, high[3] = {-1, -1, -1};
    for (int k = 0; k < v_.size[2]; ++k)
      for (int j = 0; j < v_.size[1]; ++j)
        for (int i = 0; i < v_.size[0]; ++i)
          if (is_vessel(v_.at(i, j, k))) {
            const int at[3] = {i, j, k};
            for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a]);
          }
    for (const Stroke& s : o_.paint)
      for (const Point& p : s.points)
        if (!s.erase) extend(low, high, p, s.radius_mm);
    if (high[0] < 0)
      fail(file_, o_.label ? fmt::format("has no voxel of label {}; {}", *o_.label, labels_there(v_))
                           : fmt::format("nothing reaches the threshold {:g}; values run from {:g} to {:g}", level_,
                                         least_, most_));
    Vec3 from = Vec3::Constant(1e300), to = -from;
    for (int c = 0; c < 8; ++c) {
      double at[3];
      for (int a = 0; a < 3; ++a) at[a] = c >> a & 1 ? high[a] + 3.0 : low[a] - 3.0;
      Vec3 p;
      for (int r = 0; r < 3; ++r)
        p[r] = v_.to_world[std::size_t(4 * r)] * at[0] + v_.to_world[std::size_t(4 * r + 1)] * at[1] +
               v_.to_world[std::size_t(4 * r + 2)] * at[2] + v_.to_world[std::size_t(4 * r + 3)];
      from = from.cwiseMin(p), to = to.cwiseMax(p);
    }
    return {from, to};
  }

  const std::filesystem::path& file_;
  const mesh_tool::NiftiVolume& v_;
  const Options& o_;
  std::array<double, 3> voxel_{};  ///< sides of a voxel, mm
  float least_ = 1e30f, most_ = -1e30f;
  double level_ = 0;
};

}  // namespace

TriMesh surface_of_volume(const std::filesystem::path& file, const mesh_tool::NiftiVolume& v, const Options& o,
                          std::vector<Note>& notes, std::vector<Plane>& ends) {
  const VesselVolume vessel(file, v, o);
  const Grid grid = vessel.grid(notes);
  Mask all = vessel.sampled(grid);
  paint(grid, all, o.paint);
  const Mask mask = vessel_part(grid, all, o, notes);
  const Mask solid = mesh_tool::fill_holes(grid, mask);
  if (solid != mask) notes.push_back({Note::Kind::repair, "Voids inside of the vessel were filled.", ""});
  if (!o.paint.empty())
    notes.push_back({Note::Kind::repair,
                     fmt::format("The author has changed the vessel by hand with {} stroke{}.", o.paint.size(),
                                 o.paint.size() == 1 ? "" : "s"),
                     ""});
  Field inside = mesh_tool::signed_distance(grid, solid);
  const double coarse = vessel.coarse();
  mesh_tool::smooth(grid, inside, std::max(0.01, o.smoothing * coarse));
  notes.push_back({Note::Kind::fact,
                   fmt::format("The surface was taken from voxels of {:.3g} mm, its border smoothed over {:.2g} mm.",
                               vessel.fine(), o.smoothing * coarse),
                   ""});
  TriMesh out = evened(zero_set(grid, inside, notes));
  ends = border_ends(
      v, [&](float x) { return vessel.is_vessel(x); }, out, 1.2 * coarse);
  if (!ends.empty())
    notes.push_back({Note::Kind::repair,
                     fmt::format("The vessel leaves the volume at {} place{}; it was cut straight there.", ends.size(),
                                 ends.size() == 1 ? "" : "s"),
                     ""});
  return out;
}

mesh_tool::Mask inside_of(const TriMesh& m, const Grid& grid) {
  const double spacing = grid.spacing;
  // Parity along each axis; two of three decide, so that a slit in the surface does not leave a streak.
  std::vector<unsigned char> votes(grid.count(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    const auto nu = std::size_t(grid.size[std::size_t(u)]);
    std::vector<std::vector<double>> crossings(nu * std::size_t(grid.size[std::size_t(w)]));
    for (const auto& t : m.triangles) {
      const Vec3 &a = m.vertices[std::size_t(t[0])], &b = m.vertices[std::size_t(t[1])],
                 &c = m.vertices[std::size_t(t[2])];
      const double det = (b[u] - a[u]) * (c[w] - a[w]) - (c[u] - a[u]) * (b[w] - a[w]);
      if (det == 0) continue;
      const auto first = [&](double x, int d) {
        return int(
            std::clamp(std::ceil((x - grid.origin[std::size_t(d)]) / spacing), 0.0, double(grid.size[std::size_t(d)])));
      };
      const int i0 = first(std::min({a[u], b[u], c[u]}), u), i1 = first(std::max({a[u], b[u], c[u]}), u);
      const int j0 = first(std::min({a[w], b[w], c[w]}), w), j1 = first(std::max({a[w], b[w], c[w]}), w);
      for (int j = j0; j < j1; ++j)
        for (int i = i0; i < i1; ++i) {
          const double x = grid.origin[std::size_t(u)] + i * spacing - a[u],
                       y = grid.origin[std::size_t(w)] + j * spacing - a[w];
          const double p = (x * (c[w] - a[w]) - (c[u] - a[u]) * y) / det,
                       q = ((b[u] - a[u]) * y - x * (b[w] - a[w])) / det;
          if (p >= 0 && q >= 0 && p + q < 1)
            crossings[std::size_t(j) * nu + std::size_t(i)].push_back(a[axis] + p * (b[axis] - a[axis]) +
                                                                      q * (c[axis] - a[axis]));
        }
    }
    for (int j = 0; j < grid.size[std::size_t(w)]; ++j)
      for (int i = 0; i < grid.size[std::size_t(u)]; ++i) {
        auto& line = crossings[std::size_t(j) * nu + std::size_t(i)];
        std::sort(line.begin(), line.end());
        std::size_t passed = 0;
        for (int k = 0; k < grid.size[std::size_t(axis)]; ++k) {
          while (passed < line.size() && line[passed] < grid.origin[std::size_t(axis)] + k * spacing) ++passed;
          int at[3];
          at[axis] = k, at[u] = i, at[w] = j;
          votes[grid.index(at[0], at[1], at[2])] += passed % 2;
        }
      }
  }
  Mask mask(grid.count());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = votes[i] >= 2;
  return mask;
}

TriMesh rebuilt(const TriMesh& m, double spacing, std::vector<Note>& notes) {
  Box box;
  std::vector<Box> boxes;
  for (const auto& t : m.triangles) {
    Box b;
    for (const int v : t) b.extend(m.vertices[std::size_t(v)]);
    boxes.push_back(b), box.extend(b);
  }
  Grid grid;
  grid.spacing = spacing;
  double nodes = 1;
  for (int a = 0; a < 3; ++a)
    grid.origin[std::size_t(a)] = box.min()[a] - spacing * (3.07 + 0.03 * a),
    nodes *= grid.size[std::size_t(a)] = int(std::ceil(box.sizes()[a] / spacing)) + 7;
  if (nodes > max_nodes)
    throw InputError(
        fmt::format("a grid of {:g} mm is too fine for a surface {:.1f} mm across; choose a larger --rebuild", spacing,
                    box.diagonal().norm()));
  Mask mask = inside_of(m, grid);
  mask = mesh_tool::fill_holes(grid, mesh_tool::largest_component(grid, mask));
  Field inside = mesh_tool::signed_distance(grid, mask);
  // Near the border the true distance is better than that of voxels.
  const BoxTree tree(std::move(boxes));
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (std::abs(inside[i]) > 1.5 * spacing) continue;
    const auto n0 = std::size_t(grid.size[0]), n1 = std::size_t(grid.size[1]);
    const auto q = grid.point(int(i % n0), int(i / n0 % n1), int(i / (n0 * n1)));
    const Vec3 p(q[0], q[1], q[2]);
    const auto distance2 = [&](int t) {
      const auto& tri = m.triangles[std::size_t(t)];
      return (nearest_on_triangle(p, m.vertices[std::size_t(tri[0])], m.vertices[std::size_t(tri[1])],
                                  m.vertices[std::size_t(tri[2])]) -
              p)
          .squaredNorm();
    };
    const double d = std::sqrt(distance2(tree.nearest(p, distance2)));
    if (d < 1.5 * spacing) inside[i] = float(mask[i] ? d : -d);
  }
  TriMesh out = zero_set(grid, inside, notes);
  if (out.triangles.empty())
    throw InputError("nothing is left of the surface on that grid: it encloses nothing, or the grid is too coarse");
  return evened(out);
}

}  // namespace insula::case_builder
