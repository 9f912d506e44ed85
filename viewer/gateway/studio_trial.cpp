// SPDX-License-Identifier: GPL-3.0-or-later
// A clip that is tried over the neck of a built case, by `insula_case clip`.
#include "core/base/input_error.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/studio.h"
#include "viewer/gateway/studio_choices.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr auto trial_limit = std::chrono::minutes(10);
constexpr const char* found_file = "clip.json";

}  // namespace

ApiAnswer Studio::try_clip(StudioProject& p) {
  const fs::path built = case_folder(p);
  if (built.empty()) return refusal(409, "the case must be built first");
  if (jobs_.count(p.name)) return refusal(409, at_work);
  std::vector<std::string> command{(places_.programs / "insula_case").string(), "clip", built.string(), "--out",
                                   (projects_.folder(p.name) / "clip.part").string()};
  const std::vector<std::string> more = clip_words(p.choices());
  command.insert(command.end(), more.begin(), more.end());
  p.work["trial"] = {{"state", "running"}, {"error", ""}, {"words", more}, {"built", p.work["built"]["folder"]}};
  projects_.write(p);
  jobs_[p.name] = std::make_unique<StudioJob>(StudioJob::Kind::trial, command, trial_limit);
  return shown(p);
}

void Studio::trial_ended(StudioProject& p, const StudioJob& job) {
  const fs::path folder = projects_.folder(p.name);
  std::error_code error;
  if (job.succeeded()) fs::rename(folder / "clip.part", folder / found_file, error);
  Json& work = p.work["trial"];
  work["state"] = error || !job.succeeded() ? (job.cancelled() ? "cancelled" : "failed") : "done";
  work["error"] = error ? project_not_written : job.error();
  projects_.write(p);
}

void Studio::add_trial(const StudioProject& p, Json& trial) const {
  if (text_of(trial, "state") != "done") return;
  trial["found"] = read_json(projects_.folder(p.name) / found_file);
  trial["current"] = trial["words"] == Json(clip_words(p.choices())) && p.work.contains("built") &&
                     trial["built"] == p.work["built"]["folder"];
}

}  // namespace insula::gateway
