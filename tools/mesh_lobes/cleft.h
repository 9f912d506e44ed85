// SPDX-License-Identifier: GPL-3.0-or-later
// Describes the cleft between two parts: its superficial opening as a polyline, its depth, and the direction out.
#pragma once

#include <string>
#include <vector>

#include "part_fields.h"

namespace insula::mesh_tool {

struct CleftStation {
  Vec3 superficial{};  // where the cleft opens, mm
  Vec3 deep{};         // where its floor is, mm
  Vec3 inward{};       // unit, from superficial to deep
  double depth = 0;    // mm
};

struct Cleft {
  std::vector<CleftStation> stations;  // in order along the opening
  Vec3 outward{};                      // unit mean normal of the tissue's surface about the opening
  Vec3 centre{};                       // middle of the opening, mm
  double length = 0;                   // of the polyline, mm
};

// `view` points from the field towards the observer. Stations lie `step` mm apart along the cleft's long axis; a
// station is the point of the mid-surface (equally far from both parts, at most `width` mm between them) nearest the
// observer, smoothed along the line. Points nearer than `rim` mm to the region's border are left out.
Cleft describe_cleft(const PartFields& fields, std::size_t a, std::size_t b, const FieldOptions& options,
                     const Vec3& view, double width = 6, double step = 4, double rim = 5);

void write_cleft_json(const std::string& path, const Cleft& cleft, const std::string& name_a, const std::string& name_b,
                      const FieldOptions& options);

}  // namespace insula::mesh_tool
