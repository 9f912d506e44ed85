// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_scenes.h"

#include <algorithm>
#include <charconv>

#include "core/base/case_name.h"
#include "core/base/input_error.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/studio_projects.h"
#include "viewer/gateway/training_api.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr auto short_question = std::chrono::seconds(60), long_question = std::chrono::seconds(300);
constexpr const char* no_scene = "there is no such scene";
constexpr const char* no_file = "there is no such file in this scene";
constexpr const char* scene_too_large = "this scene is too large: 200 kB are taken";

std::string player_key(const std::string& name) { return "scene " + name; }

/// A text with files named as in the copy.
std::string named_as_copied(std::string text, const fs::path& folder) {
  const std::string before = folder.string() + "/";
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before))
    text.erase(at, before.size());
  return text;
}

/// The problems as `insula check --json` tells them.
Json problems_as_copied(Json problems, const fs::path& folder) {
  for (Json& problem : problems)
    for (const char* part : {"file", "text"}) problem[part] = named_as_copied(text_of(problem, part), folder);
  return problems;
}

}  // namespace

StudioScenes::StudioScenes(fs::path data, fs::path program, StudioPlayer& player)
    : data_(std::move(data)), program_(std::move(program)), files_(data_ / "scenes"), player_(player) {}

/// Asks again if the answer is older than `valid`.
ApiAnswer StudioScenes::asked(std::unique_ptr<StudioQuestion>& question, const std::vector<std::string>& words,
                              const char* what, std::chrono::seconds valid) {
  if (!question || (question->ended() && (!question->succeeded() || question->age() > valid))) {
    std::vector<std::string> command{program_.string()};
    command.insert(command.end(), words.begin(), words.end());
    const std::string error = question ? question->error() : std::string();
    question = std::make_unique<StudioQuestion>(command, short_question);
    if (!error.empty()) return answer_with(Json{{"state", "failed"}, {"error", error}});
  }
  if (!question->look()) return answer_with(Json{{"state", "running"}, {"error", ""}});
  Json answer = question->answer();
  if (!question->succeeded() || answer.is_discarded())
    return answer_with(Json{{"state", "failed"}, {"error", question->error()}});
  return answer_with(Json{
      {"state", "done"}, {"error", ""}, {what, answer.is_object() && answer.contains(what) ? answer[what] : answer}});
}

Json StudioScenes::sources() const { return sources_ && sources_->succeeded() ? sources_->answer() : Json::array(); }

ApiAnswer StudioScenes::list() const {
  Json out = Json::array();
  for (const std::string& name : files_.names())
    if (!copies_.count(name)) out.push_back({{"name", name}, {"state", "ready"}, {"error", ""}});
  for (const auto& [name, copy] : copies_)
    out.push_back({{"name", name}, {"state", copy->ended() ? "failed" : "copying"}, {"error", copy->error()}});
  return answer_with(Json{{"scenes", out}, {"most_bytes", most_text_bytes}});
}

ApiAnswer StudioScenes::shown(const std::string& name) const {
  const auto copy = copies_.find(name);
  if (copy != copies_.end())
    return answer_with(Json{
        {"name", name}, {"state", copy->second->ended() ? "failed" : "copying"}, {"error", copy->second->error()}});
  if (!files_.has(name)) return refusal(404, no_scene);
  Json look = player_.state(player_key(name));
  if (look.is_object()) look["error"] = named_as_copied(text_of(look, "error"), files_.folder(name));
  return answer_with(Json{{"name", name},
                          {"state", "ready"},
                          {"error", ""},
                          {"scenes", files_.scenes(name)},
                          {"files", files_.files(name)},
                          {"meshes", files_.meshes(name)},
                          {"look", look}});
}

ApiAnswer StudioScenes::file(const std::string& name, std::string_view query) const {
  const std::string file = query_value(query, "file"), wanted = query_value(query, "number");
  if (!wanted.empty()) {
    int number = 0;
    std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    const auto text = files_.version(name, file, number);
    return text ? answer_with(Json{{"text", *text}}) : refusal(404, "there is no such version");
  }
  const auto text = files_.read(name, file);
  if (!text) return refusal(404, no_file);
  return answer_with(Json{{"text", text->text},
                          {"draft", text->draft ? Json(*text->draft) : Json()},
                          {"versions", text->versions},
                          {"revision", text->revision()}});
}

ApiAnswer StudioScenes::checked(const std::string& name, const std::string& file) const {
  const auto it = checks_.find({name, file});
  if (it == checks_.end()) return answer_with(Json{{"state", ""}, {"number", 0}, {"error", ""}});
  const auto& [number, folder, question] = it->second;
  if (!question->ended()) return answer_with(Json{{"state", "running"}, {"number", number}, {"error", ""}});
  Json answer = question->answer();  // a scene with errors gives one too
  if (!answer.is_object() || !answer.contains("problems"))
    return answer_with(Json{{"state", "failed"}, {"number", number}, {"error", question->error()}});
  return answer_with(Json{{"state", "done"},
                          {"number", number},
                          {"error", ""},
                          {"ok", answer.value("ok", false)},
                          {"problems", problems_as_copied(answer["problems"], folder)}});
}

ApiAnswer StudioScenes::open(const fs::path& from, const std::string& file) {
  const std::string wanted = StudioProjects::name_for(file);
  std::string name = wanted;
  std::error_code error;
  for (int k = 2; copies_.count(name) || fs::exists(files_.folder(name), error); ++k)
    name = wanted + "_" + std::to_string(k);
  copies_[name] = std::make_unique<StudioQuestion>(
      std::vector<std::string>{program_.string(), "cases", "copy", from.string(), files_.folder(name).string()},
      long_question);
  return shown(name);
}

ApiAnswer StudioScenes::begin(const std::string& name) {
  if (!is_case_name(name)) return refusal(400, "a name has letters, digits, _ and - only, 64 at most");
  std::error_code error;
  if (copies_.count(name) || fs::exists(files_.folder(name), error))
    return refusal(409, "there is a scene of this name already");
  copies_[name] = std::make_unique<StudioQuestion>(
      std::vector<std::string>{program_.string(), "cases", "new", files_.folder(name).string()}, short_question);
  return shown(name);
}

/// Only a scene of the list may be copied, so that no page can name a file of this machine.
ApiAnswer StudioScenes::open_source(const std::string& source) {
  for (const Json& known : sources())
    if (text_of(known, "scene") == source) return open(source, fs::path(source).filename().string());
  return refusal(404, no_scene);
}

ApiAnswer StudioScenes::edit(std::string_view path, const std::string& name, const Json& body) {
  const std::string file = text_of(body, "file"), text = text_of(body, "text"), seen = text_of(body, "revision");
  if (text.size() > most_text_bytes) return refusal(413, scene_too_large);
  const auto before = files_.read(name, file);
  if (!before) return refusal(404, no_file);
  if (seen.empty()) return refusal(428, "the revision of the file is missing");
  if (seen != before->revision()) return refusal(412, "this file was changed in another window");
  return path == "scene_check" ? check(name, file, before->text, body) : write(name, file, text);
}

/// before: the file's text on disk.
ApiAnswer StudioScenes::check(const std::string& name, const std::string& file, const std::string& before,
                              const Json& body) {
  const std::string text = text_of(body, "text"), scene = text_of(body, "scene");
  const std::vector<std::string> scenes = files_.scenes(name);
  if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) return refusal(404, no_scene);
  checks_.erase({name, file});  // its program ends with it
  const auto folder = files_.for_check(name, file, text);
  if (!folder) return refusal(404, no_file);
  if (before != text) files_.keep_draft(name, file, text);
  Check& now = checks_[{name, file}];
  now = {
      ++check_number_, *folder,
      std::make_unique<StudioQuestion>(
          std::vector<std::string>{program_.string(), "check", "--json", (*folder / scene).string()}, short_question)};
  return answer_with(Json{{"number", now.number}, {"revision", files_.read(name, file)->revision()}});
}

ApiAnswer StudioScenes::write(const std::string& name, const std::string& file, const std::string& text) {
  if (!files_.write(name, file, text)) return refusal(404, no_file);
  const auto now = files_.read(name, file);
  return answer_with(Json{{"versions", now->versions}, {"revision", now->revision()}});
}

ApiAnswer StudioScenes::act(std::string_view path, const std::string& name, const Json& body) {
  if (path == "scene_check" || path == "scene_write") return edit(path, name, body);
  if (path == "scene_look") {
    const std::string scene = text_of(body, "scene");
    const std::vector<std::string> scenes = files_.scenes(name);
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) return refusal(404, no_scene);
    player_.look_at(player_key(name), files_.folder(name) / scene);
    return shown(name);
  }
  if (path == "scene_leave" || path == "scene_remove") player_.end(player_key(name));
  if (path == "scene_leave") return shown(name);
  if (path != "scene_remove") return refusal(404, "not found");
  std::erase_if(checks_, [&](const auto& check) { return check.first.first == name; });
  files_.remove(name);
  return {200, "{}\n"};
}

ApiAnswer StudioScenes::get(std::string_view path, std::string_view query) {
  const std::string name = query_value(query, "name");
  try {
    if (path == "scenes") return list();
    if (path == "scene_sources")
      return asked(sources_, {"list", "--scenes", "--data", data_.string()}, "sources", std::chrono::seconds(5));
    if (path == "scene_elements") return asked(elements_, {"list", "--json"}, "elements", std::chrono::hours(24));
    if (path == "scene") return shown(name);
    if (path == "scene_file" || path == "scene_version") return file(name, query);
    if (path == "scene_checked") return checked(name, query_value(query, "file"));
  } catch (const InputError& e) {
    return refusal(500, e.what());
  }
  return refusal(404, "not found");
}

ApiAnswer StudioScenes::post(std::string_view path, const Json& body) {
  const std::string name = text_of(body, "name");
  try {
    if (path == "scene_open") return open_source(text_of(body, "source"));
    if (path == "scene_new") return begin(name);
    if (path == "scene_remove" && copies_.count(name) && copies_[name]->ended()) {
      copies_.erase(name);
      return {200, "{}\n"};
    }
    return files_.has(name) && !copies_.count(name) ? act(path, name, body) : refusal(404, no_scene);
  } catch (const InputError& e) {
    return refusal(507, e.what());
  }
}

void StudioScenes::look() {
  for (auto it = copies_.begin(); it != copies_.end();)
    if (it->second->look() && it->second->succeeded()) it = copies_.erase(it);
    else ++it;
  for (auto& [of, check] : checks_) check.asked->look();
  for (auto* question : {&sources_, &elements_})
    if (*question) (*question)->look();
}

}  // namespace insula::gateway
