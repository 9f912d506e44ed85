// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics and faults by name of runs, in their tables.
#pragma once
#include <functional>
#include <string_view>
#include <vector>

#include "training/store/database.h"
#include "training/store/records.h"

namespace insula::training {

/// Writes those of a run whose row has the number `id`. Values that are not finite are left out.
void insert_details(const Database& database, const Run& run, std::int64_t id);

/// Reads those of all runs for which the condition `which` of SQL holds, with two queries. Runs that are not in the
/// list are passed over. bind: gives the condition its parameters.
void read_details(const Database& database, std::vector<Run>& runs, std::string_view which,
                  const std::function<void(Statement&)>& bind);

}  // namespace insula::training
