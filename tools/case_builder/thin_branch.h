// SPDX-License-Identifier: GPL-3.0-or-later
// A branch that is too thin on its way for a centreline.
#pragma once
#include "tools/artery/surface.h"

namespace insula::case_builder {

/// Cuts the branch that ends in a cap off where it leaves its parent, and closes the wall there. Returns false, and
/// leaves the surface as it is, where no cut takes that cap alone.
bool remove_branch(artery::Surface& surface, std::size_t cap);

}  // namespace insula::case_builder
