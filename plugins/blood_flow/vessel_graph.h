// SPDX-License-Identifier: GPL-3.0-or-later
// The centrelines of a vessel as a graph of stretches. Each stretch has stations about every `spacing` with a
// cross-section of the wall. The node in its middle is where its chamber stores blood.
#pragma once
#include <string>
#include <vector>

#include "core/model/wall_model.h"
#include "plugins/blood_flow/section.h"

namespace insula {

struct Station {
  Section section;    ///< no corners: no section could be cut, and the lumen stays that of the centreline
  double length = 0;  ///< of the stretch it stands for, m
  Lumen rest;         ///< lumen at rest
  Lumen now;
  bool open = true;
  double resistance = 0;  ///< Pa s/m3, of its stretch
  double dye = 0;
};

/// Half a stretch, between an end and the middle; flow is positive from `a` to `b`.
struct Branch {
  int a = -1, b = -1;       ///< nodes
  int first = 0, last = 0;  ///< stations [first, last) of the stretch
  int stretch = 0;
  double conductance = 0;  ///< m3/(s Pa); 0: closed
  double flow = 0;         ///< m3/s
};

struct Stretch {
  std::string_view name, region;
  std::vector<Station> stations;
  int from = -1, to = -1, middle = -1;  ///< nodes
  bool dead_end = false;                ///< leads from `from` to nowhere: a sac; its middle is the widest station
  double narrowest = 1;                 ///< lumen over that at rest, the minimum of its stations
};

struct VesselGraph {
  struct Node {
    std::string name;  ///< of the junction or cap; empty in the middle of a stretch
    Vec3 place = Vec3::Zero();
    int cap = -1;  ///< index of the cap it lies in
  };
  std::vector<Node> nodes;
  std::vector<Stretch> stretches;  ///< as the model's centrelines
  std::vector<Branch> branches;    ///< two a stretch, one for a dead end

  /// Ends that no other centreline and no cap shares become dead ends. A part without a cap is joined to the nearest
  /// junction or middle of the rest. Returns what is wrong, or an empty text.
  std::string build(const WallModel& model, const std::vector<std::array<int, 3>>& wall, double thickness,
                    double spacing);
  /// Cross-sections and conductances on the current wall. A section below `closed_below` of its lumen at rest is
  /// closed.
  void measure(const VecX& q, double thickness, double viscosity, double closed_below);

 private:
  int node(const std::string& name, const Vec3& place, const WallModel& model);
  void add_stations(Stretch& s, const WallModel::Centreline& line, const std::vector<Vec3>& vertices,
                    const std::vector<std::array<int, 3>>& wall, double thickness, double spacing);
  std::string join_parts();
};

}  // namespace insula
