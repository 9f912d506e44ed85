// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/mechanics/instrument.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/mechanics/surface.h"
#include "core/sim/report.h"
#include "tools/case_builder/solid.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

// The shipped exercises: 0.07 and 0.15 N, 0.1 and 0.3 mm, all of it.
constexpr double min_force = 0.02, max_force = 1.0;  // N
constexpr double max_depth = 1.5;                    // mm
constexpr double max_speed = 100;                    // mm/s; the shipped exercises: 0.00
constexpr double min_seen = 0.4;
constexpr double limit = 12;  // mm, within which depths are looked for

TriMesh in_mm(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles) {
  TriMesh m{vertices, triangles};
  for (Vec3& p : m.vertices) p *= 1000;
  return m;
}
TriMesh now(const Surface& s) { return in_mm(s.positions(), s.triangles()); }
TriMesh now(const Instrument& tool) {
  TriMesh m;
  for (const ToolPart& part : tool.tool().parts) {
    TriMesh mesh = part.mesh;
    for (Vec3& p : mesh.vertices) p = 1000 * tool.pose().apply(p);
    append(m, mesh);
  }
  return m;
}

/// How deep the deepest of the points lies within any of the solids, mm; 0: none lies in one.
double deepest(const TriMesh& points, const std::vector<Solid>& solids) {
  double out = 0;
  for (const Solid& solid : solids)
    for (const Vec3& p : points.vertices)
      if (const Nearest n = solid.nearest(p, limit); n.found) out = std::max(out, -n.distance);
  return out;
}

/// Whether a triangle of the mesh crosses the segment from a to b (Moeller, Trumbore 1997).
bool crossed(const Vec3& a, const Vec3& b, const TriMesh& mesh) {
  const Vec3 d = b - a;
  for (const auto& t : mesh.triangles) {
    const Vec3 &p = mesh.vertices[std::size_t(t[0])], u = mesh.vertices[std::size_t(t[1])] - p,
               v = mesh.vertices[std::size_t(t[2])] - p;
    const Vec3 n = d.cross(v);
    const double det = u.dot(n);
    if (std::abs(det) < 1e-12) continue;
    const Vec3 from = a - p;
    const double s = from.dot(n) / det;
    if (s < 0 || s > 1) continue;
    const Vec3 q = from.cross(u);
    const double r = d.dot(q) / det, along = v.dot(q) / det;
    if (r >= 0 && s + r <= 1 && along > 0 && along < 1) return true;
  }
  return false;
}

/// Share of the sac's side towards the eye that is not hidden.
double seen_of(const ShellBody& artery, const Vec3& eye, const std::vector<TriMesh>& others) {
  constexpr double off = 0.05;  // mm, so that a triangle does not hide itself
  const TriMesh wall{nodes_mm(artery), artery.model().wall.triangles};
  const int sac = artery.region("sac"), bleb = artery.region("bleb");
  double facing = 0, free = 0;
  for (const auto& t : wall.triangles) {
    const auto of_sac = [&](int i) {
      return artery.model().vertex_region[std::size_t(i)] == sac ||
             (bleb >= 0 && artery.model().vertex_region[std::size_t(i)] == bleb);
    };
    if (!of_sac(t[0]) || !of_sac(t[1]) || !of_sac(t[2])) continue;
    const Vec3 &a = wall.vertices[std::size_t(t[0])], &b = wall.vertices[std::size_t(t[1])],
               &c = wall.vertices[std::size_t(t[2])];
    const Vec3 twice = (b - a).cross(c - a), middle = (a + b + c) / 3;
    const double area = 0.5 * twice.dot((eye - middle).normalized());  // as the eye sees it
    if (area <= 0) continue;
    const Vec3 from = middle + off * twice.normalized();
    if (crossed(from, eye, wall)) continue;
    facing += area;
    if (std::none_of(others.begin(), others.end(), [&](const TriMesh& m) { return crossed(from, eye, m); }))
      free += area;
  }
  return facing > 0 ? free / facing : 0;
}

}  // namespace

std::vector<Vec3> nodes_mm(const DeformableBody& body) {
  std::vector<Vec3> out;
  for (int i = 0; i < body.nodes(); ++i) out.push_back(1000 * body.q().segment<3>(3 * i));
  return out;
}

Standing standing_of(const Simulation& s) {
  Standing out;
  std::vector<TriMesh> hiding;
  std::vector<Solid> tissue;
  const ShellBody* artery = nullptr;
  for (const Surface* surface : s.surfaces()) {
    if (const auto* shell = dynamic_cast<const ShellBody*>(&surface->body())) {
      artery = shell;
      continue;
    }
    if (!surface->contact() && surface->body().id == "artery") continue;  // the vessel as a picture
    hiding.push_back(now(*surface));
    if (surface->contact()) tissue.emplace_back(hiding.back());
  }
  for (const Instrument* tool : s.instruments()) {
    if (!tool->active()) continue;
    const TriMesh shape = now(*tool);
    const double depth = deepest(shape, tissue);
    if (tool->hand_index() >= 0) {
      if (depth > 0) out.in_tissue.push_back(tool->id);
      continue;
    }
    std::map<const Body*, double> on;
    for (const ContactPoint& c : s.report().contacts) {
      const Body* other = c.a == tool ? c.b : c.b == tool ? c.a : nullptr;
      if (dynamic_cast<const SoftBody*>(other)) on[other] += c.normal_force;
    }
    StandingArm arm{tool->id, "", 0, depth};
    for (const auto& [body, force] : on)
      if (force > arm.force) arm.lobe = body->id, arm.force = force;
    out.arms.push_back(arm);
    hiding.push_back(shape);
  }
  for (const Body* body : s.bodies())
    if (const auto* lobe = dynamic_cast<const SoftBody*>(body)) {
      double speed = 0;
      for (int i = 0; i < lobe->nodes(); ++i) speed = std::max(speed, 1000 * lobe->v().segment<3>(3 * i).norm());
      if (speed > max_speed) out.restless.push_back({lobe->id, speed});
    }
  if (artery && artery->region("sac") >= 0 && s.view()) {
    out.has_sac = true;
    out.seen = seen_of(*artery, 1000 * s.view()->eye(), hiding);
  }
  return out;
}

std::vector<Note> judged(const Standing& standing) {
  constexpr const char* where =
      "The arms, the hands and the microscope stand about the fissure of a brain in the MNI frame: register yours to "
      "it better, or move the retractors (--retractor).";
  std::vector<Note> notes;
  const auto tell = [&](bool good, const char* id, std::string text) {
    notes.push_back(good ? Note{Note::Kind::fact, std::move(text), ""} : problem(id, std::move(text), where));
  };
  for (const StandingArm& arm : standing.arms) {
    if (arm.lobe.empty()) tell(false, "retractor_holds_nothing", fmt::format("{} holds no lobe.", arm.id));
    else
      tell(arm.force >= min_force && arm.force <= max_force, "retractor_force",
           fmt::format("{} holds the {} lobe with {:.2f} N.", arm.id, arm.lobe, arm.force));
    if (arm.deepest > max_depth)
      tell(false, "retractor_in_tissue", fmt::format("{} stands {:.1f} mm deep in tissue.", arm.id, arm.deepest));
  }
  for (std::size_t i = 0; i < standing.arms.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!standing.arms_chosen && !standing.arms[i].lobe.empty() && standing.arms[i].lobe == standing.arms[j].lobe)
        tell(false, "retractors_hold_one_lobe",
             fmt::format("{} and {} both hold the {} lobe.", standing.arms[j].id, standing.arms[i].id,
                         standing.arms[i].lobe));
  if (standing.has_sac)
    tell(standing.seen >= min_seen, "sac_hidden",
         fmt::format("The microscope sees {:.0f} % of the sac's side towards it.", 100 * standing.seen));
  for (const RestlessLobe& lobe : standing.restless)
    tell(false, "lobe_restless", fmt::format("The {} lobe does not come to rest: {:.0f} mm/s.", lobe.id, lobe.speed));
  for (const std::string& id : standing.in_tissue)
    tell(false, "tool_in_tissue", fmt::format("{} starts within tissue or bone.", id));
  return notes;
}

}  // namespace insula::case_builder
