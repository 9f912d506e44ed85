// SPDX-License-Identifier: GPL-3.0-or-later
// Which contacts of a step a frame carries. A message has room for some only, and a contact of a hand is always to be
// seen and heard.
#pragma once
#include <vector>

#include "core/sim/report.h"

namespace insula {

/// Largest number of contacts of a frame, so that frames stay small.
inline constexpr std::size_t most_shown_contacts = 120;

/// Indices of the shown contacts: first those between a hand's tool, with what it holds, and something else; then the
/// strongest; of equals the first one of the step.
std::vector<std::size_t> shown_contacts(const std::vector<ContactPoint>& contacts,
                                        std::size_t most = most_shown_contacts);

}  // namespace insula
