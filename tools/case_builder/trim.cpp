// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/trim.h"

#include <fmt/format.h>

#include <limits>
#include <map>

#include "core/base/input_error.h"
#include "tools/case_builder/openings.h"

namespace insula::case_builder {
namespace {

constexpr double past_fork = 1.5;  // radii of a fork that a cut keeps from its middle

/// How far a point is from the nearest vertex, mm.
double away(const TriMesh& m, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& q : m.vertices) least = std::min(least, (q - p).norm());
  return least;
}

/// Distance along the lines from the point nearest to `from` to each point of each line, mm.
std::vector<std::vector<double>> distances(const std::vector<artery::NamedCurve>& lines, const Vec3& from) {
  std::vector<std::vector<double>> out;
  std::size_t line = 0, point = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < lines.size(); ++l) {
    out.emplace_back(lines[l].curve.size(), std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < lines[l].curve.size(); ++k)
      if (const double d = (lines[l].curve.points[k] - from).norm(); d < least) least = d, line = l, point = k;
  }
  out[line][point] = 0;
  std::map<std::string, double> joint;
  for (std::size_t pass = 0; pass <= lines.size(); ++pass)
    for (std::size_t l = 0; l < lines.size(); ++l) {
      auto& distance = out[l];
      const auto& p = lines[l].curve.points;
      const auto meet = [&](const std::string& name, double& end) {
        const auto [at, fresh] = joint.emplace(name, end);
        if (!fresh) at->second = end = std::min(at->second, end);
      };
      meet(lines[l].from, distance.front()), meet(lines[l].to, distance.back());
      for (std::size_t k = 1; k < p.size(); ++k)
        distance[k] = std::min(distance[k], distance[k - 1] + (p[k] - p[k - 1]).norm());
      for (std::size_t k = p.size() - 1; k > 0; --k)
        distance[k - 1] = std::min(distance[k - 1], distance[k] + (p[k] - p[k - 1]).norm());
      meet(lines[l].from, distance.front()), meet(lines[l].to, distance.back());
    }
  return out;
}

}  // namespace

artery::Surface trimmed(const artery::Surface& surface, const std::vector<artery::NamedCurve>& all, const Vec3& neck,
                        double keep, std::vector<Note>& notes) {
  artery::Surface s = surface;
  std::vector<artery::NamedCurve> lines;
  for (const auto& l : all)
    if (l.name != "sac") lines.push_back(l);
  const auto distance = distances(lines, neck);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const auto& c = lines[l].curve;
    for (std::size_t k = 0; k + 1 < c.size(); ++k) {
      const bool out = distance[l][k] < keep && distance[l][k + 1] >= keep,
                 in = distance[l][k] >= keep && distance[l][k + 1] < keep;
      if (!out && !in) continue;
      const double end = out ? distance[l].back() : distance[l].front();
      if (end < keep + 2 * c.radius[k]) continue;  // its own end is hardly farther
      // A section so near to a fork is not of this line alone.
      const bool forks = (out ? lines[l].from : lines[l].to).starts_with("bifurcation");
      const double inner = out ? distance[l].front() : distance[l].back(),
                   free = forks ? past_fork * (out ? c.radius.front() : c.radius.back()) : 0;
      std::size_t first = k;
      while (first > 0 && first + 1 < c.size() && distance[l][first] - inner < free)
        first = out ? first + 1 : first - 1;
      if (end < distance[l][first] + 2 * c.radius[first]) continue;
      bool done = false;
      std::string why;
      for (std::size_t farther = 0; farther < 8 && !done; ++farther) {
        const std::size_t at = out                        ? std::min(first + 2 * farther, c.size() - 2)
                               : first >= 2 * farther + 1 ? first - 2 * farther
                                                          : 1;
        try {
          artery::Surface shorter = s;
          cut_off(shorter, c.points[at], out ? c.tangent(at) : Vec3(-c.tangent(at)), lines[l].name + "_end");
          if (away(shorter.mesh, neck) > away(s.mesh, neck) + 1e-6) {
            why = "the neck would go with it";
            continue;
          }
          s = std::move(shorter);
          done = true;
          notes.push_back({Note::Kind::repair,
                           fmt::format("{} was cut off {:.1f} mm from the neck ({:.1f} mm of it left out).",
                                       lines[l].name, distance[l][at], end - distance[l][at]),
                           "The fissure has room for short stretches only; --keep keeps more."});
        } catch (const InputError& e) {
          why = e.what();
        }
      }
      if (!done)
        notes.push_back(problem("end_not_cut", lines[l].name + " could not be cut off: " + why,
                                "Cut it in the program that made the surface, or with --cut."));
    }
  }
  return s;
}

}  // namespace insula::case_builder
