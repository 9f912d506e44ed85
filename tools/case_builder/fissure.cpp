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

}  // namespace

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
  for (const Instrument* tool : loaded.simulation->instruments())
    for (const ToolPart& part : tool->tool().parts) {
      const int first = int(out.retractors.vertices.size());
      for (const Vec3& p : part.mesh.vertices) out.retractors.vertices.push_back(1000 * tool->home_pose().apply(p));
      for (const auto& t : part.mesh.triangles)
        out.retractors.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  if (!lobes.empty()) {
    out.floor = read_surface(lobes / (approach.floor + "_surface.ply"), 1.0);
    for (Lobe& lobe : out.lobes) lobe = given_lobe(lobes, lobe.name, approach);
  }
  if (out.lobes.size() != 2 || out.floor.triangles.empty() || out.retractors.triangles.empty())
    throw InputError("the part " + approach.open_part + " lacks a lobe, the " + approach.floor + " or a retractor");
  return out;
}

}  // namespace insula::case_builder
