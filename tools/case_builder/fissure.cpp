// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the part through the loader of scenes, so that the builder sees what the exercises will see.
#include "tools/case_builder/fissure.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/mechanics/instrument.h"
#include "core/mechanics/soft_body.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

TriMesh in_mm(TriMesh m) {
  for (Vec3& p : m.vertices) p *= 1000;
  return m;
}

/// A lobe of the author's own. What the part of the scenes holds of it is held here.
Lobe given_lobe(const std::filesystem::path& folder, const std::string& name, const Approach& approach) {
  const std::filesystem::path file = folder / (name + ".msh");
  Lobe lobe;
  lobe.name = name;
  lobe.tets = read_tet_mesh(file, 1.0);
  lobe.surface = read_surface(folder / (name + "_surface.ply"), 1.0);
  int fixed = 0;
  for (const Vec3& p : lobe.tets.nodes) fixed += lobe.fixed.emplace_back((p - approach.centre).norm() > approach.held);
  if (fixed < 3)
    throw InputError(
        fmt::format("{}: fewer than three of its nodes lie farther than {:g} mm from ({:g}, {:g}, {:g}), where lobes "
                    "are held: is it "
                    "in the frame of {}, in mm?",
                    file.string(), approach.held, approach.centre.x(), approach.centre.y(), approach.centre.z(),
                    "meshes/" + approach.folder.filename().string()));
  const Embedding e = embed(lobe.tets, lobe.surface.vertices);
  if (e.outside_m > 5) throw InputError(file.string() + ": its surface reaches more than 5 mm outside of it");
  for (std::size_t v = 0; v < lobe.surface.vertices.size(); ++v)
    lobe.embedded_vertices.push_back({4, e.nodes[v], e.weights[v], Vec3::Zero()});
  return lobe;
}

/// The lobe that an arm holds: the soft body of a contact with it.
std::string held_by(const Simulation& simulation, const Instrument& arm) {
  for (const Constraint* c : simulation.constraints()) {
    const auto* between = dynamic_cast<const RefList<Body>*>(c->find_param("between"));
    if (!between || std::find((*between)().begin(), (*between)().end(), &arm) == (*between)().end()) continue;
    for (const Body* other : (*between)())
      if (dynamic_cast<const SoftBody*>(other)) return other->id;
  }
  return {};
}

/// An arm comes to its place from behind its flat side.
RetractorAt retractor_of(const Simulation& simulation, const Instrument& arm) {
  const Mat3 turn = arm.home_pose().q.toRotationMatrix();
  const auto* from = dynamic_cast<const Param<Vec<Length>>*>(arm.find_param("approach"));
  return {held_by(simulation, arm), 1000 * arm.home_pose().p, turn.col(2), turn.col(0),
          from ? 1000 * (*from)().norm() : 0};
}

TriMesh blade_of(const Instrument& arm) {
  TriMesh out;
  for (const ToolPart& part : arm.tool().parts) {
    TriMesh mesh = part.mesh;
    for (Vec3& p : mesh.vertices) p *= 1000;
    append(out, mesh);
  }
  return out;
}

}  // namespace

std::vector<RetractorAt> retractors_of(const Options& o, const Fissure& fissure) {
  return o.retractors ? chosen_retractors(*o.retractors, fissure.proposed, fissure.approach) : fissure.proposed;
}

Fissure with_retractors(Fissure fissure, const Options& o) {
  fissure.retractors = at_places(fissure.blade, retractors_of(o, fissure));
  return fissure;
}

Fissure read_fissure(const std::filesystem::path& project, const std::filesystem::path& lobes,
                     const Approach& approach) {
  Registry registry;
  register_builtin(registry);
  const auto loaded =
      load_simulation_text(fmt::format(R"(<scene><include file="../parts/{}"/></scene>)", approach.open_part),
                           project / "scenes/cases/placing.xml", registry, 1);
  if (!loaded.simulation) throw InputError("the fissure cannot be read:\n" + loaded.diagnostics.format());
  Fissure out;
  out.approach = approach;
  for (Surface* s : loaded.simulation->surfaces()) {
    if (s->body().id == approach.floor) out.floor = in_mm(s->rest());
    const auto& rigid = approach.obstacles;
    if (std::find(rigid.begin(), rigid.end(), s->body().id) != rigid.end())
      out.obstacles.push_back({s->body().id, in_mm(s->rest())});
    const auto* soft = dynamic_cast<const SoftBody*>(&s->body());
    if (!soft) continue;
    Lobe lobe;
    lobe.name = soft->id;
    lobe.tets = soft->rest();
    for (Vec3& p : lobe.tets.nodes) p *= 1000;
    lobe.fixed = soft->fixed();
    lobe.surface = in_mm(s->rest());
    for (const MaterialPoint& p : s->points())
      lobe.embedded_vertices.push_back({p.count, p.node, p.weight, 1000 * p.local});
    out.lobes.push_back(std::move(lobe));
  }
  for (const Instrument* arm : loaded.simulation->instruments()) {
    out.proposed.push_back(retractor_of(*loaded.simulation, *arm));
    out.blade = blade_of(*arm);
  }
  out.retractors = at_places(out.blade, out.proposed);
  if (!lobes.empty()) {
    out.floor = read_surface(lobes / (approach.floor + "_surface.ply"), 1.0);
    for (Lobe& lobe : out.lobes) lobe = given_lobe(lobes, lobe.name, approach);
  }
  if (out.lobes.size() != 2 || out.floor.triangles.empty() || out.retractors.triangles.empty())
    throw InputError("the part " + approach.open_part + " lacks a lobe, the " + approach.floor + " or a retractor");
  return out;
}

}  // namespace insula::case_builder
