// SPDX-License-Identifier: GPL-3.0-or-later
// The direct solver on an OpenCL device, for a GPU of any maker. Without an OpenCL library, or built without its
// headers, there are no devices and the rest of the solver is as it is. docs/gpu.md says how it is used.
//
// Its results have the accuracy of MultifrontalCholesky<double>, with other bits. One device with one driver gives the
// same bits each time.
#pragma once
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/linalg/body_solver.h"

namespace insula {

/// No device can be used. The text says what is missing.
struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Names of the devices with double precision, with platform and driver; the one that is used comes first. Empty
/// without OpenCL. INSULA_OPENCL_DEVICE in the environment restricts them to names that contain its text.
std::vector<std::string> opencl_devices();

/// On the first device. Throws NoDevice. A device that fails later is replaced by the processor, with a message.
std::unique_ptr<BodySolver> make_opencl_solver();

/// Time of a step's work, s: factor, free motion, compliance of rows and end of the motion.
struct SolverTrial {
  double processor_s = 0, device_s = 0;
  /// A device must save a fifth, so that chance does not choose.
  bool device_is_faster() const { return device_s > 0 && device_s < 0.8 * processor_s; }
};
/// Measures both on a matrix of this pattern with numbers of its own, and on 96 rows. Does nothing without a device.
SolverTrial try_solvers(const BlockMatrix& pattern);
/// The faster one of both on this machine, now. Nothing is remembered from one call to the next.
std::unique_ptr<BodySolver> make_faster_solver(const BlockMatrix& pattern);

/// Name of the device that the solver was made for, also after its failure. Empty: the processor.
std::string device_of(const BodySolver& solver);
/// Whether the solver has lost its device.
bool device_lost(const BodySolver& solver);

}  // namespace insula
