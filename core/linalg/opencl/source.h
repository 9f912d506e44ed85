// SPDX-License-Identifier: GPL-3.0-or-later
// The text of the kernels, put into the program when it is built (cmake/core.cmake).
#pragma once

namespace insula::opencl {

/// front_record.h and the files *.cl of this folder.
const char* kernel_source();

}  // namespace insula::opencl
