// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of the store share.
#pragma once
#include <functional>
#include <string>

#include "core/base/input_error.h"
#include "core/testing/temp_folder.h"
#include "training/store/store.h"

namespace insula::training {

/// A finished run of practice with two metrics.
inline Run run_for_test(const std::string& person, const std::string& scene, std::int64_t began_ms) {
  Run r;
  r.uuid = new_uuid(), r.person = person, r.scene = scene, r.title = "Title of " + scene, r.mode = "practice";
  r.began_ms = began_ms, r.duration_s = 30, r.state = "done", r.goals = 2, r.goals_done = 2;
  r.metrics = {{"path_length", "left", 70.5, "Path", "mm", "low", 1}, {"time", "both", 30, "Time", "s", "low", 1}};
  return r;
}

/// Of the InputError that `f` throws; empty: it throws none.
inline std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

}  // namespace insula::training
