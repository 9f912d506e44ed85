// SPDX-License-Identifier: GPL-3.0-or-later
// The elements that are not plugins.
#include "core/mechanics/obstacle.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"
#include "core/scene/material_element.h"
#include "core/scene/scene.h"
#include "core/sim/complications.h"
#include "core/sim/exercise.h"
#include "core/sim/settings.h"

namespace insula {

namespace {

void add_materials(Registry& registry) {
  const auto tissue = [&](const char* name, std::array<double, 4> rgba) {
    registry.add_material({name, "tissue", rgba, 0.45, 0, 0.2});
  };
  tissue("cortex", {0.62, 0.36, 0.32, 1});
  tissue("pia", {0.66, 0.40, 0.36, 1});
  tissue("insula", {0.60, 0.34, 0.30, 1});
  registry.add_material({"dura", "solid", {0.66, 0.48, 0.42, 1}, 0.5, 0, 0});
  registry.add_material({"skin", "solid", {0.75, 0.54, 0.42, 1}, 0.6, 0, 0});
  registry.add_material({"bone", "solid", {0.73, 0.65, 0.52, 1}, 0.6, 0, 0});
  registry.add_material({"drape", "solid", {0.12, 0.30, 0.34, 1}, 0.95, 0, 0});
  registry.add_material({"steel", "solid", {0.70, 0.70, 0.72, 1}, 0.3, 1, 0});
  registry.add_material({"polymer", "solid", {0.80, 0.80, 0.78, 1}, 0.5, 0, 0});
}

}  // namespace

void register_core(Registry& registry) {
  add_materials(registry);
  register_scene(registry);
  registry.add<SoftBody>("soft_body", Kind::body, "a deformable body on a tetrahedral mesh");
  registry.add<ShellBody>("shell_body", Kind::body, "a thin-walled body on a triangle surface, such as an artery");
  registry.add<Obstacle>("obstacle", Kind::body, "something that never moves");
  registry.add<Surface>("surface", Kind::surface, "a surface that follows its body, for contact and for the picture");
  registry.add<SolverSettings>("solver", Kind::settings, "limits of the constraint solver");
  registry.add<SettleSettings>("settle", Kind::settings, "lets the scene come to rest before the exercise begins");
  registry.add<DeviceSettings>("devices", Kind::settings,
                               "what the hands hold where the command line does not say; see insula devices");
  registry.add<ViewSettings>("view", Kind::settings, "where the microscope stands at the start");
  registry.add<Exercise>("exercise", Kind::exercise, "goals, faults and motions of a training exercise");
  registry.add<Complications>("complications", Kind::complications,
                              "what may go wrong by chance, drawn from a seed that the report states");
  registry.add<Complication>("complication", Kind::complication,
                             "a command that comes by chance, at a time drawn between two");
  registry.add<MaterialElement>("material", Kind::material, "the look of surfaces and drawables by name");
  registry.add<MotionEntry>("motion", Kind::motion, "a scripted motion of both hands");
}

}  // namespace insula
