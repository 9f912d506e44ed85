// SPDX-License-Identifier: GPL-3.0-or-later
// Which clip fits a neck, where its blades go, and how a hand brings it there. Millimetres, seconds.
#pragma once
#include <string>
#include <vector>

#include "tools/artery/vessel.h"
#include "tools/case_builder/approach.h"
#include "tools/case_builder/solid.h"

namespace insula::case_builder {

/// A clip of the library as far as planning needs it; its own frame: +x closes, +z to the hinge.
struct ClipShape {
  std::string name, kind;
  double blade = 0, opening = 0;  ///< mm
  Vec3 middle, inward;            ///< of the blades; unit, from root to tip
  Vec3 grip;                      ///< as high as the hinge
  double open_sine = 0;           ///< of the angle by which each jaw opens

  /// From the plane between the blades to an open one where it is at the height z, mm.
  double half_open(double z) const { return (grip.z() - z) * open_sine; }
  /// Between the tips of open blades, mm.
  double tips_open() const { return 2 * half_open((middle + 0.5 * blade * inward).z()); }
};
/// All clips of meshes/clips with straight clamping lines that lie in the clip's own plane. Throws InputError.
std::vector<ClipShape> read_clips(const fs::path& project);

/// A pose of the applier that holds a clip.
struct ApplierPose {
  Vec3 tip, flat, shaft;  ///< flat: direction in which the blades close (+x); unit
  /// From the frame of a clip that it holds: +x closes, +z to the hinge.
  Mat3 rotation() const {
    Mat3 m;
    m << flat, shaft.cross(flat), shaft;
    return m;
  }
};
ApplierPose applier_pose(const ClipShape& clip, const Vec3& middle, const Vec3& inward, const Vec3& closing);

/// The neck in its own plane.
struct NeckSize {
  double perimeter = 0;          ///< mm
  double along = 0, across = 0;  ///< extents along the blades and in their closing direction, mm
};
NeckSize neck_size(const artery::Vessel& vessel, const Vec3& along);

/// Where the blades lie at a neck.
struct BladePlacement {
  double lift = 0;        ///< of the blades over the neck's plane, mm
  double slide = 0;       ///< of the blades' middle beyond the neck's, away from the surgeon, mm
  double turn = 0;        ///< about the dome's axis from the surgeon's side, degrees
  bool mirrored = false;  ///< the blade that closes in the direction of +x lies on the other side
  bool operator==(const BladePlacement&) const = default;
};
struct ClipPlan {
  ClipShape clip;
  Vec3 to_surgeon = Vec3::UnitZ();  ///< unit
  BladePlacement at;
  ApplierPose pose;
  double needed = 0;         ///< length that the flattened neck asks for, mm
  double off_view = 0;       ///< of the shaft from the line of sight, degrees
  double dome_outside = 0;   ///< how far the sac reaches out of the space between open blades on their way in, mm
  double branch_caught = 0;  ///< share of a branch's lumen that the blades would close
  double drawn_back = 0;  ///< how far the tips stay short of where they should be, so that they keep off the floor, mm
  double cost = 0;        ///< the less, the better it seems to fit

  /// Lays the blades elsewhere at the neck.
  void lay(const artery::Neck& neck, const BladePlacement& where);
  bool too_short() const;  ///< the blades do not reach over the flattened neck
  bool kept_back() const;  ///< the floor keeps the tips from the neck's far side
  bool leaves_remnant() const { return too_short() || kept_back(); }
  bool meets_dome() const;  ///< open blades do not pass the sac on their way in
};
/// The share of its lumen that closed blades take of the branch which lies most between them, 0 to 1.
double branch_between_blades(const artery::Vessel& vessel, const ClipShape& clip, const ApplierPose& pose);
/// How far the sac reaches out of the space between the open blades of an applier that comes along its shaft, mm.
double outside_of_blades(const artery::Vessel& vessel, const ClipShape& clip, const ApplierPose& pose);

/// Which clips are tried, and which blades keep off the floor.
enum class Care {
  usual,  ///< clips whose tips open by less than 10 mm; shut blades
  more    ///< all clips; open blades too, where a millimetre is enough for that
};

/// The options' choices for a placed vessel's neck, best first. The tips keep off `floor` (which does not
/// give way: blades that run against it are lifted off the neck). Throws InputError when a wanted clip does not exist.
std::vector<ClipPlan> clip_plans(const artery::Vessel& vessel, const Solid& floor, const std::vector<ClipShape>& clips,
                                 const Options& options, const Approach& approach, Care care = Care::usual);
/// What is wrong with a plan.
std::vector<Note> notes_of(const ClipPlan& plan);

/// A temporary clip across the parent, before the neck; it keeps off the floor too.
ApplierPose plan_temporary(const artery::Vessel& vessel, const Solid& floor, const ClipShape& clip,
                           const Approach& approach);

}  // namespace insula::case_builder
