// SPDX-License-Identifier: GPL-3.0-or-later
// A bound on the messages about one file.
#pragma once
#include "core/base/diagnostic.h"

namespace insula {

/// The first hundred messages in order of position, and the number of others. Errors have priority over warnings.
Diagnostics first_diagnostics(Diagnostics all);

}  // namespace insula
