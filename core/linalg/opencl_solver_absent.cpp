// SPDX-License-Identifier: GPL-3.0-or-later
// In a build without the headers of OpenCL there is no device.
#include "core/linalg/direct_solver.h"
#include "core/linalg/opencl_solver.h"

namespace insula {

std::vector<std::string> opencl_devices() { return {}; }
std::unique_ptr<BodySolver> make_opencl_solver() { throw NoDevice("this build has no OpenCL"); }
SolverTrial try_solvers(const BlockMatrix&) { return {}; }
std::unique_ptr<BodySolver> make_faster_solver(const BlockMatrix&) { return make_direct_solver(false); }
std::string device_of(const BodySolver&) { return {}; }
bool device_lost(const BodySolver&) { return false; }

}  // namespace insula
