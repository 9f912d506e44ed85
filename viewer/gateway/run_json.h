// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of the training store as pages get them.
#pragma once
#include <nlohmann/json.hpp>

#include "training/store/records.h"

namespace insula::gateway {

/// Without metrics and faults by name. Recordings are named without their folder (sessions.h).
nlohmann::ordered_json run_json(const training::Run& run);
/// With them.
nlohmann::ordered_json full_run_json(const training::Run& run);

}  // namespace insula::gateway
