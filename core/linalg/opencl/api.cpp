// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/opencl/api.h"

#include <type_traits>

#include "core/base/dynamic_library.h"

namespace insula::opencl {
namespace {

/// False when a function is missing.
bool find_functions(const DynamicLibrary& library, Api& api) {
#define INSULA_FIND(name)                                                             \
  api.name = library.function<std::remove_pointer_t<decltype(api.name)>>("cl" #name); \
  if (api.name == nullptr) return false;
  INSULA_OPENCL_FUNCTIONS(INSULA_FIND)
#undef INSULA_FIND
  return true;
}

}  // namespace

const Api* api() {
  static Api functions;
  static const bool complete = [] {
    const DynamicLibrary library = DynamicLibrary::of_system("OpenCL", 1);
    return library.loaded() && find_functions(library, functions);
  }();
  return complete ? &functions : nullptr;
}

void check(cl_int status, const char* call) {
  if (status != CL_SUCCESS)
    throw DeviceFailure(std::string("the OpenCL call ") + call + " failed with status " + std::to_string(status));
}

}  // namespace insula::opencl
