// SPDX-License-Identifier: GPL-3.0-or-later
// The centrelines of a vessel as a graph of stretches. Each stretch has stations at distances of about `spacing`, with
// a cross-section of the wall. Its chamber stores blood at the node in its middle.
#pragma once
#include <string>
#include <vector>

#include "core/model/wall_model.h"
#include "plugins/blood_flow/section.h"

namespace insula {

/// A cross-section and its lumen at rest.
struct Cut {
  Section section;
  Lumen rest;
};

/// A place of a centreline. A clip may lie across the vessel at any angle, so the wall is cut there in several
/// directions. The lumen is that of the cross-section that is narrowed most.
struct Station {
  std::vector<Cut> cuts;  ///< the first one is perpendicular to the centreline, the others are oblique by up to 30
                          ///< degrees; none: the wall could not be cut, and the lumen stays that of the centreline
  double length = 0;      ///< of its part of the stretch, m
  Lumen rest;             ///< lumen of the perpendicular cross-section at rest
  Lumen now;
  double share = 1;  ///< of the lumen at rest, of the cross-section that is narrowed most
  bool open = true;
  double resistance = 0;  ///< Pa s/m3, of its part
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
  bool dead_end = false;                ///< leads from `from` to no other end: a sac; its middle is the widest station
  double narrowest = 1;                 ///< smallest ratio of a station's lumen to that at rest
};

struct VesselGraph {
  struct Node {
    std::string name;  ///< of the junction or cap; empty in the middle of a stretch
    Vec3 place = Vec3::Zero();
    int cap = -1;  ///< index of the cap that contains it, or -1
  };
  std::vector<Node> nodes;
  std::vector<Stretch> stretches;  ///< in the order of the model's centrelines
  std::vector<Branch> branches;    ///< two for each stretch, one for a dead end

  /// An end that no other centreline and no cap shares becomes a dead end. A part without a cap is joined to the
  /// nearest junction or middle of the rest. Returns the error text, or an empty text.
  std::string build(const WallModel& model, const std::vector<std::array<int, 3>>& wall, double thickness,
                    double spacing);
  /// Cross-sections and conductances on the current wall. A section below `closed_below` of its lumen at rest is
  /// closed. Oblique ones are measured where the perpendicular one is narrowed.
  void measure(const VecX& q, double thickness, double viscosity, double closed_below);

 private:
  int node(const std::string& name, const Vec3& place, const WallModel& model);
  void add_stations(Stretch& s, const WallModel::Centreline& line, const std::vector<Vec3>& vertices,
                    const std::vector<std::array<int, 3>>& wall, double thickness, double spacing);
  std::string join_parts();
};

}  // namespace insula
