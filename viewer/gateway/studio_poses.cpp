// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_poses.h"

#include <charconv>
#include <cmath>

#include "viewer/gateway/studio_choices.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr std::string_view refusal_begins = "error: ";
constexpr double farthest_pose = 1e4;  // mm, degrees

}  // namespace

StudioPoses::StudioPoses(fs::path program, Clock::duration idle) : program_(std::move(program)), idle_(idle) {}

void StudioPoses::begin(const fs::path& built, const fs::path& surfaces) {
  child_ = ChildProcess();
  built_ = built;
  next_.reset();
  busy_ = false;
  facts_ = answer_ = Json();
  error_ =
      child_.start({program_.string(), "pose", built.string(), "--out", surfaces.string()}, ChildProcess::Input::pipe);
}

void StudioPoses::hear(std::string_view line) {
  if (line.starts_with(refusal_begins)) error_ = line.substr(refusal_begins.size());
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return;
  if (facts_.is_null()) facts_ = std::move(json);
  else answer_ = std::move(json), busy_ = false;
}

void StudioPoses::tell_next() {
  if (busy_ || !next_ || facts_.is_null() || !child_.running()) return;
  busy_ = child_.write((next_->parted ? "part " : "") + pose_words(Json(next_->pose)) + "\n");
  if (busy_) next_.reset();
}

void StudioPoses::look() {
  const auto heard = [this](std::string_view line) { hear(line); };
  if (!child_.running()) return;
  child_.read_lines(heard);
  if (Clock::now() - asked_at_ > idle_) {
    child_ = ChildProcess();
    built_.clear();
    return;
  }
  if (const auto exit = child_.reap()) {
    child_.finish_output(heard);
    if (error_.empty()) error_ = "the case builder " + exit->text();
    return;
  }
  tell_next();
}

Json StudioPoses::ask(const fs::path& built, const fs::path& surfaces, const std::optional<Question>& question) {
  asked_at_ = Clock::now();
  if (built != built_) begin(built, surfaces);
  if (question) next_ = question;
  look();
  const bool failed = !child_.running();
  Json out = {{"state", failed             ? "failed"
                        : facts_.is_null() ? "starting"
                                           : "ready"},
              {"error", error_},
              {"busy", busy_ || next_.has_value()},
              {"facts", facts_},
              {"answer", answer_}};
  if (failed) built_.clear();  // the next question begins anew
  return out;
}

std::optional<StudioPoses::Pose> pose_of(const std::string& text) {
  StudioPoses::Pose out{};
  const char *at = text.data(), *const end = at + text.size();
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (k > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [next, code] = std::from_chars(at, end, out[k]);
    if (code != std::errc() || !(std::abs(out[k]) < farthest_pose)) return std::nullopt;
    at = next;
  }
  return at == end ? std::optional(out) : std::nullopt;
}

}  // namespace insula::gateway
