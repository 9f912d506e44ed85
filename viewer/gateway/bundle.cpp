// SPDX-License-Identifier: GPL-3.0-or-later
// Files of the scene bundle.
#include "viewer/gateway/bundle.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "viewer/gateway/static_files.h"

namespace fs = std::filesystem;

namespace insula::gateway {
namespace {

void collect_files(const nlohmann::json& json, std::set<std::string>& out, int depth = 0) {
  if (depth > 16) return;
  if (json.is_string()) {
    const auto& text = json.get_ref<const std::string&>();
    if (text.size() < 256 && (text.ends_with(".bin") || text.ends_with(".svg") || text.ends_with(".json")))
      out.insert(text);
  } else if (json.is_structured()) {
    for (const auto& item : json) collect_files(item, out, depth + 1);
  }
}

}  // namespace

void Bundle::set(std::int64_t session, const std::string& folder) {
  if (session == session_ && folder == folder_) return;
  session_ = session;
  folder_ = folder;
  read_at_ = {};
  listed_.clear();
}

void Bundle::refresh() {
  std::error_code error;
  const fs::path file = folder_ / "scene.json";
  const auto changed = fs::last_write_time(file, error);
  if (error) {
    listed_.clear();
    return;
  }
  if (changed == read_at_ && !listed_.empty()) return;
  listed_.clear();
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("bodies")) return;  // also: half written
  listed_.insert("scene.json");
  collect_files(json, listed_);
  read_at_ = changed;
}

std::optional<fs::path> Bundle::find(const std::string& session, const std::vector<std::string>& parts) {
  if (folder_.empty() || session != std::to_string(session_) || parts.empty()) return std::nullopt;
  refresh();
  std::string name = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) name += '/' + parts[i];
  if (!listed_.contains(name)) return std::nullopt;
  return file_below(folder_, parts);
}

}  // namespace insula::gateway
