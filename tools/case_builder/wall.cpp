// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/wall.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "core/model/wall_model.h"
#include "tools/artery/import_parts.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/mirror.h"
#include "tools/case_builder/openings.h"
#include "tools/case_builder/region_walls.h"
#include "tools/case_builder/thin_branch.h"
#include "tools/case_builder/tidy.h"
#include "tools/case_builder/trim.h"
#include "tools/case_builder/wall_patches.h"

namespace insula::case_builder {
namespace {

using artery::Vessel;

/// Names of caps as the network wants them; the inlet first.
artery::Surface with_inlet_first(artery::Surface s, const Options& o) {
  std::size_t inlet = 0;
  for (std::size_t c = 0; c < s.caps.size(); ++c) {
    if (s.caps[c].radius > s.caps[inlet].radius) inlet = c;
  }
  if (o.inlet) {
    const Vec3 p((*o.inlet)[0], (*o.inlet)[1], (*o.inlet)[2]);
    for (std::size_t c = 0; c < s.caps.size(); ++c)
      if ((s.caps[c].centre - p).norm() < (s.caps[inlet].centre - p).norm()) inlet = c;
  }
  std::swap(s.caps[0], s.caps[inlet]);
  for (int& p : s.patch) p = p == 0 ? int(inlet) : p == int(inlet) ? 0 : p;
  return s;
}

std::optional<artery::NeckPlane> wanted_neck(const Options& o) {
  if (!o.neck) return std::nullopt;
  const Plane& p = *o.neck;
  if (std::hypot(p[3], p[4], p[5]) < 1e-9) throw InputError("--neck: the normal has no length");
  return artery::NeckPlane{Vec3(p[0], p[1], p[2]), Vec3(p[3], p[4], p[5]).normalized()};
}

/// The plane through two points on opposite sides of a neck, turned from the proposed one as little as that asks for.
artery::NeckPlane through(const std::array<double, 6>& two, const Vec3& normal) {
  const Vec3 a(two[0], two[1], two[2]), b(two[3], two[4], two[5]);
  if ((b - a).norm() < 0.3) throw InputError("--neck-points: the two points are closer than 0.3 mm");
  const Vec3 along = (b - a).normalized(), n = normal - normal.dot(along) * along;
  if (n.norm() < 0.2)
    throw InputError(
        "--neck-points: the two points lie above one another as seen from the dome; take two on opposite sides of the "
        "neck");
  return {0.5 * (a + b), n.normalized()};
}

Vessel made(const artery::Surface& s, const artery::ImportOptions& options) {
  try {
    return artery::vessel_of(s, options);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw InputError(e.what());
  }
}

/// Cuts off the branch that has no centreline to its end, or throws that again if the vessel needs it.
void cut_off_lost(artery::Surface& s, const artery::LostOutlet& lost, std::vector<Note>& notes) {
  const auto cap = std::min_element(s.caps.begin(), s.caps.end(), [&](const auto& a, const auto& b) {
    return (a.centre - lost.centre).norm() < (b.centre - lost.centre).norm();
  });
  if (s.caps.size() < 3 || cap == s.caps.begin() || !remove_branch(s, std::size_t(cap - s.caps.begin()))) throw lost;
  notes.push_back({Note::Kind::repair,
                   fmt::format("The branch that ends at {} is too thin on its way for blood to be followed. It was "
                               "cut off where it begins.",
                               place(lost.centre)),
                   "If it matters, make it wider in the program that made the surface."});
}

/// The vessel without the branches that are too thin on their way for a centreline.
Vessel made_of_wide_ones(artery::Surface& s, const artery::ImportOptions& options, std::vector<Note>& notes) {
  while (true) {
    try {
      return made(s, options);
    } catch (const artery::LostOutlet& lost) {
      cut_off_lost(s, lost, notes);
    }
  }
}

/// Whether no two caps overlap, as they do where a vessel is cut through a fork.
bool caps_apart(const artery::Surface& s) {
  for (const artery::CapPlane& a : s.caps)
    for (const artery::CapPlane& b : s.caps)
      if (&a < &b && (a.centre - b.centre).norm() < a.radius + b.radius) return false;
  return true;
}

/// Cut `keep` along the centrelines from the neck, or less where a fork lies there.
artery::Surface shortened(const artery::Surface& s, const std::vector<artery::NamedCurve>& lines, const Vec3& neck,
                          double keep, std::vector<Note>& notes) {
  constexpr double step = 1, least = 0.6;
  const std::vector<Note> before = notes;
  for (double shorter = keep; shorter > least * keep; shorter -= step) {
    artery::Surface out = trimmed(s, lines, neck, shorter, notes);
    if (caps_apart(out)) return out;
    notes = before;
  }
  return trimmed(s, lines, neck, keep, notes);
}

/// The shorter vessel, with the neck in the same place, now on finer triangles. A proposed plane that parts no dome
/// there, as where a branch begins at its edge, is looked for again.
Vessel made_again(const artery::Surface& s, artery::ImportOptions options, const artery::NeckPlane& neck,
                  const std::vector<artery::NeckProposal>& proposals) {
  const auto as_before = [&] {
    Vessel v = made(s, options);
    v.proposals = proposals;
    return v;
  };
  if (options.neck) return as_before();
  if (!proposals.empty() && proposals.front().planar) {
    options.neck = neck;
    try {
      return as_before();
    } catch (const InputError&) {
      options.neck.reset();
    }
  }
  return made(s, options);
}

/// Thrown where parts of the wall cross.
struct CrossedWall : InputError {
  using InputError::InputError;
};

void check_sound(const Vessel& v) {
  const artery::Quality q = artery::quality(v.wall.mesh);
  if (!q.closed || q.components != 1)
    throw InputError(
        "the wall that was made is not closed; make the surface anew from a grid with --rebuild \"0.2 mm\"");
  if (q.euler != 2)
    throw InputError(
        "the wall has a hole through it (branches that have grown together); part them in the program that made the "
        "surface");
  if (q.self_intersecting)
    throw CrossedWall(
        "the wall runs through itself: parts of the vessel are closer than its triangles are long. Give it more "
        "vertices (--vertices 2500), or make the surface anew from a grid with --rebuild \"0.2 mm\"");
}

/// What the neck is: the author's, or the proposal that was taken.
Note neck_note(const Vessel& v) {
  if (v.proposals.empty()) return {Note::Kind::fact, "The neck is where it was asked for.", ""};
  const bool by_line = v.proposals.front().method == "shortest line";
  return {Note::Kind::fact,
          by_line ? "Neck and sac are a proposal: the shortest line around what bulges out of the vessels."
                  : "Neck and sac are a proposal: the narrowest section near the border of what bulges out of the "
                    "vessels.",
          "Look at the pictures; move the neck with --neck \"X Y Z mm NX NY NZ\" or --neck-points."};
}

Vessel wall_of(const artery::Surface& surface, const Options& o, std::vector<Note>& notes, Progress& progress) {
  artery::Surface s = with_inlet_first(surface, o);
  artery::ImportOptions options;
  options.vertices = o.wall_vertices();
  options.neck = wanted_neck(o);
  progress.step("centrelines and proposed neck");
  Vessel v = made_of_wide_ones(s, options, notes);
  if (o.neck_points) {
    if (!v.neck)
      throw InputError("--neck-points turns the proposed neck, and none was found; give the whole plane with --neck");
    options.neck = through(*o.neck_points, v.neck->normal);
    v = made(s, options);
  }
  if (!v.neck)
    throw InputError(
        "no sac was found: nothing of the wall bulges out of the vessels by half of their radius. If there is an "
        "aneurysm, give its neck: --neck \"X Y Z mm NX NY NZ\" (a point in the neck and the direction to the dome)");
  const std::vector<artery::NeckProposal> proposals = v.proposals;
  if (o.keep > 0) {
    progress.step("cutting the ends");
    const std::size_t before = notes.size();
    const artery::NeckPlane neck{v.neck->centre, v.neck->normal};
    const artery::Surface shorter = shortened(s, v.centrelines, neck.centre, o.keep, notes);
    if (notes.size() > before) {
      s = shorter;
      options.inlet = v.wall.caps[0].centre;  // the piece of the old inlet that is left is the nearest to it
      progress.step("the wall's triangles");
      v = made_again(s, options, neck, proposals);
    }
  }
  if (v.wall.caps.size() < 2)
    throw InputError("only one opening is left after cutting the ends; keep more of the vessel with --keep");
  progress.step("checks");
  if (o.bleb > 0) {
    artery::add_bleb(v, o.bleb);
    artery::measure(v);
    notes.push_back(
        {Note::Kind::fact,
         fmt::format("The weak spot is the tip of the dome, {:g} mm around: a proposal, change it with --bleb.",
                     o.bleb),
         ""});
  }
  check_sound(v);
  notes.push_back(neck_note(v));
  return v;
}

/// With shorter vessels where the wall would cross itself far from the neck.
Vessel uncrossed_wall_of(const artery::Surface& surface, const Options& o, std::vector<Note>& notes,
                         Progress& progress) {
  const std::vector<Note> before = notes;
  const auto kept = [&](double share) {
    notes = before;
    Options shorter = o;
    shorter.keep = share * o.keep;
    if (share < 1)
      notes.push_back({Note::Kind::repair,
                       fmt::format("Only {:.1f} mm of each vessel were kept from the neck on: farther out the wall "
                                   "would run through itself.",
                                   shorter.keep),
                       ""});
    return wall_of(surface, shorter, notes, progress);
  };
  if (!(o.keep > 0)) return kept(1);
  for (const double share : {1.0, 0.8}) try {
      return kept(share);
    } catch (const CrossedWall&) {
    }
  return kept(0.6);
}

}  // namespace

Vessel make_wall(const artery::Surface& surface, const Options& o, std::vector<Note>& notes, Progress& progress) {
  const std::vector<Note> before = notes;
  try {
    return uncrossed_wall_of(surface, o, notes, progress);
  } catch (const InputError& e) {
    if (o.neck || o.neck_points) throw;
    // The given triangles may be at fault: once more with those of a grid.
    notes = before;
    artery::Surface again = surface;
    try {
      make_anew(again, fmt::format("The given triangles made no wall ({})", e.what()), "the wall", o, notes);
      return uncrossed_wall_of(again, o, notes, progress);
    } catch (const std::runtime_error&) {
      throw InputError(e.what());
    }
  }
}

Json neck_json(const Vessel& v, bool mirrored) {
  Json out;
  out["confidence"] = rounded(artery::neck_confidence(v.proposals));
  out["proposals"] = Json::array();
  for (const artery::NeckProposal& p : v.proposals) {
    Vec3 c = p.plane.centre, n = p.plane.normal;
    if (mirrored) c.x() = -c.x(), n.x() = -n.x();
    out["proposals"].push_back({{"method", p.method},
                                {"diameter_mm", rounded(p.diameter)},
                                {"agreement", rounded(p.agreement)},
                                {"planar", p.planar},
                                {"centre", to_json(c)},
                                {"normal", to_json(n)},
                                {"option", fmt::format("{:.2f} {:.2f} {:.2f} mm {:.3f} {:.3f} {:.3f}", c.x(), c.y(),
                                                       c.z(), n.x(), n.y(), n.z())}});
  }
  return out;
}

Vessel with_proposals(const artery::Surface& surface, const Options& o) {
  artery::ImportOptions options;
  options.vertices = o.wall_vertices();
  artery::Surface s = with_inlet_first(surface, o);
  std::vector<Note> ignored;
  return made_of_wide_ones(s, options, ignored);
}

namespace {
Note coarser_note(const Options& o) {
  return {Note::Kind::repair,
          fmt::format("The wall was made coarser, of about {} vertices in place of {}, so that a step is quick enough "
                      "while a clip closes.",
                      o.wall_vertices(), o.vertices),
          "To have it finer on a faster machine: insula case wall FOLDER --vertices 2000 --on"};
}
}  // namespace

void run_wall(const CaseFolder& folder, const Options& o, Progress& progress) {
  progress.stage("wall", 5);
  const Intake in = read_intake(folder);
  std::vector<Note> notes;
  const Options read = as_read(o);
  const Vessel v = make_wall(in.surface, read, notes, progress);
  if (o.coarser && !o.keep_vertices) notes.push_back(coarser_note(o));
  progress.step("writing");
  artery::write_vessel(v, folder.wall());
  Json json;
  Json openings = Json::array();
  for (const auto& cap : v.wall.caps) openings.push_back({{"name", cap.name}, {"calibre_mm", rounded(2 * cap.radius)}});
  json["openings"] = openings;
  json["walls"] = to_json(walls_of(v, o));
  json["patches"] = to_json(patches_of(v, read, notes));
  json["proposed_walls"] = to_json(walls_of(v, {}));
  json["neck"] = neck_json(v, o.mirror);
  json["notes"] = to_json(notes);
  write_json(folder.wall() / "notes.json", json);
  progress.finish();
}

Vessel read_wall(const fs::path& folder) {
  const WallModel m = insula::read_wall(folder / "vessel.json");
  Vessel v;
  v.wall.mesh = m.wall;
  for (Vec3& p : v.wall.mesh.vertices) p *= 1000;
  v.wall.patch.assign(m.wall.triangles.size(), -1);
  for (const auto& cap : m.caps) {
    artery::CapPlane plane{cap.name, Vec3::Zero(), Vec3::UnitZ(), 0};
    Vec3 twice = Vec3::Zero();
    double whole = 0;
    for (const int t : cap.triangles) {
      v.wall.patch[std::size_t(t)] = int(v.wall.caps.size());
      const auto& tri = v.wall.mesh.triangles[std::size_t(t)];
      const Vec3 &a = v.wall.mesh.vertices[std::size_t(tri[0])], &b = v.wall.mesh.vertices[std::size_t(tri[1])],
                 &c = v.wall.mesh.vertices[std::size_t(tri[2])];
      const Vec3 n = (b - a).cross(c - a);
      twice += n, whole += n.norm(), plane.centre += n.norm() * (a + b + c) / 3;
    }
    plane.centre /= whole, plane.normal = twice.normalized(),
                           plane.radius = std::sqrt(0.5 * twice.norm() / 3.14159265358979);
    v.wall.caps.push_back(plane);
  }
  v.picture = read_ply(folder / "picture.ply");
  v.regions = m.regions, v.region = m.vertex_region;
  for (const auto& l : m.centrelines) {
    artery::NamedCurve c{l.name, l.region, l.from, l.to, {l.points, l.radius}};
    for (Vec3& p : c.curve.points) p *= 1000;
    for (double& r : c.curve.radius) r *= 1000;
    v.centrelines.push_back(std::move(c));
  }
  if (m.has_neck) v.neck = artery::Neck{1000 * m.neck_centre, m.neck_normal, 1000 * m.neck_diameter};
  if (m.bleb_radius > 0) v.bleb = {1000 * m.bleb_centre, 1000 * m.bleb_radius};
  v.dome_height = 1000 * m.dome_height;
  artery::measure(v);
  return v;
}

}  // namespace insula::case_builder
