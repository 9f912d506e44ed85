// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_scan.h"

#include <algorithm>
#include <fstream>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/replace_file.h"
#include "viewer/gateway/studio.h"
#include "viewer/gateway/studio_choices.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr auto scan_limit = std::chrono::minutes(10);
constexpr const char* uploaded = "upload";
constexpr const char* kept = "input.mha";

}  // namespace

UploadKind kind_of_upload(const fs::path& content) {
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(content, error);
  std::string head(std::min<std::uint64_t>(error ? 0 : bytes, scan_head_bytes), '\0');
  std::ifstream in(content, std::ios::binary);
  if (error || !in.read(head.data(), std::streamsize(head.size()))) throw InputError("the file cannot be read");
  const SurfaceKind scan = scan_kind(head);
  if (!scan.extension.empty() || !scan.refused.empty()) return {scan, true};
  if (bytes > Studio::most_upload_bytes)
    return {{"", "this file is too large: 220 MB are taken of a surface"}, false, 413};
  return {surface_kind(read_file_bytes(content)), false};
}

bool is_scan(const StudioProject& p) { return p.work.contains("scan"); }
bool scan_is_read(const StudioProject& p) { return is_scan(p) && text_of(p.work["scan"], "state") == "done"; }
bool has_level(const StudioProject& p) {
  return !p.choices()["threshold"].is_null() || !p.choices()["label"].is_null();
}

std::vector<std::string> with_strokes(std::vector<std::string> words, const StudioProject& p, const fs::path& folder) {
  const Json& strokes = p.choices()["paint"];
  if (strokes.empty()) return words;
  if (!replace_file(folder / paint_file, strokes.dump() + "\n")) throw InputError(project_not_written);
  std::replace(words.begin(), words.end(), std::string(paint_file), (folder / paint_file).string());
  return words;
}

fs::path scan_file(const fs::path& folder, const char* extension) {
  return folder / "scan" / (std::string("scan") + extension);
}

void Studio::read_scan(StudioProject& p) {
  const fs::path folder = projects_.folder(p.name);
  std::error_code ignored;
  fs::remove_all(folder / "scan.part", ignored);
  const std::vector<std::string> command{(places_.programs / "insula_case").string(), "inspect",
                                         (folder / p.input).string(), "--out", (folder / "scan.part").string()};
  p.work["scan"] = {{"state", "running"}, {"error", ""}};
  projects_.write(p);
  jobs_[p.name] = std::make_unique<StudioJob>(StudioJob::Kind::scan, command, scan_limit);
}

/// What was refused is of no more use. After a crash, the file is still there.
void Studio::scan_ended(StudioProject& p, const StudioJob& job) {
  const fs::path folder = projects_.folder(p.name);
  std::error_code error, ignored;
  if (job.succeeded()) {
    fs::remove_all(folder / "scan", ignored);
    fs::rename(folder / "scan.part" / "scan.mha", folder / kept, error);
    if (!error) fs::rename(folder / "scan.part", folder / "scan", error);
    if (!error) p.input = kept;
  }
  const bool done = job.succeeded() && !error;
  p.work["scan"] = {{"state", done              ? "done"
                              : job.cancelled() ? "cancelled"
                                                : "failed"},
                    {"error", error ? project_not_written : job.error()}};
  if (!done) fs::remove_all(folder / "scan.part", ignored);
  if (done) p.work["inspect"] = {{"state", "waiting"}, {"error", ""}, {"number", 0}};
  projects_.write(p);
  if (done || job.refused()) fs::remove_all(folder / uploaded, ignored);
}

}  // namespace insula::gateway
