// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/openings.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

constexpr double round_enough =
    0.6;  // 4 pi area / perimeter^2 of a border that is an end of a vessel: an ellipse of 1 to 3
constexpr double flat_enough = 0.5;   // farthest from its plane, in radii
constexpr double small_hole = 0.3;    // of the widest border's radius: filled
constexpr double narrow_hole = 0.75;  // of the largest border's radius: filled too, and told of

struct Border {
  std::vector<int> loop;
  Vec3 centre = Vec3::Zero(), normal = Vec3::UnitZ();  ///< outward
  double radius = 0, perimeter = 0, deviation = 0, roundness = 0;
  bool end = false;
};

/// Of the border without its teeth: what was cut along triangles or voxels is longer than it is round.
double roundness(const TriMesh& m, const std::vector<int>& loop) {
  std::vector<Vec3> p;
  for (const int v : loop) p.push_back(m.vertices[std::size_t(v)]);
  const std::size_t n = p.size();
  for (int round = 0; round < 12; ++round) {
    const std::vector<Vec3> old = p;
    for (std::size_t k = 0; k < n; ++k) p[k] = 0.25 * old[(k + n - 1) % n] + 0.5 * old[k] + 0.25 * old[(k + 1) % n];
  }
  Vec3 twice = Vec3::Zero();
  double perimeter = 0;
  for (std::size_t k = 0; k < n; ++k)
    twice += (p[k] - p[0]).cross(p[(k + 1) % n] - p[0]), perimeter += (p[(k + 1) % n] - p[k]).norm();
  return 4 * std::numbers::pi * 0.5 * twice.norm() / std::max(perimeter * perimeter, 1e-300);
}

Border measured(const TriMesh& m, std::vector<int> loop) {
  Border b;
  b.loop = std::move(loop);
  const auto at = [&](std::size_t k) -> const Vec3& { return m.vertices[std::size_t(b.loop[k % b.loop.size()])]; };
  for (std::size_t k = 0; k < b.loop.size(); ++k) {
    const double l = (at(k + 1) - at(k)).norm();
    b.centre += l * 0.5 * (at(k) + at(k + 1)), b.perimeter += l;
  }
  b.centre /= std::max(b.perimeter, 1e-300);
  Vec3 twice = Vec3::Zero();
  for (std::size_t k = 0; k < b.loop.size(); ++k) twice += (at(k) - b.centre).cross(at(k + 1) - b.centre);
  const double size = 0.5 * twice.norm();
  if (size > 0) b.normal = twice.normalized();
  for (const int v : b.loop)
    b.deviation = std::max(b.deviation, std::abs((m.vertices[std::size_t(v)] - b.centre).dot(b.normal)));
  b.radius = std::sqrt(size / std::numbers::pi);
  b.roundness = roundness(m, b.loop);
  return b;
}

void fill(artery::Surface& s, const Border& b, int patch) {
  const int hub = int(s.mesh.vertices.size());
  s.mesh.vertices.push_back(b.centre);
  for (std::size_t k = 0; k < b.loop.size(); ++k) {
    s.mesh.triangles.push_back({b.loop[k], b.loop[(k + 1) % b.loop.size()], hub});
    s.patch.push_back(patch);
  }
}

/// Six times the volume that a surface and fans over its borders enclose; negative: it is inside out.
double six_volumes(const TriMesh& m, const std::vector<std::vector<int>>& loops) {
  if (m.vertices.empty()) return 0;
  const auto at = [&](int v) -> Vec3 { return m.vertices[std::size_t(v)] - m.vertices[0]; };  // as signed_volume()
  double sum = 6 * signed_volume(m);
  for (const std::vector<int>& loop : loops) {
    const Vec3 hub = at(loop[0]);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) sum += hub.dot(at(loop[k]).cross(at(loop[k + 1])));
  }
  return sum;
}

/// Whether a border that is an end is cut straight behind its deepest notch.
bool cut_straight(artery::Surface& s, const Border& b, std::vector<Note>& notes) {
  const double back = b.deviation + 0.05 * b.radius;
  try {
    cut_off(s, b.centre - back * b.normal, b.normal, fmt::format("opening_{}", s.caps.size()));
  } catch (const InputError&) {
    return false;  // no single tube there
  }
  notes.push_back(
      {Note::Kind::repair,
       fmt::format("The end at {} was not flat: it was cut straight, {:.2f} mm were lost.", place(b.centre), back),
       ""});
  return true;
}

}  // namespace

ClosedSurface closed_surface(const TriMesh& given, std::vector<Note>& notes) {
  TriMesh mesh = given;
  if (six_volumes(mesh, border_loops(mesh)) < 0) {
    turn_inside_out(mesh);
    notes.push_back({Note::Kind::repair, "The surface was inside out; it was turned.", ""});
  }
  std::vector<Border> borders;
  double widest = 0;
  for (auto& loop : border_loops(mesh)) {
    borders.push_back(measured(mesh, std::move(loop)));
    Border& b = borders.back();
    b.end = b.roundness > round_enough && b.deviation < flat_enough * b.radius;
    if (b.end) widest = std::max(widest, b.radius);
  }
  std::stable_sort(borders.begin(), borders.end(),
                   [](const Border& a, const Border& b) { return a.radius > b.radius; });
  ClosedSurface out{{mesh, std::vector<int>(mesh.triangles.size(), -1), {}}, {}};
  artery::Surface& s = out.surface;
  std::vector<Border> cut;
  int filled = 0;
  const auto torn = [&](const Border& b) -> TornBorder {  // the first border is the largest one
    return {b.centre, b.radius, b.perimeter, b.perimeter / 6 < narrow_hole * borders.front().radius};
  };
  for (const Border& b : borders) {
    const bool small = std::max(b.radius, b.perimeter / 6) < small_hole * std::max(widest, 1e-9);
    if (b.end && b.radius > small_hole * widest && b.deviation < 0.02 * b.radius) {
      fill(s, b, int(s.caps.size()));
      s.caps.push_back({fmt::format("opening_{}", s.caps.size()), b.centre, b.normal, b.radius});
      continue;
    }
    fill(s, b, -1);
    if (b.end && b.radius > small_hole * widest) cut.push_back(b);
    else if (small) ++filled;
    else out.torn.push_back(torn(b));
  }
  for (const Border& b : cut)
    if (!cut_straight(s, b, notes)) out.torn.push_back(torn(b));
  if (!s.caps.empty())
    notes.push_back({Note::Kind::repair,
                     fmt::format("The surface was open at {} ends; they were closed by flat caps.", s.caps.size()),
                     ""});
  if (filled > 0)
    notes.push_back({Note::Kind::repair,
                     fmt::format("{} small hole{} in the wall {} filled.", filled, filled == 1 ? "" : "s",
                                 filled == 1 ? "was" : "were"),
                     ""});
  artery::number_by_use(s.mesh);
  return out;
}

void check_torn(const artery::Surface& s, const std::vector<TornBorder>& torn, std::vector<Note>& notes) {
  for (const TornBorder& b : torn) {
    bool there = false;
    for (std::size_t t = 0; t < s.patch.size(); ++t)
      for (const int v : s.mesh.triangles[t])
        there = there || (s.patch[t] < 0 && (s.mesh.vertices[std::size_t(v)] - b.centre).norm() < 0.3 * b.radius);
    if (!there) continue;
    if (!b.narrow)
      throw InputError(
          fmt::format("the surface has a hole of {:.1f} mm around at {} that is neither an end of a vessel nor small: "
                      "close it in the program that made the surface, cut the vessel straight before it, or make the "
                      "surface anew from a grid with --rebuild \"0.2 mm\" after closing it",
                      b.perimeter, place(b.centre)));
    notes.push_back({Note::Kind::repair,
                     fmt::format("A hole of {:.1f} mm around at {} was filled.", b.perimeter, place(b.centre)),
                     "Look whether the wall is right there, and whether a branch is missing."});
  }
}

}  // namespace insula::case_builder
