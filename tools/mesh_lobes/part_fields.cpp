// SPDX-License-Identifier: GPL-3.0-or-later
// Level functions of the parts of a label volume.
#include "part_fields.h"

#include <algorithm>
#include <stdexcept>

#include "grid_ops.h"

namespace insula::mesh_tool {
namespace {

Grid make_grid(const NiftiVolume& labels, const FieldOptions& options) {
  Vec3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
  for (int corner = 0; corner < 8; ++corner) {
    double ijk[3];
    for (int a = 0; a < 3; ++a) ijk[a] = (corner >> a) & 1 ? labels.size[static_cast<std::size_t>(a)] - 1 : 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double* m = &labels.to_world[4 * a];
      const double w = m[0] * ijk[0] + m[1] * ijk[1] + m[2] * ijk[2] + m[3];
      low[a] = std::min(low[a], w);
      high[a] = std::max(high[a], w);
    }
  }
  Grid grid;
  grid.spacing = options.spacing;
  constexpr double margin = 5;  // room for closings and for kernels beyond the region
  for (std::size_t a = 0; a < 3; ++a) {
    if (options.radius > 0) {
      low[a] = std::max(low[a], options.centre[a] - options.radius);
      high[a] = std::min(high[a], options.centre[a] + options.radius);
    }
    if (high[a] <= low[a]) throw std::runtime_error("the region of interest lies outside the label volume");
    grid.origin[a] = low[a] - margin;
    grid.size[a] = static_cast<int>(std::ceil((high[a] - low[a] + 2 * margin) / grid.spacing)) + 1;
  }
  if (grid.count() > (std::size_t{1} << 28)) throw std::runtime_error("the working grid is too fine for this region");
  return grid;
}

template <class F>
void for_nodes(const Grid& g, F&& f) {
  for (int k = 0; k < g.size[2]; ++k)
    for (int j = 0; j < g.size[1]; ++j)
      for (int i = 0; i < g.size[0]; ++i) f(g.index(i, j, k), g.point(i, j, k));
}

double smoothstep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

// Class of each node: part number from 1, parts + 1 for any other label, 0 without a label.
std::vector<unsigned char> classify(const Grid& grid, const NiftiVolume& labels, const std::vector<Part>& parts) {
  std::vector<unsigned char> out(grid.count(), 0);
  for_nodes(grid, [&](std::size_t n, const Vec3& p) {
    const int label = static_cast<int>(std::lround(labels.nearest(p)));
    if (!label) return;
    out[n] = static_cast<unsigned char>(parts.size() + 1);
    for (std::size_t a = 0; a < parts.size(); ++a)
      if (std::find(parts[a].labels.begin(), parts[a].labels.end(), label) != parts[a].labels.end())
        out[n] = static_cast<unsigned char>(a + 1);
  });
  return out;
}

// Removes seeds near labels of another class, and seeds outside tissue.
std::vector<unsigned char> make_seeds(const Grid& grid, const std::vector<unsigned char>& classes, int class_count,
                                      const Field& tissue, double depth) {
  std::vector<unsigned char> seeds(classes.size(), 0);
  Mask set(classes.size());
  for (int c = 1; c <= class_count; ++c) {
    for (std::size_t i = 0; i < set.size(); ++i) set[i] = classes[i] && classes[i] != c;
    const Field d = distance_to(grid, set);
    for (std::size_t i = 0; i < set.size(); ++i)
      if (classes[i] == c && tissue[i] > 0 && static_cast<double>(d[i]) > depth)
        seeds[i] = static_cast<unsigned char>(c);
  }
  return seeds;
}

/// The tissue of a head, and the part of each node of the grid.
struct Tissue {
  Field level;                       ///< positive inside
  std::vector<unsigned char> owner;  ///< number of the part plus one; 0: none
  Field region;                      ///< positive in the region of interest
};

/// Computes the level from the intensity (with sub-voxel resolution), or from the labels alone.
Tissue find_tissue(const Grid& grid, const NiftiVolume& labels, const NiftiVolume* intensity,
                   const std::vector<Part>& parts, const FieldOptions& options) {
  const std::size_t n = grid.count();
  const auto classes = classify(grid, labels, parts);
  Tissue out{Field(n), {}, Field(n, 1e3f)};
  Field cost(n, 1.0f);
  if (intensity) {
    for_nodes(grid, [&](std::size_t i, const Vec3& p) { out.level[i] = intensity->linear(p); });
    for (std::size_t i = 0; i < n; ++i) {
      const double above = (static_cast<double>(out.level[i]) - options.tissue) / options.tissue_slope;
      // A path through dark sulci costs up to 40 times a path through tissue, so borders between parts lie in them.
      cost[i] = static_cast<float>(1 + 40 * (1 - smoothstep((above + 0.3) / 1.0)));
      out.level[i] = static_cast<float>(std::clamp(above, -3.0, 3.0));
    }
  } else {
    Mask any(n);
    for (std::size_t i = 0; i < n; ++i) any[i] = classes[i] != 0;
    out.level = signed_distance(grid, any);
  }
  const int class_count = static_cast<int>(parts.size()) + 1;
  out.owner = grow(grid, make_seeds(grid, classes, class_count, out.level, options.seed_depth), cost);
  if (options.radius > 0)
    for_nodes(grid, [&](std::size_t i, const Vec3& p) {
      out.region[i] = static_cast<float>(options.radius - norm(p - options.centre));
    });
  return out;
}

/// Removes islands from a level and fills its cavities. Returns the mask of the result.
Mask cleaned(const Grid& grid, Field& level) {
  Mask mask(grid.count());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = level[i] > 0;
  Mask kept = fill_holes(grid, largest_component(grid, mask));
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] && !kept[i]) level[i] = -0.25f;  // an island
    if (!mask[i] && kept[i]) level[i] = 0.25f;   // a cavity
  }
  return kept;
}

/// Closes small sulci and holes of the tissue `mask`. Then cuts out, cleans and smooths the part.
Field fine_level(const Grid& grid, const Tissue& tissue, const Mask& mask, const Field& own,
                 const FieldOptions& options) {
  const std::size_t n = grid.count();
  const float slack = 0.3f;  // mm; closing and opening do not change a flat surface
  const float half_gap = static_cast<float>(options.gap / 2);
  const Field closed = closing_level(grid, mask, options.fine_closing);
  Field fine(n);
  for (std::size_t i = 0; i < n; ++i)
    fine[i] =
        std::min({std::max(tissue.level[i], std::min(closed[i] - slack, 0.5f)), own[i] - half_gap, tissue.region[i]});
  smooth(grid, fine, options.smoothing);
  // Opening is the closing of the complement with opposite sign. Pieces that it separates are removed later as
  // components.
  Mask outside(n);
  for (std::size_t i = 0; i < n; ++i) outside[i] = !(fine[i] > 0);
  const Field opened = closing_level(grid, outside, options.fine_opening);
  if (options.fine_opening > 0)
    for (std::size_t i = 0; i < n; ++i) fine[i] = std::min(fine[i], std::max(slack - opened[i], -0.5f));
  smooth(grid, fine, options.smoothing / 2);
  return fine;
}

/// The level for tetrahedra: coarser, and slightly outside of the fine level.
Field coarse_level(const Grid& grid, const Tissue& tissue, const Mask& fine, const Field& own,
                   const FieldOptions& options) {
  Field coarse = closing_level(grid, fine, options.coarse_closing);
  smooth(grid, coarse, options.coarse_smoothing);
  const float outset = static_cast<float>(options.coarse_outset), apart = static_cast<float>(options.coarse_gap);
  for (std::size_t i = 0; i < coarse.size(); ++i)
    coarse[i] = std::min({coarse[i] + outset, own[i] - apart, tissue.region[i] + outset});
  cleaned(grid, coarse);
  return coarse;
}

}  // namespace

void add_labels(NiftiVolume& labels, const NiftiVolume& more, const std::vector<Part>& parts) {
  constexpr int first = 1000;
  const auto wanted = [&](int label) {
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) {
      return std::find(p.labels.begin(), p.labels.end(), label) != p.labels.end();
    });
  };
  std::size_t n = 0;
  const double* m = labels.to_world.data();
  for (int k = 0; k < labels.size[2]; ++k)
    for (int j = 0; j < labels.size[1]; ++j)
      for (int i = 0; i < labels.size[0]; ++i, ++n) {
        Vec3 p{};
        for (std::size_t a = 0; a < 3; ++a) p[a] = m[4 * a] * i + m[4 * a + 1] * j + m[4 * a + 2] * k + m[4 * a + 3];
        const int other = static_cast<int>(std::lround(more.nearest(p)));
        if (other > 0 && wanted(first + other)) labels.value[n] = static_cast<float>(first + other);
      }
}

PartFields build_part_fields(const NiftiVolume& labels, const NiftiVolume* intensity, const std::vector<Part>& parts,
                             const FieldOptions& options) {
  if (parts.empty() || parts.size() > 200) throw std::runtime_error("between 1 and 200 parts are needed");
  PartFields out;
  out.grid = make_grid(labels, options);
  const Grid& grid = out.grid;
  const std::size_t n = grid.count();
  const Tissue tissue = find_tissue(grid, labels, intensity, parts, options);
  std::vector<Field> own(parts.size());
  std::vector<Mask> masks(parts.size());
  Mask mask(n);
  for (std::size_t a = 0; a < parts.size(); ++a) {
    for (std::size_t i = 0; i < n; ++i) mask[i] = tissue.owner[i] == a + 1;
    own[a] = signed_distance(grid, mask);
    smooth(grid, own[a], options.border_smoothing);
    for (std::size_t i = 0; i < n; ++i) mask[i] = mask[i] && tissue.level[i] > 0;
    Field fine = fine_level(grid, tissue, mask, own[a], options);
    masks[a] = cleaned(grid, fine);
    if (std::none_of(masks[a].begin(), masks[a].end(), [](unsigned char c) { return c != 0; }))
      throw std::runtime_error("part " + parts[a].name + " is empty in the region of interest");
    out.fine.push_back(std::move(fine));
  }
  for (std::size_t a = 0; a < parts.size(); ++a) {
    out.coarse.push_back(coarse_level(grid, tissue, masks[a], own[a], options));
    for (std::size_t i = 0; i < n; ++i) {
      mask[i] = 0;
      for (std::size_t b = 0; b < parts.size(); ++b) mask[i] = mask[i] || (b != a && masks[b][i]);
    }
    out.others.push_back(distance_to(grid, mask));
  }
  return out;
}

}  // namespace insula::mesh_tool
