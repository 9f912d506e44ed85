// SPDX-License-Identifier: GPL-3.0-or-later
// A checked curriculum, and a person's progress in it, as JSON. A program that knows the scenes loads and checks a
// curriculum; one that does not reads the result.
#pragma once
#include <nlohmann/json.hpp>

#include "training/curriculum/evaluate.h"

namespace insula::training {

/// The condition of a gate.
nlohmann::ordered_json gate_json(const Gate& gate);

/// All of a curriculum, so that curriculum_of() gives it back.
nlohmann::ordered_json curriculum_json(const Curriculum& curriculum);
/// Throws InputError if the JSON is not that of a curriculum.
Curriculum curriculum_of(const nlohmann::json& json);

/// What a person is shown: titles and texts of the curriculum with standings, gates and what is next. `start` is the
/// mode in which an attempt counts, "practice" or "test", and `why` is the key of a reason.
nlohmann::ordered_json progress_json(const Curriculum& curriculum, const Progress& progress);

/// The mode in which attempts count for a task. Practice shows the targets of the guide, so work without the guide is a
/// test too.
const char* mode_to_start(TaskMode mode, bool guide);

}  // namespace insula::training
