// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of OpenCL 1.2 that the solver calls. The library is opened when they are first needed, so no program
// needs OpenCL to start.
#pragma once
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <stdexcept>
#include <string>

namespace insula::opencl {

/// A call of OpenCL failed. The text names the call and the status.
struct DeviceFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

#define INSULA_OPENCL_FUNCTIONS(use)                                                                                   \
  use(GetPlatformIDs) use(GetPlatformInfo) use(GetDeviceIDs) use(GetDeviceInfo) use(CreateContext) use(ReleaseContext) \
      use(CreateCommandQueue) use(ReleaseCommandQueue) use(CreateProgramWithSource) use(BuildProgram)                  \
          use(GetProgramBuildInfo) use(ReleaseProgram) use(CreateKernel) use(ReleaseKernel) use(SetKernelArg)          \
              use(CreateBuffer) use(ReleaseMemObject) use(EnqueueNDRangeKernel) use(EnqueueWriteBuffer)                \
                  use(EnqueueReadBuffer) use(EnqueueCopyBuffer) use(EnqueueFillBuffer) use(Flush) use(Finish)

struct Api {
#define INSULA_DECLARE(name) decltype(&::cl##name) name = nullptr;
  INSULA_OPENCL_FUNCTIONS(INSULA_DECLARE)
#undef INSULA_DECLARE
};

/// Null when the machine has no OpenCL library, or one that lacks a function.
const Api* api();
/// Throws DeviceFailure unless the status is CL_SUCCESS.
void check(cl_int status, const char* call);

}  // namespace insula::opencl
