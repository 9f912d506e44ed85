// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/intake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "tools/artery/import_parts.h"
#include "tools/case_builder/blind_ends.h"
#include "tools/case_builder/grid_surface.h"
#include "tools/case_builder/mirror.h"
#include "tools/case_builder/openings.h"
#include "tools/case_builder/size_check.h"
#include "tools/case_builder/surface_input.h"
#include "tools/case_builder/tidy.h"
#include "tools/case_builder/topology.h"
#include "tools/case_builder/volume_input.h"

namespace insula::case_builder {
namespace {

constexpr std::size_t max_triangles = 2'000'000;   // what is read at all
constexpr std::size_t many_triangles = 150'000;    // more are made anew from a grid
constexpr std::uintmax_t max_bytes = 220'000'000;  // of a surface file: beyond that it has more than those triangles

/// Tells that a surface of a size that no artery has was scaled by a power of ten.
Note scaled_by(double factor, const char* what, double was) {
  return {Note::Kind::repair,
          fmt::format("The {} was {:.3g} mm across, which no cerebral artery has. Its numbers were taken {} {:g}.",
                      what, was, factor < 1 ? "divided by" : "times", factor < 1 ? 1 / factor : factor),
          "Positions that you give are in the scaled millimetres. Say the file's unit with --unit if this is wrong."};
}

TriMesh read_surface_mm(const fs::path& input, const Options& o, std::vector<Note>& notes) {
  const std::string kind = lower_extension(input);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(input, error);
  const auto too_many = [&](std::size_t n) {
    fail(input, fmt::format("has {} triangles; more than {} are not taken. An artery needs some 20,000: decimate it in "
                            "the program that made it, or cut out the region around the aneurysm",
                            n > 0 ? std::to_string(n) : "far too many", max_triangles));
  };
  if (!error && bytes > max_bytes) too_many(kind == ".stl" ? std::size_t((bytes - 84) / 50) : 0);
  if (!error && kind == ".stl" && bytes > 84 && (bytes - 84) / 50 > max_triangles) {
    std::ifstream in(input, std::ios::binary);
    char head[84] = {};
    in.read(head, 84);
    if (std::string_view(head, 5) != "solid") too_many(std::size_t((bytes - 84) / 50));
  }
  const double unit = unit_mm(input, o.unit_mm);
  if (is_in_metres(input) && !o.unit_mm)
    notes.push_back({Note::Kind::fact, "glTF is in metres by its standard; it was read so.", ""});
  TriMesh m = read_any_surface(input, unit);
  if (o.mirror) mirror(m);
  if (m.triangles.size() > max_triangles) too_many(m.triangles.size());
  if (o.any_size) return m;
  const double extent = extent_of(m);
  if (const auto factor = scale_of_extent(extent); factor && !o.unit_mm) {
    for (Vec3& p : m.vertices) p *= *factor;
    notes.push_back(scaled_by(*factor, "surface", extent));
  } else if (const std::string why = check_extent(extent, unit); !why.empty()) {
    fail(input, why + "; --any-size takes it all the same");
  }
  return m;
}

void check_inside(const artery::Surface& s, const std::string& what) {
  const double thick = 2 * signed_volume(s.mesh) / area(s.mesh);  // the radius, of a tube
  if (thick < 0.01 * extent_of(s.mesh))
    throw InputError(
        fmt::format("{}: encloses next to nothing (it is {:.3g} mm thick for {:.3g} mm of length): a sheet without "
                    "thickness, or an inner and an outer wall. A vessel is given by one surface",
                    what, 2 * thick, extent_of(s.mesh)));
}

void make_cuts(artery::Surface& s, const Options& o) {
  for (std::size_t c = 0; c < o.cuts.size(); ++c) {
    const Plane& p = o.cuts[c];
    if (std::hypot(p[3], p[4], p[5]) < 1e-9) throw InputError("--cut: the normal has no length");
    cut_off(s, Vec3(p[0], p[1], p[2]), Vec3(p[3], p[4], p[5]), fmt::format("cut_{}", c + 1));
  }
}

/// Finds the ends that are already closed flat. Returns how the openings were found, in words.
const char* add_flat_ends(artery::Surface& s) {
  const artery::Surface found = artery::with_flat_caps(s.mesh);
  if (s.caps.empty()) {
    s = found;
    return "flat ends of a closed surface";
  }
  for (std::size_t c = 0; c < found.caps.size(); ++c) {
    std::vector<std::size_t> mine;
    bool taken = false;
    for (std::size_t t = 0; t < found.patch.size(); ++t)
      if (found.patch[t] == int(c)) mine.push_back(t), taken = taken || s.patch[t] >= 0;
    if (taken) continue;
    for (const std::size_t t : mine) s.patch[t] = int(s.caps.size());
    s.caps.push_back(found.caps[c]);
  }
  return "borders and cuts";
}

/// A surface whose openings are too wide or too narrow for an artery by a power of ten is scaled.
void scale_by_calibre(artery::Surface& s, std::vector<Note>& notes) {
  double widest = 0;
  for (const artery::CapPlane& cap : s.caps) widest = std::max(widest, 2 * cap.radius);
  const auto factor = scale_of_calibre(widest);
  if (!factor) return;
  for (Vec3& p : s.mesh.vertices) p *= *factor;
  for (artery::CapPlane& cap : s.caps) cap.centre *= *factor, cap.radius *= *factor;
  notes.push_back(scaled_by(*factor, "widest opening", widest));
}

/// Sorts the openings by calibre, the widest first, and names them in this order.
Json name_openings(artery::Surface& s) {
  std::vector<int> order(s.caps.size()), rank(s.caps.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = int(c);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return s.caps[std::size_t(a)].radius > s.caps[std::size_t(b)].radius; });
  std::vector<artery::CapPlane> sorted;
  for (std::size_t r = 0; r < order.size(); ++r)
    rank[std::size_t(order[r])] = int(r), sorted.push_back(s.caps[std::size_t(order[r])]);
  s.caps = sorted;
  for (int& p : s.patch)
    if (p >= 0) p = rank[std::size_t(p)];
  Json openings = Json::array();
  for (std::size_t c = 0; c < s.caps.size(); ++c) {
    s.caps[c].name = fmt::format("opening_{}", c + 1);
    openings.push_back({{"centre", to_json(s.caps[c].centre)},
                        {"normal", to_json(s.caps[c].normal)},
                        {"calibre_mm", rounded(2 * s.caps[c].radius)}});
  }
  return openings;
}

/// A surface with handles, or one that runs through itself, is made anew. Throws InputError if it then still has a
/// handle.
void mend_shape(artery::Surface& s, const std::string& what, const Options& o, std::vector<Note>& notes) {
  artery::Quality q = artery::quality(s.mesh);
  if (q.euler == 2 && !q.self_intersecting) return;
  make_anew(s,
            q.euler != 2 ? "The surface had a handle, as of two vessels that touch" : "The surface ran through itself",
            what, o, notes);
  q = artery::quality(s.mesh);
  if (q.euler != 2)
    throw InputError(
        fmt::format("{}: has {} handle{}: two branches touch and have grown together, or a hole runs through the wall. "
                    "Part them in the program that made the surface; with a volume, a higher "
                    "--threshold or less --smooth may part them",
                    what, (2 - q.euler) / 2, ending((2 - q.euler) / 2)));
}

}  // namespace

Intake mended(TriMesh m, const std::string& what, const Options& o, std::vector<Note> notes, Openings needed) {
  Intake out;
  out.facts["triangles_given"] = m.triangles.size();
  if (m.triangles.empty()) throw InputError(what + ": holds no triangles");
  if (o.rebuild) {
    m = rebuilt(m, *o.rebuild, notes);
    notes.push_back({Note::Kind::repair,
                     fmt::format("The surface was made anew from a grid of {:.3g} mm, as asked for.", *o.rebuild), ""});
  }
  tidy_or_rebuild(m, what, o, notes);
  ClosedSurface closed = closed_surface(m, notes);
  artery::Surface& s = closed.surface;
  check_inside(s, what);
  if (s.mesh.triangles.size() > many_triangles)
    make_anew(s, fmt::format("The surface had {} triangles, far more than its shape needs", s.mesh.triangles.size()),
              what, o, notes);
  make_cuts(s, o);
  out.facts["openings_found_by"] = add_flat_ends(s);
  mend_shape(s, what, o, notes);
  if (const std::size_t before = s.caps.size(); cut_blind_ends(s, closed.torn, notes), before == 0 && !s.caps.empty())
    out.facts["openings_found_by"] = "ends of one calibre of a closed surface";
  check_torn(s, closed.torn, notes);
  if (s.caps.size() < 2 && needed == Openings::two)
    throw InputError(
        fmt::format("{}: has {} opening{}; a vessel needs an inlet and an outlet. A closed end is found where the "
                    "vessel keeps its calibre for a stretch; cut shorter ones with --cut \"X Y Z mm NX NY NZ\" "
                    "(a point in the vessel and the direction of what is to go), once an end",
                    what, s.caps.size(), ending(int(s.caps.size()))));
  const bool of_volume = o.label || o.threshold;
  const bool open = !s.caps.empty();
  if (open && !o.any_size && !o.unit_mm && !of_volume) scale_by_calibre(s, notes);
  const Json openings = name_openings(s);
  if (open && !o.any_size)
    if (const std::string why = check_calibre(2 * s.caps[0].radius, o.unit_mm.value_or(1)); !why.empty())
      throw InputError(what + ": " + why + "; --any-size takes it all the same");
  const artery::Quality q = artery::quality(s.mesh);
  if (q.self_intersecting)
    notes.push_back(
        problem("input_self_intersecting", "The given surface runs through itself.",
                "The wall is made of new triangles, which are checked again; if they are found wanting, make the "
                "surface anew from a grid with --rebuild \"0.2 mm\"."));
  out.facts["openings"] = openings;
  out.facts["triangles"] = s.mesh.triangles.size();
  out.facts["extent_mm"] = rounded(extent_of(s.mesh));
  out.facts["area_mm2"] = rounded(area(s.mesh));
  out.facts["volume_mm3"] = rounded(signed_volume(s.mesh));
  out.facts["least_angle_deg"] = rounded(q.min_angle_deg);
  out.facts["self_intersecting"] = q.self_intersecting;
  out.surface = std::move(s);
  out.notes = std::move(notes);
  return out;
}

Intake take_in(const fs::path& input, const Options& given, Progress& progress, Openings needed) {
  if (!fs::exists(input)) fail(input, "does not exist");
  const Options o = as_read(given);
  // Messages tell positions.
  const std::string what = input.filename().string() + (o.mirror ? " (mirrored)" : "");
  std::vector<Note> notes;
  TriMesh m;
  progress.step("reading " + input.filename().string());
  const bool volume = is_volume_input(input);
  Options with_ends = o;
  with_ends.cuts.clear();
  if (volume) {
    m = read_volume_surface(input, o, notes, with_ends.cuts);
    with_ends.cuts.insert(with_ends.cuts.end(), o.cuts.begin(), o.cuts.end());
  } else {
    with_ends.cuts = o.cuts;
    if (o.label || o.threshold || o.around || !o.paint.empty())
      fail(input, "is a surface; --label, --threshold, --around and --paint are for volumes");
    m = read_surface_mm(input, o, notes);
  }
  progress.step("mending the surface");
  Intake out;
  try {
    out = mended(std::move(m), what, with_ends, std::move(notes), needed);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw InputError(what + ": " + e.what());
  }
  out.facts["kind"] = volume ? "volume" : "surface";
  out.facts["file"] = input.filename().string();
  return out;
}

void run_intake(const CaseFolder& folder, const fs::path& input, const Options& o, Progress& progress) {
  progress.stage("intake", 3);
  const Intake in = take_in(input, o, progress);
  progress.step("writing");
  write_ply(folder.intake() / "surface.ply", in.surface.mesh, "unit mm; a vessel as it was given, mended and closed");
  Json json = in.facts;
  json["caps"] = Json::array();
  for (std::size_t c = 0; c < in.surface.caps.size(); ++c) {
    const artery::CapPlane& cap = in.surface.caps[c];
    Json triangles = Json::array();
    for (std::size_t t = 0; t < in.surface.patch.size(); ++t)
      if (in.surface.patch[t] == int(c)) triangles.push_back(t);
    json["caps"].push_back({{"name", cap.name},
                            {"centre", to_json(cap.centre)},
                            {"normal", to_json(cap.normal)},
                            {"radius", rounded(cap.radius)},
                            {"triangles", triangles}});
  }
  json["notes"] = to_json(in.notes);
  write_json(folder.intake() / "intake.json", json);
  progress.finish();
}

Intake read_intake(const CaseFolder& folder) {
  Intake out;
  out.facts = read_json(folder.intake() / "intake.json");
  out.surface.mesh = read_ply(folder.intake() / "surface.ply");
  out.surface.patch.assign(out.surface.mesh.triangles.size(), -1);
  try {
    for (const Json& cap : out.facts.at("caps")) {
      for (const Json& t : cap.at("triangles"))
        out.surface.patch.at(t.get<std::size_t>()) = int(out.surface.caps.size());
      out.surface.caps.push_back(
          {cap.at("name"), vec3_from(cap.at("centre")), vec3_from(cap.at("normal")).normalized(), cap.at("radius")});
    }
    out.notes = notes_from_json(out.facts.at("notes"));
  } catch (const std::exception&) {
    throw InputError((folder.intake() / "intake.json").string() +
                     ": does not belong to surface.ply beside it; do the stage intake again");
  }
  return out;
}

}  // namespace insula::case_builder
