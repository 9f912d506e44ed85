// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/assignment.h"
#include "tools/case_builder/brain.h"
#include "tools/case_builder/fissure.h"
#include "tools/case_builder/grid_surface.h"
#include "tools/case_builder/mirror.h"
#include "tools/case_builder/size_check.h"
#include "tools/case_builder/solid.h"
#include "tools/case_builder/surface_input.h"
#include "tools/case_builder/topology.h"
#include "tools/case_builder/volume_input.h"
#include "tools/mesh_lobes/labels.h"
#ifdef INSULA_WITH_ITK
#include "tools/case_builder/volume_reader.h"
#endif

namespace insula::case_builder {
namespace {

constexpr double grid_spacing = 0.7;  // mm, of the labels that surfaces are turned into

bool is_lobe(const Approach& approach, const std::string& name) {
  const auto parts = approach.parts();
  return std::find(parts.begin(), parts.end(), name) != parts.end();
}

/// "NAME=REST", or an empty name.
Assignment named(const std::string& text) { return read_assignment(text).value_or(Assignment{"", text}); }

TriMesh read_lobe_surface(const fs::path& file, const std::string& what, const Options& o, std::vector<Note>& notes) {
  if (!fs::exists(file)) fail(file, "does not exist");
  const double unit = unit_mm(file, o.brain_unit_mm);
  TriMesh m = read_any_surface(file, unit);
  if (o.mirror) mirror(m);
  const double extent = extent_of(m);
  if (const std::string why = check_brain(extent, unit); !why.empty()) fail(file, why);
  weld(m, 1e-6 * extent);
  drop_doubles(m);
  if (m.triangles.empty()) fail(file, "holds no triangle with an area");
  if (const BadEdges bad = non_manifold_edges(m); bad.count > 0)
    fail(file, fmt::format("{} edges belong to three or more triangles: mend it in the program that made it, or give "
                           "labels of a volume",
                           bad.count));
  const Pieces pieces = pieces_of(m);
  double whole = 0;
  for (const double a : pieces.area) whole += a;
  if (pieces.area.size() > 1) {
    if (pieces.area[0] < 0.9 * whole)
      fail(
          file,
          fmt::format(
              "is in {} pieces; the largest has {:.0f} % of the area: leave the others out in the program that made it",
              pieces.area.size(), 100 * pieces.area[0] / whole));
    keep_piece(m, pieces, 0);
    notes.push_back({Note::Kind::repair,
                     fmt::format("{}: of {} pieces the largest was kept, {:.1f} % of the area.", what,
                                 pieces.area.size(), 100 * pieces.area[0] / whole),
                     ""});
  }
  if (const std::size_t holes = border_loops(m).size(); holes > 0)
    fail(file, fmt::format("is not closed: it has {} hole{}. A lobe is given by one closed surface; close it in the "
                           "program that made it",
                           holes, holes == 1 ? "" : "s"));
  return m;
}

/// An empty volume of labels about the fissure, of a brain that stays in its place or may be moved.
mesh_tool::NiftiVolume blank(mesh_tool::Grid& grid, const Approach& approach, bool in_place) {
  // Room for the move that may lay the fissure over the shipped one.
  const double reach = approach.radius + 3 + (in_place ? 0 : farthest_move);
  const int n = int(std::ceil(2 * reach / grid_spacing)) + 1;
  grid.size = {n, n, n}, grid.spacing = grid_spacing;
  mesh_tool::NiftiVolume v;
  v.size = grid.size;
  v.value.assign(grid.count(), 0.0f);
  for (std::size_t a = 0; a < 3; ++a) {
    grid.origin[a] = approach.centre[Eigen::Index(a)] - reach;
    v.to_world[5 * a] = grid_spacing, v.from_world[5 * a] = 1 / grid_spacing;
    v.to_world[4 * a + 3] = grid.origin[a], v.from_world[4 * a + 3] = -grid.origin[a] / grid_spacing;
  }
  return v;
}

BrainLabels of_surfaces(const std::map<std::string, std::string>& files, const Options& o, const Approach& approach,
                        std::vector<Note>& notes) {
  BrainLabels out;
  mesh_tool::Grid grid;
  out.volume = blank(grid, approach, o.brain_in_place);
  std::size_t twice = 0, all = 0;
  for (int k = 0; k < 3; ++k) {
    const std::string name = approach.parts()[std::size_t(k)];
    const auto at = files.find(name);
    if (at == files.end())
      throw InputError("--brain: there is no " + name +
                       "; give the three of them: --brain frontal=FILE --brain temporal=FILE --brain insula=FILE");
    const mesh_tool::Mask inside = inside_of(read_lobe_surface(at->second, name, o, notes), grid);
    for (std::size_t i = 0; i < inside.size(); ++i) {
      if (!inside[i]) continue;
      ++all, twice += out.volume.value[i] > 0;
      if (out.volume.value[i] == 0) out.volume.value[i] = float(k + 1);
    }
    out.parts.push_back({name, {k + 1}});
  }
  if (double(twice) > 0.02 * double(all))
    notes.push_back({Note::Kind::repair,
                     fmt::format("The lobes' surfaces overlap in {:.1f} % of their volume; it went to the one named "
                                 "first of frontal, temporal, insula.",
                                 100 * double(twice) / double(all)),
                     ""});
  return out;
}

BrainLabels of_one_surface(const fs::path& file, const Options& o, const fs::path& project, const Approach& approach,
                           std::vector<Note>& notes) {
  BrainLabels out;
  mesh_tool::Grid grid;
  out.own_fissure = false;
  out.volume = blank(grid, approach, true);
  const mesh_tool::Mask inside = inside_of(read_lobe_surface(file, "brain", o, notes), grid);
  const Fissure shipped = read_fissure(project, {}, approach);
  const Vec3 reach = Vec3::Constant(approach.radius + 4);
  std::vector<DistanceGrid> near;
  for (int k = 0; k < 3; ++k) {
    const TriMesh* surface = &shipped.floor;
    for (const Lobe& l : shipped.lobes)
      if (l.name == approach.parts()[std::size_t(k)]) surface = &l.surface;
    near.emplace_back(Solid(*surface), approach.centre - reach, approach.centre + reach, 2.0, 40.0);
    out.parts.push_back({approach.parts()[std::size_t(k)], {k + 1}});
  }
  const auto n0 = std::size_t(grid.size[0]), n1 = std::size_t(grid.size[1]);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside[i]) continue;
    const auto q = grid.point(int(i % n0), int(i / n0 % n1), int(i / (n0 * n1)));
    const Vec3 p(q[0], q[1], q[2]);
    int best = 0;
    for (int k = 1; k < 3; ++k)
      if (near[std::size_t(k)].at(p) < near[std::size_t(best)].at(p)) best = k;
    out.volume.value[i] = float(best + 1);
  }
  notes.push_back({Note::Kind::fact,
                   "The brain was given as one surface: its lobes are told apart by the nearest of the shipped ones, "
                   "with a cleft between them.",
                   ""});
  return out;
}

BrainLabels of_volume(const fs::path& file, const Options& o, const Approach& approach) {
  BrainLabels out;
  std::map<std::string, std::vector<int>> labels;
  std::map<int, std::string> lobe_of;
  for (const std::string& text : o.lobe_labels) {
    const auto [name, list] = named(text);
    if (!is_lobe(approach, name))
      throw InputError("--lobe: " + in_quotes(text) +
                       " names no lobe; write frontal=LABELS, temporal=LABELS, insula=LABELS");
    if (labels.contains(name)) throw InputError("--lobe: the " + name + " is given twice");
    try {
      labels[name] = mesh_tool::label_list(list);
    } catch (const std::runtime_error& e) {
      throw InputError("--lobe " + name + ": " + e.what());
    }
    for (const int k : labels[name])
      if (const auto [at, fresh] = lobe_of.emplace(k, name); !fresh && at->second != name)
        throw InputError(fmt::format("--lobe: the label {} is given to the {} and to the {}", k, at->second, name));
  }
  for (const std::string& name : approach.parts())
    if (!labels.contains(name))
      fail(file, "is a volume: say which labels are the " + name + ", such as --lobe " + name + "=2,4,10-16");
#ifdef INSULA_WITH_ITK
  out.volume = read_volume(file);
  if (o.mirror) mirror(out.volume);
#else
  fail(file, "volumes need ITK (Debian: libinsighttoolkit5-dev), which was not there when this program was built");
#endif
  std::set<float> there;
  for (const float v : out.volume.value) {
    if (v == 0) continue;
    if (v != std::floor(v) || v < 0) fail(file, "holds values that are no labels: whole numbers from 0 up");
    if (there.insert(v).second && there.size() > 4000)
      fail(file, "has more than 4,000 values: it is no volume of labels");
  }
  for (const std::string& name : approach.parts()) {
    const std::vector<int>& list = labels[name];
    if (std::none_of(list.begin(), list.end(), [&](int k) { return there.contains(float(k)); })) {
      std::string known;
      for (const float v : there) known += (known.empty() ? "" : ", ") + std::to_string(int(v));
      fail(file, "none of the labels of the " + name + " is there; there are: " + shown(known));
    }
    out.parts.push_back({name, list});
  }
  return out;
}

}  // namespace

BrainLabels read_brain(const Options& o, const fs::path& project, const Approach& approach, std::vector<Note>& notes) {
  std::map<std::string, std::string> files;
  for (const std::string& text : o.brain) {
    auto [name, file] = named(text);
    if (!name.empty() && !is_lobe(approach, name))
      throw InputError("--brain: " + in_quotes(name) + " is no lobe; frontal, temporal and insula are");
    if (!files.emplace(name, file).second)
      throw InputError(name.empty() ? "--brain takes one file, or NAME=FILE for each lobe"
                                    : "--brain: the " + name + " is given twice");
  }
  if (!files.contains("")) return of_surfaces(files, o, approach, notes);
  if (files.size() > 1) throw InputError("--brain takes one file, or NAME=FILE for each lobe, not both");
  const fs::path file = files[""];
  if (is_volume_input(file)) return of_volume(file, o, approach);
  if (!o.lobe_labels.empty()) fail(file, "is a surface; --lobe is for volumes of labels");
  return of_one_surface(file, o, project, approach, notes);
}

}  // namespace insula::case_builder
