// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/tidy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/grid_surface.h"
#include "tools/case_builder/openings.h"
#include "tools/case_builder/surface_input.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

/// A fault that only a grid mends.
struct WallsMeet : InputError {
  using InputError::InputError;
};

/// Throws WallsMeet, InputError.
void tidy(TriMesh& m, const std::string& what, const Options& o, std::vector<Note>& notes) {
  const double size = extent_of(m);
  if (const int n = weld(m, 1e-6 * size); n > 0)
    notes.push_back({Note::Kind::repair,
                     fmt::format("{} vertices that lay on others to a millionth of the size were joined.", n), ""});
  if (const int n = drop_doubles(m); n > 0)
    notes.push_back({Note::Kind::repair,
                     fmt::format("{} triangle{} that {} there twice {} left out.", n, ending(n),
                                 n == 1 ? "was" : "were", n == 1 ? "was" : "were"),
                     ""});
  if (m.triangles.empty()) throw InputError(what + ": holds no triangle with an area");
  if (const BadEdges bad = non_manifold_edges(m); bad.count > 0)
    throw WallsMeet(
        fmt::format("{}: {} edge{} to three or more triangles (the first at {}): walls meet there inside of "
                    "the vessel.",
                    what, bad.count, bad.count == 1 ? " belongs" : "s belong", place(bad.first)));
  Pieces pieces = pieces_of(m);
  if (pieces.area.size() > 1) {
    double whole = 0;
    for (const double a : pieces.area) whole += a;
    int keep = 0;
    if (o.seed) {
      const Vec3 seed((*o.seed)[0], (*o.seed)[1], (*o.seed)[2]);
      double least = 1e300;
      for (std::size_t t = 0; t < m.triangles.size(); ++t)
        if (const double d = (m.vertices[std::size_t(m.triangles[t][0])] - seed).norm(); d < least)
          least = d, keep = pieces.of[t];
    } else if (pieces.area[0] < 0.9 * whole && !o.keep_largest) {
      throw InputError(
          fmt::format("{}: is in {} pieces; the largest has {:.0f} % of the area, the next {:.0f} %. Name a point on "
                      "the wanted one with --seed \"X Y Z mm\", or take the largest with --keep-largest",
                      what, pieces.area.size(), 100 * pieces.area[0] / whole, 100 * pieces.area[1] / whole));
    }
    notes.push_back(
        {Note::Kind::repair,
         fmt::format("The surface was in {} pieces; the {} one was kept, {:.1f} % of the area.", pieces.area.size(),
                     o.seed ? "wanted" : "largest", 100 * pieces.area[std::size_t(keep)] / whole),
         ""});
    keep_piece(m, pieces, keep);
  }
  const int turned = agree(m);
  if (turned < 0)
    throw InputError(what + ": its surface has only one side (a twisted band); mend it in the program that made it");
  if (turned > 0)
    notes.push_back({Note::Kind::repair,
                     fmt::format("{} triangle{} that faced the wrong way {} turned.", turned, ending(turned),
                                 turned == 1 ? "was" : "were"),
                     ""});
  if (const int n = part_fans(m); n > 0)
    notes.push_back({Note::Kind::repair,
                     fmt::format("{} place{} where the surface touched itself in a point {} parted.", n, ending(n),
                                 n == 1 ? "was" : "were"),
                     ""});
}

}  // namespace

namespace {

/// Cuts where a cap was. A place in the noise that only looked like a flat end would take much of the vessel with it:
/// it is left.
void cut_again(artery::Surface& s, const artery::CapPlane& cap, double spacing) {
  artery::Surface shorter = s;
  try {
    cut_off(shorter, cap.centre - spacing * cap.normal, cap.normal, cap.name);
  } catch (const InputError&) {
    return;  // no single tube there
  }
  const double of_cap = std::numbers::pi * cap.radius * cap.radius,
               of_rim = 2 * std::numbers::pi * cap.radius * spacing;
  if (area(s.mesh) - area(shorter.mesh) < of_cap + 8 * of_rim) s = std::move(shorter);
}

}  // namespace

double usual_spacing(const TriMesh& m) { return std::clamp(std::sqrt(area(m) / 20000), 0.08, 0.4); }

void make_anew(artery::Surface& s, const std::string& why, const std::string& what, const Options& o,
               std::vector<Note>& notes) {
  const std::vector<artery::CapPlane> caps = s.caps;
  const double spacing = usual_spacing(s.mesh);
  TriMesh m = rebuilt(s.mesh, spacing, notes);
  tidy(m, what, o, notes);
  s = artery::Surface{m, std::vector<int>(m.triangles.size(), -1), {}};
  for (const artery::CapPlane& cap : caps) cut_again(s, cap, spacing);
  notes.push_back({Note::Kind::repair,
                   fmt::format("{}; it was made anew from a grid of {:.2g} mm: {} triangles.", why, spacing,
                               s.mesh.triangles.size()),
                   ""});
}

void tidy_or_rebuild(TriMesh& m, const std::string& what, const Options& o, std::vector<Note>& notes) {
  const TriMesh given = m;
  const std::vector<Note> before = notes;
  try {
    tidy(m, what, o, notes);
    return;
  } catch (const WallsMeet& e) {
    if (o.rebuild) throw;
    notes = before;
    m = rebuilt(given, usual_spacing(given), notes);
    notes.push_back(
        {Note::Kind::repair,
         fmt::format("{} The surface was made anew from a grid of {:.2g} mm.", e.what(), usual_spacing(given)), ""});
  }
  tidy(m, what, o, notes);
}

}  // namespace insula::case_builder
