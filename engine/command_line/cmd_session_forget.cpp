// SPDX-License-Identifier: GPL-3.0-or-later
// insula session forget: removes the recordings and reports of a person.
#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/xml/document.h"
#include "engine/command_line/sessions.h"
#include "engine/session/session_format.h"
#include "engine/session/session_reader.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most_report_bytes = 64u << 20;

/// The person of a session file, or of a folder with a report; empty: none.
std::string person_of(const fs::path& path) {
  try {
    if (path.extension() == session::extension) return SessionReader(path).field("person");
    std::string text;
    if (!read_text_file((path / "report.json").string(), most_report_bytes, text).empty()) return {};
    const auto json = nlohmann::json::parse(text, nullptr, false);
    return json.is_object() && json.contains("fields") ? json["fields"].value("person", "") : "";
  } catch (const std::exception&) {
    return {};  // no session and no report
  }
}

std::vector<fs::path> all_of(const std::string& person, const std::vector<fs::path>& folders) {
  std::vector<fs::path> out;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const bool session = entry.is_regular_file() && entry.path().extension() == session::extension;
      const bool report = entry.is_directory() && fs::exists(entry.path() / "report.json");
      if ((session || report) && person_of(entry.path()) == person) out.push_back(entry.path());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

int cmd_session_forget(const CommandContext& context, const ForgetOptions& options) {
  int status = 0;
  const std::vector<fs::path> found = all_of(options.person, options.folders);
  for (const fs::path& path : found) {
    std::error_code error;
    if (!options.list_only) fs::remove_all(path, error);
    // What somebody noted while watching it.
    if (!options.list_only && !error) fs::remove(path.string() + ".notes.json", error);
    if (error) {
      fmt::print(context.err, "error: {} cannot be removed: {}\n", path.string(), error.message());
      status = 1;
    } else {
      fmt::print(context.out, "{}{}\n", options.list_only ? "" : "removed ", path.string());
    }
  }
  if (found.empty()) fmt::print(context.out, "there is nothing of \"{}\"\n", options.person);
  return status;
}

}  // namespace insula
