// SPDX-License-Identifier: GPL-3.0-or-later
// What one step did, as plain data: read by exercise rules, the recorder, the publisher and the report writer.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/constraint/solve.h"
#include "core/linalg/body_solver.h"
#include "core/sim/events.h"

namespace insula {

class Body;
class Component;

enum Stage { stage_free_motion, stage_collision, stage_build, stage_solve, stage_correct, stage_publish, stage_count };

struct ContactPoint {
  const Body* a = nullptr;   ///< pushed along +normal
  const Body* b = nullptr;   ///< pushed along -normal
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  double gap = 0;            ///< start of step, m
  double normal_force = 0;   ///< N
  Vec3 tangent_force = Vec3::Zero();  ///< on a, N
};

struct StrandState {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  ///< end points, scene frame
  double integrity = 1;    ///< 1 whole, 0 about to be severed, -1 severed
  double tension = 0;   ///< N
};

/// A stretch of vessel, or the sac, as the blood sees it.
struct VesselState {
  std::string_view id;       ///< of the network element: "superior", "sac"; lives as long as the simulation
  double pressure = 0;       ///< Pa, of this moment
  double flow = 0;           ///< m3/s, mean of the last heartbeat
  double flow_at_rest = 0;   ///< m3/s, the same before anything was touched
  double lumen = 1;          ///< narrowest cross-section over its own at rest
  double dye = 0;            ///< concentration of indocyanine green, 0..1
};

/// Blood outside the vessels.
struct BleedingState {
  bool open = false;         ///< there is a tear
  double rate = 0;           ///< of blood out of the tear, m3/s, of this moment; 0 while it flows back
  double lost = 0;           ///< m3 since the tear, less what flowed back
  double height = 0;         ///< of the blood over the bottom of the field, m; 0: dry
  Vec3 origin = Vec3::Zero();///< bottom of the field, scene frame
  Vec3 up = Vec3::UnitZ();   ///< the blood's surface stands at origin + height * up, normal up
  double radius = 0;         ///< of the field, m
  double since = -1;         ///< simulated time of the rupture, s; -1: none yet
};

struct ClipState {
  const Body* clip = nullptr;
  const Body* holder = nullptr;  ///< the applier that holds it, null: released or on the tray
  bool on_tray = true;
  bool temporary = false;
  double opening = 0;            ///< rad
  double force = 0;              ///< of the blades on what is between them, N
  double gap = 0;                ///< between the blades at their middle, m
  Vec3 blade_root = Vec3::Zero(), blade_tip = Vec3::Zero();  ///< line midway between the blades, scene frame, m
  double blade_width = 0;        ///< m
  int applications = 0;          ///< times it was released in the field
};

struct ToolReport {
  const Body* tool = nullptr;
  int hand = 0;
  Vec6 hand_force = Vec6::Zero();   ///< coupling force and torque on the hand
  double contact_force = 0;         ///< norm of the sum of its contact forces, N
};

struct StepReport {
  double time = 0;   ///< at the end of the step, s
  double h = 0;
  std::int64_t step = 0;
  int rows = 0;
  SolveStats solve;
  SolverStatus solver;   ///< of the bodies' solvers: the worst, and all factors taken into use
  double defect_m = 0;   ///< largest change of a row that the last pass of defect correction made, m; 0: every body is exact
  std::vector<ContactPoint> contacts;
  std::vector<StrandState> strands;  ///< all sets in document order
  int strands_total = 0, strands_left = 0;
  std::vector<ToolReport> tools;
  std::vector<VesselState> vessels;  ///< document order
  std::vector<BleedingState> bleeding;
  std::vector<ClipState> clips;
  double heart_phase = 0;            ///< 0..1, 0 the start of systole
  std::array<double, stage_count> stage_ms{};
  double step_ms = 0;
  std::vector<Event> events;         ///< of this step, before the exercise speaks
  bool finite = true;
  void clear();
};

}  // namespace insula
