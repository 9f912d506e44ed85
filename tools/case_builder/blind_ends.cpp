// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/blind_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/input_error.h"
#include "tools/case_builder/level_lines.h"
#include "tools/case_builder/openings.h"

namespace insula::case_builder {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_prominence = 0.03;   // of the longest distance: what sticks out less is no end
constexpr double same_calibre = 1.3;        // largest over least diameter along a piece of one tube
constexpr double full_calibre = 0.93;       // of the diameter farther in, where an end is cut
constexpr std::size_t hidden_sections = 3;  // in a row, within a tube
constexpr double vessel_length = 1.4;       // diameters of one calibre: a short vessel, or a sac
constexpr double sure_length = 2;           // diameters of one calibre, which no sac has
constexpr double torn_length = 0.7;         // the same of a known end
constexpr double farthest = 8;              // diameters of the tube that are looked at
constexpr double dome_width = 1.3;          // diameters of the tube behind: what is so wide nearer to the tip is a dome
constexpr double dome_length = 0.5;         // the same, along the line

/// The maxima of `d` that rise `least` or more over the pass to a higher one (persistence of superlevel sets).
std::vector<int> prominent_maxima(const Geodesics& g, const std::vector<double>& d, double least) {
  std::vector<int> order(d.size()), parent(d.size(), -1), out;
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](int v) { return !std::isfinite(d[std::size_t(v)]); });
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return d[std::size_t(a)] != d[std::size_t(b)] ? d[std::size_t(a)] > d[std::size_t(b)] : a < b;
  });
  for (const int v : order) {
    parent[std::size_t(v)] = v;
    for (const int w : g.beside(v)) {
      if (parent[std::size_t(w)] < 0) continue;
      int high = root_of(parent, w), low = root_of(parent, v);  // a root is the highest vertex of its part
      if (high == low) continue;
      if (d[std::size_t(high)] < d[std::size_t(low)]) std::swap(high, low);
      if (d[std::size_t(low)] - d[std::size_t(v)] >= least) out.push_back(low);
      parent[std::size_t(low)] = high;
    }
  }
  if (!order.empty()) out.push_back(order.front());
  return out;
}

/// The plane section of the vessel whose middle is nearest to a point, of those with a diameter of `least` or more.
Loop section(const TriMesh& m, const Vec3& at, const Vec3& normal, double least) {
  std::vector<double> height;
  for (const Vec3& p : m.vertices) height.push_back((p - at).dot(normal));
  Loop out;
  double away = infinity;
  for (const Loop& loop : loops_at(m, height, 0))
    if (const double d = (loop.middle - at).norm(); loop.diameter >= least && d < away) out = loop, away = d;
  return out;
}

/// Direction of a line at one of its points, towards its first one, over `span` on both sides.
Vec3 towards_first(const std::vector<Vec3>& line, std::size_t at, double span) {
  std::size_t a = at, b = at;
  while (a > 0 && (line[a] - line[at]).norm() < span) --a;
  while (b + 1 < line.size() && (line[b] - line[at]).norm() < span) ++b;
  const Vec3 d = line[a] - line[b];
  return d.norm() > 0 ? Vec3(d.normalized()) : Vec3(Vec3::UnitZ());
}

/// Plane sections along a line.
struct Sections {
  std::vector<Loop> loop;
  std::vector<Vec3> outward;  ///< unit, towards the tip
  std::vector<double> arc;    ///< mm from the first
};
Sections sections_along(const TriMesh& m, const std::vector<Loop>& loops) {
  Sections out;
  std::vector<Vec3> line;
  std::vector<double> lengths;
  for (const Loop& l : loops) line.push_back(l.middle), lengths.push_back(l.length);
  if (line.size() < 3) return out;
  std::nth_element(lengths.begin(), lengths.begin() + long(lengths.size() / 2), lengths.end());
  const double calibre = lengths[lengths.size() / 2] / std::numbers::pi;
  double arc = 0;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    arc += (line[k] - line[k - 1]).norm();
    if (arc > farthest * calibre) break;
    // The lines of equal distance lean where the tip is beside the axis, so the direction needs a span.
    const Vec3 outward = towards_first(line, k, 0.8 * calibre);
    const double about = loops[k].length / std::numbers::pi;  // the diameter, but for that lean
    const Loop found = section(m, line[k], outward, 0.4 * about);
    const bool here = (found.middle - line[k]).norm() < 0.6 * about;
    out.loop.push_back(here ? found : Loop{line[k], loops[k].length, 0});
    out.outward.push_back(outward), out.arc.push_back(arc);
  }
  return out;
}

/// A piece of a vessel whose sections have nearly one diameter.
struct Tube {
  Vec3 end = Vec3::Zero(), outward = Vec3::UnitZ();  ///< where it is cut
  double diameter = 0;                               ///< one diameter farther in, mm
  double length = 0;                                 ///< in diameters
  bool torn = false;                                 ///< at a torn border
};

/// Turns the plane in which a tube is cut to lie across it, along the chord between two sections, and moves it inward
/// to where the tube has its full calibre.
void straighten(const TriMesh& m, Tube& tube) {
  const double least = 0.4 * tube.diameter, chord = std::min(0.8, 0.7 * tube.length) * tube.diameter;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    const Loop end = section(m, tube.end, tube.outward, least),
               inner = section(m, tube.end - chord * tube.outward, tube.outward, least);
    const Vec3 along = end.middle - inner.middle;
    const bool of_it = inner.diameter > 0 && inner.diameter < 1.5 * tube.diameter && end.diameter > 0 &&
                       end.diameter < 1.5 * tube.diameter && along.norm() > 0.5 * chord;
    if (!of_it) return;
    const Vec3 turned = along.normalized();
    const bool settled = turned.dot(tube.outward) > 0.999 && end.diameter > full_calibre * tube.diameter;
    tube.outward = turned, tube.end = end.middle;
    if (settled) return;
    if (end.diameter < full_calibre * tube.diameter) tube.end -= 0.12 * tube.diameter * tube.outward;
  }
}

/// Whether a dome lies before a section, between the tip and a tube of this diameter: a sac on a stalk.
bool dome_before(const Sections& s, std::size_t first, double diameter) {
  double wide = 0;
  for (std::size_t k = 1; k < first; ++k)
    if (s.loop[k].diameter > dome_width * diameter) wide += s.arc[k] - s.arc[k - 1];
  return wide > dome_length * diameter;
}

/// The first tube of a vessel's length on the way from a tip inward, or else the longest. What a dome lies before is
/// none: its length is 0.
Tube tube_at(const TriMesh& m, const std::vector<Loop>& lines) {
  const Sections s = sections_along(m, sections_along(m, lines).loop);
  Tube best;
  std::size_t begins = 0;  // the best one
  double begin = 0;        // the same, mm from the tip
  for (std::size_t first = 0; first < s.loop.size(); ++first) {
    std::vector<double> diameters;
    double low = infinity, high = 0;
    std::size_t last = first;
    // Noise may hide a section or two.
    for (std::size_t k = first; k < s.loop.size() && k <= last + hidden_sections; ++k) {
      const double d = s.loop[k].diameter;
      if (d <= 0) continue;
      low = std::min(low, d), high = std::max(high, d);
      if (!(high < same_calibre * low)) break;
      diameters.push_back(d), last = k;
    }
    if (diameters.empty()) continue;
    std::nth_element(diameters.begin(), diameters.begin() + long(diameters.size() / 2), diameters.end());
    const double median = diameters[diameters.size() / 2];
    // The chord: sections that stay where they are make no tube.
    const double length = (s.loop[last].middle - s.loop[first].middle).norm() / median;
    if (best.length > vessel_length && s.arc[first] > begin + best.diameter) break;
    if (!(length > best.length)) continue;
    // A vessel may taper: its calibre is that of a section one diameter farther in.
    std::size_t cut = first, inner = first;
    for (; cut < last; ++cut) {
      while (inner < last && (s.loop[inner].middle - s.loop[cut].middle).norm() < median) ++inner;
      if (s.loop[cut].diameter > full_calibre * s.loop[inner].diameter) break;
    }
    const Vec3 along = s.loop[cut].middle - s.loop[inner].middle;
    best = {s.loop[cut].middle, along.norm() > 0 ? Vec3(along.normalized()) : s.outward[cut], s.loop[inner].diameter,
            length};
    begins = first, begin = s.arc[first];
  }
  if (dome_before(s, begins, best.diameter)) return {};
  straighten(m, best);
  return best;
}

/// Whether a point lies on a cap or at its rim. A vessel that leaves a volume aslant has a long cap, so what counts is
/// the distance from its vertices, not from its centre.
bool on_cap(const artery::Surface& s, const Vec3& p) {
  for (std::size_t t = 0; t < s.patch.size(); ++t) {
    if (s.patch[t] < 0) continue;
    const double near = 0.5 * s.caps[std::size_t(s.patch[t])].radius;
    for (const int v : s.mesh.triangles[t])
      if ((s.mesh.vertices[std::size_t(v)] - p).norm() < near) return true;
  }
  return false;
}

}  // namespace

void cut_blind_ends(artery::Surface& s, const std::vector<TornBorder>& torn, std::vector<Note>& notes) {
  const Geodesics geodesics(s.mesh);
  const std::vector<double> d = geodesics.from(farthest_vertex(geodesics.from(s.mesh.triangles.front()[0])));
  std::vector<int> tips = prominent_maxima(geodesics, d, least_prominence * d[std::size_t(farthest_vertex(d))]);
  tips.push_back(int(std::min_element(d.begin(), d.end()) - d.begin()));
  std::vector<Tube> ends;
  for (const int tip : tips) {
    const Vec3& p = s.mesh.vertices[std::size_t(tip)];
    const bool known = std::any_of(torn.begin(), torn.end(), [&](const TornBorder& b) {
      return (b.centre - p).norm() < b.perimeter / std::numbers::pi;
    });
    if (!known && !on_cap(s, p)) ends.push_back(tube_at(s.mesh, lines_of_distance(s.mesh, geodesics.from(tip))));
  }
  std::stable_sort(ends.begin(), ends.end(), [](const Tube& a, const Tube& b) { return a.length < b.length; });
  // The one that is least like a vessel is the sac, unless the sac is so low that it is no end at all.
  if (!ends.empty() && ends.front().length < sure_length) ends.erase(ends.begin());
  std::erase_if(ends, [](const Tube& e) { return e.length < vessel_length; });
  for (const TornBorder& b : torn) {
    const int tip = nearest_vertex(s.mesh, b.centre);
    Tube tube = tube_at(s.mesh, lines_of_distance(s.mesh, geodesics.from(tip)));
    tube.torn = true;
    if (tube.length >= torn_length) ends.push_back(tube);
  }
  for (const Tube& e : ends) {
    try {
      cut_off(s, e.end, e.outward, fmt::format("end_{}", s.caps.size()));
    } catch (const InputError&) {
      continue;  // no single tube there
    }
    notes.push_back({Note::Kind::repair,
                     (e.torn ? fmt::format("The end at {} was torn.", place(e.end))
                             : fmt::format("The end at {} was closed and not flat.", place(e.end))) +
                         fmt::format(" It was cut straight where the vessel is {:.2f} mm wide.", e.diameter),
                     "Where it should end farther in, cut it there (--cut)."});
  }
}

}  // namespace insula::case_builder
