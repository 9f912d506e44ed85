// SPDX-License-Identifier: GPL-3.0-or-later
// Branches that a clip at the neck would shut.
#pragma once
#include <string>
#include <vector>

#include "tools/artery/vessel.h"

namespace insula::artery {

/// The regions whose wall is joined with that of the parent by the sac alone: their blood passes the neck. Sorted;
/// empty without a sac.
std::vector<std::string> branches_of_sac(const Vessel& vessel);

}  // namespace insula::artery
