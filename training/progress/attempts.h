// SPDX-License-Identifier: GPL-3.0-or-later
// What a person has done, as curricula count it.
#pragma once
#include <string>
#include <vector>

#include "training/curriculum/attempt.h"
#include "training/store/store.h"

namespace insula::training {

/// project: folder from which the store names scenes; empty: the current one.
Attempt attempt_of(const Run& run, const std::filesystem::path& project);
/// Of all runs of a person.
std::vector<Attempt> attempts_of(const Store& store, const std::string& person, const std::filesystem::path& project);

}  // namespace insula::training
