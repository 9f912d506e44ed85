// SPDX-License-Identifier: GPL-3.0-or-later
// The result of one step as plain data, for exercise rules, the recorder, the publisher and the report writer.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/constraint/solve.h"
#include "core/linalg/inexact_solver.h"
#include "core/sim/events.h"
#include "core/sim/structure_forces.h"

namespace insula {

class Body;
class ChannelTable;
class Component;
class Instrument;
class Surface;

enum Stage { stage_free_motion, stage_collision, stage_build, stage_solve, stage_correct, stage_publish, stage_count };

/// The part of a body that touches.
struct ContactPart {
  const Surface* surface = nullptr;  ///< of the body; null: of a rigid body, its own pieces
  int link = 0;                      ///< of a rigid body, whose pieces touch
};

struct ContactPoint {
  const Body* a = nullptr;  ///< pushed along +normal
  const Body* b = nullptr;  ///< pushed along -normal
  ContactPart part_a, part_b;
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  double gap = 0;                     ///< start of step, m
  double normal_force = 0;            ///< N
  Vec3 tangent_force = Vec3::Zero();  ///< on a, N
};

struct ToolReport {
  const Body* tool = nullptr;
  int hand = 0;
  Vec6 hand_force = Vec6::Zero();  ///< coupling force and torque on the hand
  double contact_force = 0;        ///< norm of the sum of the contact forces on it and on all that it holds, N
};

/// A hand and the tool in it, at the end of the step.
struct HandReport {
  bool present = false;              ///< a device moves it
  const Instrument* tool = nullptr;  ///< null: none
  Pose device;                       ///< of the hand, scene frame
  Pose tip;                          ///< of the tool, scene frame; +z along the shaft to the handle
  std::array<bool, 2> button{};
  double contact_force = 0;  ///< ToolReport::contact_force, N
};

struct StepReport {
  double time = 0;  ///< at the end of the step, s
  double h = 0;
  std::int64_t step = 0;
  int rows = 0;
  SolveStats solve;
  SolverStatus solver;  ///< of the bodies' solvers: the worst status, and the number of all factors
  double defect_m = 0;  ///< largest change of a row in the last pass of defect correction, m; 0: every body is exact
  std::vector<ContactPoint> contacts;
  std::vector<ToolReport> tools;
  std::array<HandReport, 2> hands;              ///< left, right
  std::vector<StructureForce> structures;       ///< forces of the hands on all structures, document order
  const ChannelTable* channel_table = nullptr;  ///< of the simulation; null: there are no channels
  std::vector<double> channels;                 ///< SI, in the order of the table; NaN: not known now
  std::array<double, stage_count> stage_ms{};
  double step_ms = 0;
  std::vector<Event> events;  ///< of this step, without those of the exercise
  bool finite = true;
  void clear();
};

}  // namespace insula
