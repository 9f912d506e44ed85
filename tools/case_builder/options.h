// SPDX-License-Identifier: GPL-3.0-or-later
// What an author may choose for a case, kept in the case's folder so that a stage can be done again with the same
// choices.
#pragma once
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace insula::case_builder {

using Point = std::array<double, 3>;
using Plane = std::array<double, 6>;  ///< a point and a normal
/// A motion x' = R x + shift: the shift in mm, and R as an axis times its angle in degrees.
using RigidMotion = std::array<double, 6>;
using Json = nlohmann::ordered_json;

/// A line along which something was painted or erased, with a ball for a brush; mm.
struct Stroke {
  bool erase = false;
  double radius_mm = 1;
  std::vector<Point> points;
};

/// A part of the wall about points of it, with a thickness and a modulus of its own. Texts have their unit; empty:
/// those of the region in which the first point lies.
struct WallPatch {
  std::vector<Point> points;
  double radius_mm = 1;
  std::string thickness, young;
};

/// A brain retractor, in the frame of the approach's meshes, in mm. What is not given is as that of the approach's
/// retractor of the same lobe.
struct RetractorChoice {
  std::string lobe;
  Point tip{};
  std::optional<Point> shaft, flat;  ///< directions: to the handle, and of the side that presses the lobe
  std::optional<double> pull;        ///< how far it draws the lobe aside while the scene settles
};

/// Lengths in millimetres, positions in the frame of the input after its unit has been applied, before it is mirrored.
struct Options {
  // intake
  std::optional<double> unit_mm;    ///< millimetres a unit of a surface file; none: what the format says, else 1
  bool mirror = false;              ///< the input, vessel and brain, is of the left side: x changes its sign (mirror.h)
  bool any_size = false;            ///< sizes that no cerebral artery has are taken all the same
  std::optional<double> threshold;  ///< of a grey volume: vessel from here up
  std::optional<int> label;         ///< of a label volume
  std::optional<Point> seed;        ///< the piece nearest to this point is the vessel; by default the largest
  std::optional<double> around;     ///< of a volume: what is farther from the seed along an axis is left out
  std::vector<Stroke> paint;        ///< of a volume: painted into the vessel, or erased
  bool keep_largest = false;        ///< even when other pieces are large
  std::optional<double> rebuild;    ///< a surface is made anew from a grid of that spacing
  std::vector<Plane> cuts;  ///< what lies beyond is cut off and the opening closed; the normal points to what goes
  double smoothing = 1;     ///< of a volume's border, in its voxels
  // wall
  std::optional<Plane> neck;                         ///< in place of the proposed one; the normal points to the dome
  std::optional<std::array<double, 6>> neck_points;  ///< two points on opposite sides of the neck
  std::optional<Point> inlet;                        ///< the opening nearest to it; by default the widest
  double keep = 13;                ///< vessels are cut off so far along their centrelines from the neck; 0: nowhere
  int vertices = 1650;             ///< of the wall, about
  bool keep_vertices = false;      ///< they are the author's own
  std::optional<int> coarser;      ///< fewer vertices, which real time asked for (real_time.h)
  double bleb = 1;                 ///< radius of the weak spot at the dome; 0: none
  std::vector<std::string> walls;  ///< changes of a region's thickness and modulus (region_walls.h)
  std::vector<WallPatch> wall_patches;  ///< parts of the wall, the later ones over the earlier (wall_patches.h)
  // brain
  std::vector<std::string>
      brain;  ///< a volume of labels; NAME=FILE for each lobe; or one closed surface. Empty: the shipped lobes
  std::vector<std::string> lobe_labels;  ///< NAME=LIST, such as frontal=2,4,10-16
  std::optional<double> brain_unit_mm;   ///< millimetres a unit of the brain's surface files
  bool brain_in_place = false;           ///< it is not moved to where the arms and the microscope stand
  int brain_nodes = 1000;                ///< of both lobes together, at most
  // place
  std::string approach = "sylvian";  ///< the way to the aneurysm, of meshes/*/approach.json
  bool in_place = false;             ///< the input lies in the frame of the lobes already
  double gap = 0.4;                  ///< between the wall and the lobes
  double spin = 0;  ///< turns the vessel about the sac's axis, degrees, after which the place is looked for nearby
  std::optional<RigidMotion> pose;  ///< in place of the search: where the vessel is moved to
  /// In place of those of the approach; an empty list: none.
  std::optional<std::vector<RetractorChoice>> retractors;
  bool keep_spin = false;  ///< no other spin is tried
  std::string lobes;       ///< folder with lobes as those of meshes/lobes; empty: those
  // scenes
  std::string site;                         ///< of the aneurysm, a choice of Exercise::site; empty: not said
  int difficulty = 0;                       ///< 1 to 5; 0: not said
  std::string clip;                         ///< of meshes/clips; empty: chosen for the neck
  std::optional<double> lift, slide, turn;  ///< of the clip's blades at the neck, mm, mm, degrees; none: chosen
  int plays = 16;                           ///< placements of the clip that are played, at most
  std::vector<std::string> rules;           ///< changes of goals, faults and complications (rules.h)
  bool rehearse = true;                     ///< the exercises are played, to find scripted hands that succeed

  int wall_vertices() const { return keep_vertices ? vertices : coarser.value_or(vertices); }
};

Json to_json(const Options& options);
/// Throws nlohmann::json::exception.
std::vector<Stroke> strokes_from_json(const Json& json);
/// Throws InputError when the text is none of ours.
Options options_from_json(const Json& json);

}  // namespace insula::case_builder
