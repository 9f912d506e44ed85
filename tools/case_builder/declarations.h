// SPDX-License-Identifier: GPL-3.0-or-later
// The declarations of all components, against which an author's values are checked.
#pragma once
#include "core/registry/registry.h"

namespace insula::case_builder {

/// The built-in components. Made when it is first asked for.
const Registry& builtin_registry();

}  // namespace insula::case_builder
