// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_projects.h"

#include <algorithm>
#include <chrono>

#include "core/base/case_name.h"
#include "core/base/input_error.h"
#include "core/base/text.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/replace_file.h"
#include "viewer/gateway/studio_choices.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr const char* description = "project.json";
constexpr int format = 1;
constexpr std::size_t most_history = 200;
constexpr std::size_t longest_name = 48;  // leaves room for a number

std::int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string StudioProjects::name_for(const std::string& file) {
  std::string out = file.substr(file.find_last_of("/\\") + 1);
  out = out.substr(0, std::min(out.find('.'), longest_name));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return !is_case_letter(c); }, '_');
  return out.find_first_not_of('_') == std::string::npos ? "case" : out;
}

std::vector<std::string> StudioProjects::names() const {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator it(root_, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (is_case_name(name) && fs::is_regular_file(it->path() / description, error)) out.push_back(name);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<StudioProject> StudioProjects::read(const std::string& name) const {
  if (!is_case_name(name)) return std::nullopt;
  const Json json = read_json(folder(name) / description);
  if (!json.is_object() || json.value("format", 0) != format) return std::nullopt;
  StudioProject out{name, text_of(json, "file"), text_of(json, "input"), {}, 0, 0, Json::object()};
  if (json.contains("work") && json["work"].is_object()) out.work = json["work"];
  try {
    for (const Json& choices : json.at("history")) out.history.push_back(changed_choices(first_choices(), choices));
    out.at = json.at("at").get<std::size_t>();
    out.revision = json.value("revision", std::int64_t(0));
  } catch (const std::exception&) {
    return std::nullopt;
  }
  if (out.at >= out.history.size()) return std::nullopt;
  return out;
}

void StudioProjects::write(const StudioProject& p) const {
  const Json json{{"format", format},       {"what", "A project of Insula's case builder. For training only."},
                  {"file", p.file},         {"input", p.input},
                  {"history", p.history},   {"at", p.at},
                  {"revision", p.revision}, {"work", p.work}};
  if (!replace_file(folder(p.name) / description, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"))
    throw InputError(project_not_written);
}

StudioProject StudioProjects::create(const std::string& file, const std::string& input, const fs::path& content) const {
  const std::string wanted = name_for(file);
  std::error_code error;
  fs::create_directories(root_, error);
  std::string name = wanted;
  for (int k = 2; !fs::create_directory(folder(name), error); ++k) {
    if (error || k > 999) throw InputError("no folder can be made for the project");
    name = wanted + "_" + std::to_string(k);
  }
  StudioProject out{name, shown(file), input, {first_choices()}, 0, now_ms(), Json::object()};
  try {
    fs::create_directories((folder(name) / out.input).parent_path(), error);
    fs::rename(content, folder(name) / out.input, error);
    if (error) throw InputError("the file cannot be kept: is the disk full?");
    write(out);
  } catch (const InputError&) {
    fs::remove_all(folder(name), error);
    throw;
  }
  return out;
}

void StudioProjects::remove(const std::string& name) const {
  std::error_code ignored;
  if (is_case_name(name)) fs::remove_all(folder(name), ignored);
}

void choose(StudioProject& p, Json choices) {
  if (choices == p.choices()) return;
  p.history.resize(p.at + 1);
  p.history.push_back(std::move(choices));
  if (p.history.size() > most_history) p.history.erase(p.history.begin());
  p.at = p.history.size() - 1;
  ++p.revision;
}

void undo(StudioProject& p) {
  if (p.at == 0) return;
  --p.at, ++p.revision;
}

void redo(StudioProject& p) {
  if (p.at + 1 >= p.history.size()) return;
  ++p.at, ++p.revision;
}

}  // namespace insula::gateway
