// SPDX-License-Identifier: GPL-3.0-or-later
// Brings an author's brain to where arms, hands and microscope stand: a rigid motion that lays its Sylvian fissure over
// the shipped one.
#pragma once
#include <vector>

#include "tools/case_builder/place.h"
#include "tools/mesh_lobes/cleft.h"

namespace insula::case_builder {

/// The course of a fissure: two lines, where it opens and where its floor is. Millimetres, MNI.
struct Course {
  std::vector<Vec3> superficial, deep;
};
Course course_of(const mesh_tool::Cleft& cleft);
/// Of the shipped lobes (meshes/lobes/fissure.json), as far as it matters: within 16 mm of the middle of what the
/// exercises open.
Course shipped_course(const Approach& approach);
/// Where that stands among the approach's meshes. Not every approach has one.
fs::path course_file(const Approach& approach);

/// How far the points of `wanted` are from the lines of `course`, root mean square, mm.
double distance(const Course& wanted, const Course& course);

/// The motion that lays `course` over `wanted`: iterated closest points (Besl, McKay 1992), each round solved by
/// Umeyama's method (1991).
Placement fit(const Course& wanted, const Course& course);
Course moved(Course course, const Placement& placement);

}  // namespace insula::case_builder
