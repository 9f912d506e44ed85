// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses how a blade is swept through a strand: from which side, how deep, and with how much room around the tool.
#pragma once
#include <array>
#include <vector>

#include "plugins/strand_springs/strand_set.h"
#include "tools/motions/clearance.h"
#include "tools/motions/hands.h"

namespace insula {

/// A ball of the tool's shape for clearance, tool frame.
struct Ball {
  Vec3 at;
  double radius;
};

struct Field {
  Vec3 centre, outward;  ///< the sac's middle, and the direction to the surgeon
  Vec3 lean;             ///< usual direction of the shaft
  const Clearance *vessel, *others;
};

struct Sweep {
  int strand = -1;
  Vec3 shaft, across, middle;     ///< the tip passes `middle` along `across`
  double half = 0;                ///< to both sides, m
  double vessel = 0, others = 0;  ///< smallest clearance on the path, m
  double score = -1e9;
  Pose pose(double offset) const { return tool_pose(middle + offset * across, shaft, across); }
};

class SweepPlanner {
 public:
  SweepPlanner(const ToolModel& tool, const Field& field, double reach, double cut_length);
  /// Finds the best sweep through one of the undivided strands. tries: number of failed sweeps of each strand.
  /// thorough: also tests steep shafts, positions near a strand's ends, oblique blades and more pressure on lobes.
  Sweep best(const std::vector<StrandState>& strands, const std::vector<int>& tries, const Vec3& tip,
             bool thorough = false) const;
  /// Smallest clearance of the whole tool at a pose, m.
  double room(const Pose& pose, double* vessel = nullptr, double* others = nullptr) const;
  /// Smallest clearance on the straight path between two poses, m.
  double room(const Pose& from, const Pose& to) const;

 private:
  /// Path of the blade through a strand in a sweep, over the path that divides it.
  double cutting(const Sweep& sweep, const StrandState& strand) const;
  /// Input and candidates of one search for the best sweep.
  struct Search {
    const std::vector<StrandState>& strands;
    std::vector<double> reachability;  ///< score of each strand without regard to obstacles
    bool thorough;
    std::vector<double> positions = {0.5, 0.35, 0.65, 0.2, 0.8};      ///< along a strand, as a share of its length
    std::vector<double> depths = {0.2e-3, -0.15e-3, 0.7e-3, 1.4e-3};  ///< depths of the tip beyond the strand, m
    double press = 0.5e-3;  ///< depth by which a yielding lobe may be pushed in, m
  };
  std::vector<Vec3> shafts(bool thorough) const;
  std::vector<double> reachability(const std::vector<StrandState>& strands, const std::vector<int>& tries,
                                   const Vec3& tip) const;
  void try_shaft(const Search& search, std::size_t strand, const Vec3& shaft, Sweep& best) const;
  void judge(const Search& search, Sweep& sweep, Sweep& best) const;

  std::vector<Ball> balls_;
  std::vector<std::array<Vec3, 2>> edges_;
  Field field_;
  double reach_, cut_length_;
};

}  // namespace insula
