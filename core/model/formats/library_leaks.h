// SPDX-License-Identifier: GPL-3.0-or-later
// Tells the leak check of the address sanitizer to leave out what a library allocates and loses itself.
#pragma once

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace insula {

/// Memory that this thread allocates in its lifetime is not reported as a leak. assimp 5.2 loses one aiMesh for each
/// file that it refuses half-way.
struct LibraryLeaks {
#ifdef __SANITIZE_ADDRESS__
  __lsan::ScopedDisabler disabler;
#else
  LibraryLeaks() {}
#endif
};

}  // namespace insula
