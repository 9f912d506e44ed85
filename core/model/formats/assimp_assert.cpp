// SPDX-License-Identifier: GPL-3.0-or-later
// Debian builds assimp with its assertions on, and they abort the program on malformed files. This definition stands in
// for the library's own (its calls go through the dynamic symbol table), so that they become an error of the reader.
#include <stdexcept>
#include <string>

#include "core/model/formats/assimp_assert.h"

namespace Assimp {

void aiAssertViolation(const char* expression, const char*, int) {
  throw std::runtime_error(std::string("malformed (") + expression + ")");
}

}  // namespace Assimp
