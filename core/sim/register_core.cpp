// SPDX-License-Identifier: GPL-3.0-or-later
// The elements that are not plugins.
#include "core/mechanics/obstacle.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"
#include "core/scene/scene.h"
#include "core/sim/complications.h"
#include "core/sim/exercise.h"
#include "core/sim/settings.h"

namespace insula {

void register_core(Registry& registry) {
  register_scene(registry);
  registry.add<SoftBody>("soft_body", Kind::body, "a deformable body on a tetrahedral mesh");
  registry.add<ShellBody>("shell_body", Kind::body, "a thin-walled body on a triangle surface, such as an artery");
  registry.add<Obstacle>("obstacle", Kind::body, "something that never moves");
  registry.add<Surface>("surface", Kind::surface, "a surface that follows its body, for contact and for the picture");
  registry.add<SolverSettings>("solver", Kind::settings, "limits of the constraint solver");
  registry.add<SettleSettings>("settle", Kind::settings, "lets the scene come to rest before the exercise begins");
  registry.add<DeviceSettings>("devices", Kind::settings, "what the hands hold where the command line does not say; see insula devices");
  registry.add<ViewSettings>("view", Kind::settings, "where the microscope stands at the start");
  registry.add<Exercise>("exercise", Kind::exercise, "goals, faults and motions of a training exercise");
  registry.add<Complications>("complications", Kind::complications, "what may go wrong by chance, drawn from a seed that the report states");
  registry.add<Complication>("complication", Kind::complication, "a command that comes by chance, at a time drawn between two");
  registry.add<MotionEntry>("motion", Kind::motion, "a scripted motion of both hands");
}

}  // namespace insula
