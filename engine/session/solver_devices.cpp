// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/solver_devices.h"

#include "core/linalg/opencl_solver.h"
#include "core/mechanics/deformable_body.h"

namespace insula::session {
namespace {

const std::string prefix = "solver.";
const std::string processor = "processor";

}  // namespace

void describe_solvers(const Simulation& simulation, mcap::Text& about) {
  for (DeformableBody* b : simulation.scene().all<DeformableBody>()) {
    if (!b->solver_kind.is("opencl") && !b->solver_kind.is("faster")) continue;
    const std::string device = device_of(*b->solver());
    about[prefix + b->id] = device.empty() ? processor : device;
  }
}

RepeatedSolvers repeat_solvers(const mcap::Text& about) {
  RepeatedSolvers out;
  std::vector<std::string> devices;
  bool asked = false;
  for (const auto& [key, device] : about) {
    if (!key.starts_with(prefix)) continue;
    const std::string id = key.substr(prefix.size());
    if (device != processor && !asked) {
      devices = opencl_devices();
      asked = true;
    }
    const bool here = device != processor && !devices.empty() && devices.front() == device;
    if (device != processor && !here) out.missing.push_back(id + ": " + device);
    out.edits.push_back({id, "solver", here ? "opencl" : "direct", {"recording", 0, 0}});
  }
  return out;
}

}  // namespace insula::session
