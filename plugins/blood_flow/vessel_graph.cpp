// SPDX-License-Identifier: GPL-3.0-or-later
// Stations, nodes and branches from centrelines.
#include "plugins/blood_flow/vessel_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.h"

namespace insula {
namespace {

/// Oblique cross-sections are measured where the perpendicular one has less than this share of its lumen at rest.
constexpr double narrowed = 0.9;
constexpr int tilts = 5, azimuths = 12;
constexpr double tilt_step = std::numbers::pi / 30;  // 6 degrees: half of the width of a blade at 6 mm

/// The cross-sections through a point of a centreline. No larger one than `largest` times the perpendicular one is
/// taken, since its plane cuts other vessels too.
std::vector<Cut> cuts_at(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& wall,
                         const VecX& rest, const Vec3& at, const Vec3& along, double thickness) {
  constexpr double largest = 1.5;
  std::vector<Cut> out;
  const auto add = [&](const Vec3& normal) {
    Section section = cut(vertices, wall, at, normal);
    const Lumen lumen = section.lumen(rest, thickness);
    if (section.corners.empty() || !(lumen.area > 0)) return;
    if (!out.empty() && lumen.area > largest * out.front().rest.area) return;
    out.push_back({std::move(section), lumen});
  };
  const Vec3 n = along.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  add(n);
  if (out.empty()) return out;
  for (int i = 1; i <= tilts; ++i)
    for (int k = 0; k < azimuths; ++k) {
      const double azimuth = 2 * std::numbers::pi * k / azimuths, tilt = i * tilt_step;
      add(std::cos(tilt) * n + std::sin(tilt) * (std::cos(azimuth) * u + std::sin(azimuth) * v));
    }
  return out;
}

/// The lumen of the cross-section that is narrowed most, and its share of its lumen at rest.
double narrowest_cut(const std::vector<Cut>& cuts, const VecX& q, double thickness, Lumen& now) {
  now = cuts.front().section.lumen(q, thickness);
  double share = now.area / cuts.front().rest.area;
  if (share >= narrowed) return share;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const Lumen l = cuts[i].section.lumen(q, thickness);
    if (l.area >= share * cuts[i].rest.area) continue;
    share = l.area / cuts[i].rest.area;
    now = l;
  }
  return share;
}

}  // namespace

int VesselGraph::node(const std::string& name, const Vec3& place, const WallModel& model) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].name == name) return int(i);
  Node n{name, place, -1};
  for (std::size_t c = 0; c < model.caps.size(); ++c)
    if (model.caps[c].name == name) n.cap = int(c);
  nodes.push_back(std::move(n));
  return int(nodes.size()) - 1;
}

void VesselGraph::add_stations(Stretch& s, const WallModel::Centreline& line, const std::vector<Vec3>& vertices,
                               const std::vector<std::array<int, 3>>& wall, double thickness, double spacing) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < line.points.size(); ++i)
    along.push_back(along.back() + (line.points[i] - line.points[i - 1]).norm());
  const int count = std::max(2, int(std::ceil(along.back() / spacing - 1e-9)));
  const double length = along.back() / count;
  VecX rest(3 * Eigen::Index(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) rest.segment<3>(3 * Eigen::Index(i)) = vertices[i];
  std::size_t k = 0;
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) * length;
    while (k + 2 < along.size() && along[k + 1] < at) ++k;
    const double w = (at - along[k]) / (along[k + 1] - along[k]);
    const Vec3 p = (1 - w) * line.points[k] + w * line.points[k + 1];
    const double r = (1 - w) * line.radius[k] + w * line.radius[k + 1];
    // The direction is taken over a station's length to both sides, since centrelines may have closer points.
    const auto point = [&](double t) -> Vec3 {
      t = std::clamp(t, 0.0, along.back());
      std::size_t j = std::size_t(std::upper_bound(along.begin(), along.end(), t) - along.begin());
      j = std::clamp<std::size_t>(j, 1, along.size() - 1);
      const double x = (t - along[j - 1]) / (along[j] - along[j - 1]);
      return (1 - x) * line.points[j - 1] + x * line.points[j];
    };
    Station station;
    station.length = length;
    station.cuts = cuts_at(vertices, wall, rest, p, point(at + length) - point(at - length), thickness);
    if (!station.cuts.empty()) station.rest = station.cuts.front().rest;
    // At a junction the plane may cut more vessels than this one.
    const double inner = std::max(r - 0.5 * thickness, 0.3 * r), own = std::numbers::pi * inner * inner;
    if (station.cuts.empty() || (station.rest.area > 4 * own && !s.dead_end)) {
      station.cuts.clear();
      station.rest = {own, 2 * std::numbers::pi * inner};
    }
    station.now = station.rest;
    s.stations.push_back(std::move(station));
  }
}

std::string VesselGraph::join_parts() {
  while (true) {
    std::vector<int> part(nodes.size());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = int(i);
    std::vector<char> used(nodes.size(), 0), fed(nodes.size(), 0);
    for (std::size_t pass = 0; pass < stretches.size(); ++pass)
      for (const Stretch& s : stretches) {
        const int least = std::min({part[std::size_t(s.from)], part[std::size_t(s.middle)], part[std::size_t(s.to)]});
        for (int n : {s.from, s.middle, s.to}) {
          part[std::size_t(n)] = least;
          used[std::size_t(n)] = 1;
        }
      }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (used[i] && nodes[i].cap >= 0) fed[std::size_t(part[i])] = 1;
    int own = -1, other = -1, lost = -1;
    double best = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!used[i] || fed[std::size_t(part[i])] || nodes[i].name.empty()) continue;
      lost = int(i);
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        if (!used[j] || !fed[std::size_t(part[j])] || nodes[j].cap >= 0) continue;
        const double d = (nodes[i].place - nodes[j].place).norm();
        if (own >= 0 && d >= best) continue;
        best = d;
        own = int(i);
        other = int(j);
      }
    }
    if (lost < 0) return {};
    if (own < 0)
      return "centreline end " + in_quotes(nodes[std::size_t(lost)].name) + " leads to no opening (cap) of the vessel";
    for (Stretch& s : stretches) {
      if (s.from == own) s.from = other;
      if (s.to == own) s.to = other;
    }
  }
}

std::string VesselGraph::build(const WallModel& model, const std::vector<std::array<int, 3>>& wall, double thickness,
                               double spacing) {
  nodes.clear();
  stretches.clear();
  branches.clear();
  if (model.centrelines.empty()) return "the vessel has no centrelines";
  for (const auto& line : model.centrelines) {
    Stretch s;
    s.name = line.name;
    s.region = line.region;
    s.from = node(line.from, line.points.front(), model);
    s.to = node(line.to, line.points.back(), model);
    s.middle = int(nodes.size());
    nodes.push_back({"", line.points[line.points.size() / 2], -1});
    stretches.push_back(std::move(s));
  }
  if (std::string why = join_parts(); !why.empty()) return why;
  std::vector<int> uses(nodes.size(), 0);
  for (const Stretch& s : stretches) {
    ++uses[std::size_t(s.from)];
    ++uses[std::size_t(s.to)];
  }
  const auto loose = [&](int n) { return uses[std::size_t(n)] == 1 && nodes[std::size_t(n)].cap < 0; };
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    Stretch& s = stretches[i];
    WallModel::Centreline line = model.centrelines[i];
    if (loose(s.from) && !loose(s.to)) {  // a dead end leads away from the vessel
      std::swap(s.from, s.to);
      std::reverse(line.points.begin(), line.points.end());
      std::reverse(line.radius.begin(), line.radius.end());
    }
    s.dead_end = loose(s.to);
    add_stations(s, line, model.wall.vertices, wall, thickness, spacing);
    const int n = int(s.stations.size());
    int half = n / 2;
    if (s.dead_end) {
      half = 0;
      for (int k = 1; k < n; ++k)
        if (s.stations[std::size_t(k)].rest.area > s.stations[std::size_t(half)].rest.area) half = k;
      half = std::max(half, 1);
    }
    branches.push_back({s.from, s.middle, 0, half, int(i)});
    if (!s.dead_end) branches.push_back({s.middle, s.to, half, n, int(i)});
  }
  return {};
}

void VesselGraph::measure(const VecX& q, double thickness, double viscosity, double closed_below) {
  for (Stretch& s : stretches) {
    s.narrowest = 1;
    for (Station& t : s.stations) {
      t.share = t.cuts.empty() ? 1 : narrowest_cut(t.cuts, q, thickness, t.now);
      t.open = t.share > closed_below;
      t.resistance = t.open ? resistance_per_length(t.now, viscosity) * t.length : 0;
    }
  }
  for (Branch& b : branches) {
    Stretch& s = stretches[std::size_t(b.stretch)];
    double resistance = 0;
    bool open = true;
    for (int k = b.first; k < b.last; ++k) {
      const Station& t = s.stations[std::size_t(k)];
      open = open && t.open;
      resistance += t.resistance;
      s.narrowest = std::min(s.narrowest, t.open ? t.share : 0.0);
    }
    b.conductance = open ? 1 / resistance : 0;
  }
}

}  // namespace insula
