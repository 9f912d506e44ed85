// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/brain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/fissure_fit.h"
#include "tools/mesh_lobes/part_meshes.h"
#include "tools/mesh_lobes/separate.h"

namespace insula::case_builder {
namespace {

using mesh_tool::SizeField;
using mesh_tool::Sizes;

// Sizes as those of the shipped lobes (tools/mesh_lobes/rebuild.sh), mm.
const mesh_tool::Focus focus{{2, 14}, {60, 4, 0}, 24};
constexpr Sizes cell[] = {{2.8, 6.8}, {5.4, 13}}, cell_error{0.5, 1.2}, edge[] = {{0.8, 2.5}, {0.8, 2.5}, {1, 3.5}};
constexpr double edge_error = 0.08, field_spacing = 0.7;

TriMesh as_mesh(const mesh_tool::TriangleMesh& m) {
  TriMesh out;
  for (const auto& p : m.points) out.vertices.emplace_back(p[0], p[1], p[2]);
  for (const auto& t : m.triangles) out.triangles.push_back({t[0], t[1], t[2]});
  return out;
}

std::size_t nodes_of(const std::vector<mesh_tool::TetMesh>& meshes) {
  return meshes[0].points.size() + meshes[1].points.size();
}

/// The two lobes in tetrahedra, with larger cells where they would be too many.
std::vector<mesh_tool::TetMesh> lobes_of(const mesh_tool::PartFields& fields, double gap, int most,
                                         std::vector<Note>& notes) {
  std::vector<mesh_tool::TetMesh> meshes;
  double larger = 1;
  for (int round = 0; round < 4; ++round) {
    std::vector<SizeField> cells, errors;
    for (std::size_t a = 0; a < 2; ++a) {
      cells.push_back(growing(fields, a, {larger * cell[a].near, larger * cell[a].far}, focus));
      errors.push_back(growing(fields, a, {larger * cell_error.near, larger * cell_error.far}, focus));
    }
    meshes = mesh_parts(fields, cells, errors, gap).meshes;
    if (nodes_of(meshes) <= std::size_t(most)) break;
    larger *= 1.05 * std::cbrt(double(nodes_of(meshes)) / most);
  }
  if (larger > 1)
    notes.push_back(
        {Note::Kind::repair,
         fmt::format("The lobes' cells were made {:.2f} times as large as usual, for {} nodes (--brain-nodes {}).",
                     larger, nodes_of(meshes), most),
         ""});
  if (nodes_of(meshes) > std::size_t(most))
    notes.push_back(
        problem("lobes_too_fine",
                fmt::format("The lobes have {} nodes, more than the {} that were allowed.", nodes_of(meshes), most),
                "Give a smoother surface or segmentation, or allow more with --brain-nodes."));
  return meshes;
}

/// The labels as they lie after a motion of the world, mm.
void move(mesh_tool::NiftiVolume& v, const Placement& p) {
  const std::array<double, 12> to = v.to_world, from = v.from_world;
  const Mat3 back = p.rotation.transpose();
  const Vec3 origin = -back * p.shift;
  const auto m = [](const std::array<double, 12>& a) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(a.data());
  };
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> to_world(v.to_world.data()), from_world(v.from_world.data());
  to_world.leftCols<3>() = p.rotation * m(to).leftCols<3>(), to_world.col(3) = p.rotation * m(to).col(3) + p.shift;
  from_world.leftCols<3>() = m(from).leftCols<3>() * back,
  from_world.col(3) = m(from).leftCols<3>() * origin + m(from).col(3);
}

}  // namespace

mesh_tool::FieldOptions field_options(const Approach& approach) {
  mesh_tool::FieldOptions f;
  f.spacing = field_spacing, f.radius = approach.radius, f.coarse_gap = 0.45;
  f.centre = {approach.centre.x(), approach.centre.y(), approach.centre.z()};
  return f;
}

Placement settle_in(BrainLabels& brain, mesh_tool::PartFields& fields, const Approach& approach,
                    std::vector<Note>& notes) {
  const mesh_tool::FieldOptions f = field_options(approach);
  constexpr double near_enough = 1.0;  // mm; brains of one template differ by less
  const Course wanted = shipped_course(approach);
  const auto course = [&] { return course_of(describe_cleft(fields, 0, 1, f, {1, 0, 0})); };
  Course now = course();
  const double before = distance(wanted, now);
  double off = before;
  Placement whole;
  double shift = 0, turn = 0;
  for (int round = 0; round < 3 && off > near_enough; ++round) {
    const Placement step = fit(wanted, now);
    const Placement next{step.rotation * whole.rotation, step.rotation * whole.shift + step.shift};
    shift = (next.apply(approach.centre) - approach.centre).norm(),
    turn = Eigen::AngleAxisd(next.rotation).angle() * 180 / std::numbers::pi;
    if (shift > farthest_move || turn > widest_turn) {
      notes.push_back(
          problem("fissure_elsewhere",
                  fmt::format("The fissure lies {:.1f} mm from where the arms, the hands and the microscope "
                              "stand; it would have to be moved by {:.0f} mm and turned by {:.0f} degrees.",
                              off, shift, turn),
                  "Bring the brain to the MNI frame (right-anterior-superior) by a registration of its own, best "
                  "one that follows the gyri."));
      return whole;
    }
    move(brain.volume, step);
    whole = next;
    fields = build_part_fields(brain.volume, nullptr, brain.parts, f);
    now = course();
    const double last = off;
    off = distance(wanted, now);
    if (off > 0.9 * last) break;
  }
  if (off < before)
    notes.push_back(
        {Note::Kind::repair,
         fmt::format("The brain was moved by {:.1f} mm and turned by {:.1f} degrees, so that its fissure lies where "
                     "the arms, the hands and the microscope stand: {:.1f} mm off, before {:.1f} mm.",
                     shift, turn, off, before),
         ""});
  return whole;
}

Placement brain_motion(const CaseFolder& folder) { return placement_from(read_json(folder.path / "brain.json")); }

namespace {

/// Makes the surfaces of the three lobes. Throws if two of them intersect.
std::vector<mesh_tool::TriangleMesh> surfaces_of(const mesh_tool::PartFields& fields, const Approach& approach) {
  std::vector<mesh_tool::TriangleMesh> surfaces;
  for (std::size_t a = 0; a < 3; ++a)
    surfaces.push_back(mesh_surface(fields.grid, fields.fine[a], growing(fields, a, edge[a], focus), edge_error));
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a + 1; b < 3; ++b)
      if (clearance(surfaces[a], surfaces[b]).intersect)
        throw InputError(fmt::format("--brain: the surfaces of {} and {} run through each other", approach.parts()[a],
                                     approach.parts()[b]));
  return surfaces;
}

/// Writes the lobes' files. Returns the data of each lobe for the report.
Json write_lobes(const CaseFolder& folder, const std::vector<mesh_tool::TriangleMesh>& surfaces,
                 const std::vector<mesh_tool::TetMesh>& meshes, const Approach& approach) {
  fs::create_directories(folder.brain());
  Json out = Json::array();
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string name = approach.parts()[a];
    write_ply(folder.brain() / (name + "_surface.ply"), as_mesh(surfaces[a]), "unit mm; of the case's own brain");
    Json one{{"name", name},
             {"triangles", surfaces[a].triangles.size()},
             {"volume_mm3", rounded(signed_volume(surfaces[a]))}};
    if (a < 2) {
      write_msh((folder.brain() / (name + ".msh")).string(), meshes[a], mesh_tool::MshFormat::v2_ascii);
      one["nodes"] = meshes[a].points.size(), one["tetrahedra"] = meshes[a].tets.size(),
      one["least_angle_deg"] = rounded(dihedral_range(meshes[a]).min_deg);
    }
    out.push_back(one);
  }
  return out;
}

/// Meshes the brain and writes its files.
Json mesh_brain(BrainLabels& given, const CaseFolder& folder, const Approach& approach, const Options& o,
                std::vector<Note>& notes, Progress& progress) {
  const mesh_tool::FieldOptions f = field_options(approach);
  Json json;
  progress.step("borders of the lobes");
  mesh_tool::PartFields fields = build_part_fields(given.volume, nullptr, given.parts, f);
  Placement motion;
  if (!o.brain_in_place && given.own_fissure) motion = settle_in(given, fields, approach, notes);
  write_placement(motion, json);
  progress.step("surfaces");
  const std::vector<mesh_tool::TriangleMesh> surfaces = surfaces_of(fields, approach);
  progress.step("tetrahedra");
  const std::vector<mesh_tool::TetMesh> meshes = lobes_of(fields, f.coarse_gap, o.brain_nodes, notes);
  if (clearance(boundary_mesh(meshes[0]), boundary_mesh(meshes[1])).intersect)
    throw InputError(
        "--brain: the tetrahedra of the two lobes run through each other; allow more nodes with --brain-nodes");
  json["lobes"] = write_lobes(folder, surfaces, meshes, approach);
  return json;
}

}  // namespace

void run_brain(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  std::error_code ignored;
  fs::remove_all(folder.brain(), ignored);
  fs::remove(folder.path / "brain.json", ignored);
  if (o.brain.empty()) return;
  if (!o.lobes.empty()) throw InputError("--brain and --lobes exclude each other");
  const Approach approach = read_approach(project, o.approach);
  if (!fs::exists(course_file(approach)))
    throw InputError("--brain: a brain of your own is laid over the course of a fissure, which " + approach.title +
                     " does not have: leave out --brain or --approach");
  progress.stage("brain", 4);
  progress.step("reading the brain");
  std::vector<Note> notes;
  BrainLabels given = read_brain(o, project, approach, notes);
  Json json;
  try {
    json = mesh_brain(given, folder, approach, o, notes, progress);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {  // the mesh generator's own
    throw InputError(fmt::format(
        "--brain: {}. What is meshed is a ball of {:g} mm about ({:g}, {:g}, {:g}), {}: is the "
        "brain in the MNI frame (right-anterior-superior), in mm?{}",
        e.what(), approach.radius, approach.centre.x(), approach.centre.y(), approach.centre.z(), approach.title,
        o.mirror ? " It was mirrored (--mirror): was it of the left side?" : " One of the left side needs --mirror."));
  }
  json["notes"] = to_json(notes);
  write_json(folder.path / "brain.json", json);
  progress.finish();
}

}  // namespace insula::case_builder
