// SPDX-License-Identifier: GPL-3.0-or-later
// What a person has done, as curricula count it.
#pragma once
#include <string>
#include <vector>

#include "training/curriculum/attempt.h"
#include "training/store/store.h"

namespace insula {

Attempt attempt_of(const training::Run& run);
/// Of all runs of a person.
std::vector<Attempt> attempts_of(const training::Store& store, const std::string& person);

}  // namespace insula
