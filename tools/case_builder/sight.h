// SPDX-License-Identifier: GPL-3.0-or-later
// What stands between the surgeon's eye and the neck of a placed vessel.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/artery/vessel.h"
#include "tools/case_builder/fissure.h"

namespace insula::case_builder {

/// Shares of the neck's near side, from 0 to 1. They add up to 1.
struct Sight {
  double seen = 0;
  std::vector<std::pair<std::string, double>> hidden;  ///< by what the line from the neck to the eye meets first
};

/// The near side is the half of the neck's line (neck_frame.h) that faces the eye from which the clipping is seen.
/// Each of its points is joined with the eye by a straight line. What may hide it: lobes, floor and bone of the fissure
/// as it is given, the retractors, and the vessel itself, here "vessel". Throws InputError without a neck.
Sight sight_of_neck(const artery::Vessel& placed, const Fissure& fissure);

/// Where the line from a point to another one first meets a surface, as a share of its length; 2: nowhere.
double first_meeting(const TriMesh& mesh, const Vec3& from, const Vec3& to);

}  // namespace insula::case_builder
