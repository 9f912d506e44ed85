// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/declarations.h"

namespace insula::case_builder {

const Registry& builtin_registry() {
  static const Registry all = [] {
    Registry r;
    register_builtin(r);
    return r;
  }();
  return all;
}

}  // namespace insula::case_builder
