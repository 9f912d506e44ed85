// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/sessions.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace fs = std::filesystem;

#include "viewer/gateway/replace_file.h"

namespace insula::gateway {
namespace {

constexpr std::string_view extension = ".insula";

fs::path notes_file(const fs::path& recording) { return recording.string() + ".notes.json"; }

/// Whether it is a list of {"time_s": number, "text": string}.
bool are_notes(const nlohmann::json& notes) {
  return notes.is_array() && std::all_of(notes.begin(), notes.end(), [](const nlohmann::json& n) {
           return n.is_object() && n.contains("time_s") && n["time_s"].is_number() && n.contains("text") &&
                  n["text"].is_string();
         });
}

}  // namespace

Sessions::Sessions(fs::path folder, const std::vector<fs::path>& files) : folder_(std::move(folder)) {
  for (const fs::path& file : files) {
    std::string name = file.stem().string();
    for (int n = 2; files_.contains(name); ++n) name = file.stem().string() + "_" + std::to_string(n);
    files_[name] = file;
    given_.push_back(name);
  }
}

std::map<std::string, fs::path> Sessions::all() const {
  std::map<std::string, fs::path> out = files_;
  std::error_code error;
  if (folder_.empty()) return out;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (it->path().extension() == extension && it->is_regular_file(ignored))
      out.try_emplace(it->path().stem().string(), it->path());
  }
  return out;
}

std::string Sessions::list() const {
  struct Entry {
    std::string name;
    fs::file_time_type changed;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  for (const auto& [name, file] : all()) {
    std::error_code error;
    const auto bytes = fs::file_size(file, error);
    const auto changed = error ? fs::file_time_type() : fs::last_write_time(file, error);
    if (!error) entries.push_back({name, changed, bytes});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.changed > b.changed; });
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Entry& e : entries) out.push_back({{"name", e.name}, {"bytes", e.bytes}});
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::optional<fs::path> Sessions::find(const std::string& name) const {
  const auto files = all();
  const auto found = files.find(name);
  return found == files.end() ? std::nullopt : std::optional(found->second);
}

std::string Sessions::notes(const fs::path& recording) {
  std::ifstream in(notes_file(recording), std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return are_notes(nlohmann::json::parse(text, nullptr, false)) ? text : "[]\n";
}

std::string Sessions::store_notes(const fs::path& recording, std::string_view json) {
  if (json.size() > most_notes_bytes || !are_notes(nlohmann::json::parse(json, nullptr, false)))
    return "notes are a list of {\"time_s\": number, \"text\": string}";
  const fs::path file = notes_file(recording);
  return replace_file(file, json) ? "" : file.string() + " cannot be written";
}

}  // namespace insula::gateway
