// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio.h"

#include <algorithm>

#include "core/base/input_error.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/studio_choices.h"
#include "viewer/gateway/studio_scan.h"
#include "viewer/gateway/training_api.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using Kind = StudioJob::Kind;

constexpr auto inspect_limit = std::chrono::minutes(5);
constexpr auto build_limit = std::chrono::hours(2);
constexpr const char* found_in = "inspect";
constexpr const char* pose_folder = "pose";
constexpr const char* damaged = "the project's description is damaged";

std::string state_of(const StudioProject& p, const char* what) {
  return p.work.contains(what) ? text_of(p.work[what], "state") : std::string();
}

constexpr std::size_t most_uploads = 10'000;

/// Whoever asks for these must have seen the present choices.
bool depends_on_choices(std::string_view path) {
  return path == "choose" || path == "undo" || path == "redo" || path == "build" || path == "try";
}

bool is_upload_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 &&
         std::all_of(name.begin(), name.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

/// As a word of a shell.
std::string quoted(const std::string& word) { return word.find(' ') == std::string::npos ? word : "\"" + word + "\""; }

std::string command_line(const StudioProject& p) {
  std::string out = "insula case new " + p.name + " " + quoted(p.file);
  for (const std::string& word : case_words(p.choices())) out += " " + quoted(word);
  return out;
}

std::vector<std::string> exercises_in(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (it->path().extension() == ".xml" && name.size() > 2 && name[0] >= '1' && name[0] <= '9' && name[1] == '_')
      out.push_back(name);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

Studio::Studio(const StudioPlaces& places)
    : places_(places),
      projects_(places.data / "studio"),
      player_(places.programs / "insula", places.data),
      poses_(places.programs / "insula_case"),
      scenes_(places.data, places.programs / "insula", player_) {
  std::error_code ignored;
  if (offered()) fs::remove_all(projects_.incoming_folder(), ignored);  // what an earlier run left
}

fs::path Studio::incoming() {
  std::error_code ignored;
  fs::create_directories(projects_.incoming_folder(), ignored);
  return projects_.incoming_folder() / std::to_string(++came_);
}

const StudioJob* Studio::job(const std::string& name, Kind kind) const {
  const auto it = jobs_.find(name);
  return it != jobs_.end() && it->second->kind() == kind ? it->second.get() : nullptr;
}

std::string Studio::building() const {
  for (const auto& [name, job] : jobs_)
    if (job->kind() == Kind::build) return name;
  return {};
}

fs::path Studio::case_folder(const StudioProject& p) const {
  const std::string folder = p.work.contains("built") ? text_of(p.work["built"], "folder") : std::string();
  return folder.empty() ? fs::path() : projects_.folder(p.name) / folder / p.name;
}

Json Studio::built_json(const StudioProject& p) const {
  const fs::path folder = case_folder(p);
  if (folder.empty()) return nullptr;
  const Json report = read_json(folder / "report.json"), scenes = read_json(folder / "scenes.json");
  const Json rules = read_json(folder / "rules.json"), wall = read_json(folder / "wall/notes.json");
  return {{"current", p.work["built"].value("choices", Json()) == p.choices()},
          {"number", p.work["built"].value("folder", "")},
          {"report", report.is_object() ? report : Json::object()},
          {"clip", scenes.is_object() && scenes.contains("clip") ? scenes["clip"] : Json()},
          {"clips", scenes.is_object() && scenes.contains("clips") ? scenes["clips"] : Json::array()},
          {"rules", rules.is_array() ? rules : Json::array()},
          {"walls", wall.is_object() ? wall.value("proposed_walls", Json::array()) : Json::array()},
          {"exercises", exercises_in(folder)}};
}

ApiAnswer Studio::shown(const StudioProject& p) const {
  const auto work = [&](const char* what, const StudioJob* job) {
    Json out = p.work.contains(what) ? p.work[what] : Json::object();
    // What was running when this program ended is running no more.
    if (!job && text_of(out, "state") == "running") out["state"] = "interrupted";
    if (job)
      out.update(
          {{"stage", job->stage()}, {"percent", job->percent()}, {"step", job->step()}, {"seconds", job->seconds()}});
    return out;
  };
  Json inspected = work("inspect", job(p.name, Kind::inspect));
  if (text_of(inspected, "state") == "done")
    inspected["facts"] = read_json(projects_.folder(p.name) / found_in / "inspect.json");
  Json scan;
  if (is_scan(p)) {
    scan = work("scan", job(p.name, Kind::scan));
    if (text_of(scan, "state") == "done") scan["facts"] = read_json(scan_file(projects_.folder(p.name), ".json"));
  }
  Json play = player_.state(p.name);
  if (job(p.name, Kind::add)) play = {{"state", "adding"}, {"url", ""}, {"error", ""}};
  else if (const auto it = add_error_.find(p.name); it != add_error_.end())
    play = {{"state", "ended"}, {"url", ""}, {"error", it->second}};
  Json trial = work("trial", job(p.name, Kind::trial));
  add_trial(p, trial);
  return answer_with(Json{{"name", p.name},
                          {"file", p.file},
                          {"choices", p.choices()},
                          {"revision", p.revision},
                          {"undo", p.at > 0},
                          {"redo", p.at + 1 < p.history.size()},
                          {"command", command_line(p)},
                          {"scan", scan},
                          {"inspect", inspected},
                          {"build", work("build", job(p.name, Kind::build))},
                          {"built", built_json(p)},
                          {"trial", trial},
                          {"play", play}});
}

void Studio::inspect(StudioProject& p) {
  if (is_scan(p) && !scan_is_read(p)) return read_scan(p);
  if (!is_scan(p) || has_level(p)) return read_surface(p);
  // No vessel is chosen in it.
  jobs_.erase(p.name);
  p.work["inspect"]["state"] = "waiting";
  projects_.write(p);
}

void Studio::read_surface(StudioProject& p) {
  const fs::path folder = projects_.folder(p.name);
  std::error_code ignored;
  fs::remove_all(folder / "inspect.part", ignored);
  std::vector<std::string> command{(places_.programs / "insula_case").string(), "inspect", (folder / p.input).string(),
                                   "--out", (folder / "inspect.part").string()};
  const std::vector<std::string> more = with_strokes(intake_words(p.choices()), p, folder);
  command.insert(command.end(), more.begin(), more.end());
  const int number = p.work.contains("inspect") ? p.work["inspect"].value("number", 0) : 0;
  p.work["inspect"] = {{"state", "running"}, {"error", ""}, {"number", number + 1}};
  projects_.write(p);
  jobs_[p.name] = std::make_unique<StudioJob>(Kind::inspect, command, inspect_limit);
}

ApiAnswer Studio::build(StudioProject& p) {
  if (const std::string other = building(); !other.empty())
    return refusal(409, other == p.name ? "this case is being built" : "another case is being built: " + other);
  if (state_of(p, "inspect") != "done" || jobs_.count(p.name)) return refusal(409, "the file must be read first");
  const fs::path folder = projects_.folder(p.name);
  const int number = p.work.value("builds", 0) + 1;
  const std::string name = "build_" + std::to_string(number);
  std::error_code ignored;
  const std::string kept = p.work.contains("built") ? text_of(p.work["built"], "folder") : std::string();
  for (int k = 1; k <= number; ++k)  // what earlier ones left
    if (const std::string old = "build_" + std::to_string(k); old != kept) fs::remove_all(folder / old, ignored);
  std::vector<std::string> command{(places_.programs / "insula_case").string(),
                                   "new",
                                   p.name,
                                   (folder / p.input).string(),
                                   "--out",
                                   (folder / name).string()};
  const std::vector<std::string> more = with_strokes(case_words(p.choices()), p, folder);
  command.insert(command.end(), more.begin(), more.end());
  p.work["builds"] = number;
  p.work["build"] = {{"state", "running"}, {"error", ""}, {"folder", name}, {"choices", p.choices()}};
  projects_.write(p);
  jobs_[p.name] = std::make_unique<StudioJob>(Kind::build, command, build_limit);
  return shown(p);
}

ApiAnswer Studio::play(StudioProject& p, const std::string& exercise) {
  const fs::path folder = case_folder(p);
  const std::vector<std::string> all = folder.empty() ? std::vector<std::string>() : exercises_in(folder);
  if (std::find(all.begin(), all.end(), exercise) == all.end()) return refusal(404, "there is no such exercise");
  if (jobs_.count(p.name)) return refusal(409, at_work);
  add_error_.erase(p.name);
  wanted_exercise_[p.name] = exercise;
  const std::vector<std::string> command{(places_.programs / "insula").string(),
                                         "cases",
                                         "add",
                                         folder.string(),
                                         "--replace",
                                         "--data",
                                         places_.data.string()};
  jobs_[p.name] = std::make_unique<StudioJob>(Kind::add, command, inspect_limit);
  return shown(p);
}

void Studio::added(const std::string& name, const StudioJob& job) {
  if (!job.succeeded()) {
    add_error_[name] = job.error();
    return;
  }
  const fs::path folder = places_.data / "cases" / name;
  const Json manifest = read_json(folder / "insula_case.json");
  if (manifest.is_object() && manifest.contains("scenes"))
    for (const Json& scene : manifest["scenes"])
      if (scene.is_string() && fs::path(scene.get<std::string>()).filename() == wanted_exercise_[name])
        return player_.play(name, folder / scene.get<std::string>());
  add_error_[name] = "the exercise is not in the added case";
}

void Studio::ended(const std::string& name, const StudioJob& job) {
  if (job.kind() == Kind::add) return added(name, job);
  std::optional<StudioProject> p = projects_.read(name);
  if (!p) return;
  if (job.kind() == Kind::scan) return scan_ended(*p, job);
  if (job.kind() == Kind::trial) return trial_ended(*p, job);
  Json& work = p->work[job.kind() == Kind::build ? "build" : "inspect"];
  std::error_code error;
  if (job.succeeded() && job.kind() == Kind::inspect) {
    const fs::path folder = projects_.folder(name);
    fs::remove_all(folder / found_in, error);
    fs::rename(folder / "inspect.part", folder / found_in, error);
  }
  if (job.succeeded() && job.kind() == Kind::build)
    p->work["built"] = {{"folder", work["folder"]}, {"choices", work["choices"]}};
  work["state"] = error || !job.succeeded() ? (job.cancelled() ? "cancelled" : "failed") : "done";
  work["error"] = error ? project_not_written : job.error();
  projects_.write(*p);
}

void Studio::look() {
  player_.look();
  poses_.look();
  scenes_.look();
  for (auto it = jobs_.begin(); it != jobs_.end();) {
    if (!it->second->look()) {
      ++it;
      continue;
    }
    const auto [name, job] = std::pair(it->first, std::move(it->second));
    it = jobs_.erase(it);
    try {
      ended(name, *job);
    } catch (const InputError&) {
      // The disk is full. The page then shows that the work was interrupted.
    }
  }
}

ApiAnswer Studio::change(StudioProject& p, std::string_view path, const Json& body) {
  const auto reading = [](const StudioProject& of) {
    return std::pair(intake_words(of.choices()), of.choices()["paint"]);
  };
  StudioProject next = p;
  if (path == "choose") choose(next, changed_choices(p.choices(), body.value("choices", Json())));
  if (path == "undo") undo(next);
  if (path == "redo") redo(next);
  const bool anew = reading(next) != reading(p);
  if (anew && jobs_.count(p.name) && !job(p.name, Kind::inspect)) return refusal(409, at_work);
  if (anew) inspect(next);
  else projects_.write(next);
  return shown(next);
}

ApiAnswer Studio::act(std::string_view path, StudioProject& p, const Json& body) {
  if (depends_on_choices(path)) {
    const auto seen = body.find("revision");
    if (seen == body.end() || !seen->is_number_integer()) return refusal(428, "the revision of the case is missing");
    if (*seen != p.revision) return refusal(412, "the case was changed in another window");
  }
  if (path == "choose" || path == "undo" || path == "redo") return change(p, path, body);
  if (path == "build") return build(p);
  if (path == "try") return try_clip(p);
  if (path == "again") {
    if (jobs_.count(p.name)) return refusal(409, at_work);
    inspect(p);
    return shown(p);
  }
  if (path == "play") return play(p, text_of(body, "exercise"));
  if (path == "edit") {
    const fs::path folder = case_folder(p);
    return folder.empty() ? refusal(409, "the case must be built first") : scenes_.open(folder, p.name);
  }
  if (path == "cancel") {
    if (const auto it = jobs_.find(p.name); it != jobs_.end()) it->second->cancel();
    return shown(p);
  }
  if (path == "remove") {
    if (jobs_.count(p.name)) return refusal(409, at_work);
    projects_.remove(p.name);
    return {200, "{}\n"};
  }
  return refusal(404, "not found");
}

ApiAnswer Studio::pose(const StudioProject& p, std::string_view query) {
  const fs::path built = case_folder(p);
  if (built.empty()) return refusal(409, "the case must be built first");
  const std::string wanted = query_value(query, "pose");
  std::optional<StudioPoses::Question> question;
  if (!wanted.empty()) {
    const auto pose = pose_of(wanted);
    if (!pose) return refusal(400, "a place has six numbers");
    question = {*pose, query_value(query, "parted") == "1"};
  }
  return answer_with(poses_.ask(built, projects_.folder(p.name) / pose_folder, question));
}

ApiAnswer Studio::get(std::string_view path, std::string_view query) {
  if (StudioScenes::answers(path)) return scenes_.get(path, query);
  if (path == "projects") {
    Json list = Json::array();
    for (const std::string& name : projects_.names())
      if (const auto p = projects_.read(name))
        list.push_back({{"name", name}, {"file", p->file}, {"built", !case_folder(*p).empty()}});
    return answer_with(Json{{"projects", list}, {"building", building()}, {"most_bytes", most_scan_bytes}});
  }
  if (path != "project" && path != "pose") return refusal(404, "not found");
  std::optional<StudioProject> p = projects_.read(query_value(query, "name"));
  if (!p) return refusal(404, "there is no such project");
  try {
    if (path == "pose") return pose(*p, query);
    const std::string state = state_of(*p, is_scan(*p) && !scan_is_read(*p) ? "scan" : "inspect");
    if (!jobs_.count(p->name) && (state.empty() || state == "running")) inspect(*p);
    return shown(*p);
  } catch (const InputError& e) {
    return refusal(500, e.what());
  } catch (const Json::exception&) {
    return refusal(500, damaged);
  }
}

ApiAnswer Studio::post(std::string_view path, const std::string& text) {
  const Json body = Json::parse(text, nullptr, false);
  if (!body.is_object()) return refusal(400, "this is no JSON object");
  if (StudioScenes::answers(path)) return scenes_.post(path, body);
  if (path == "discard") return discard(text_of(body, "upload"));
  std::optional<StudioProject> p = projects_.read(text_of(body, "name"));
  if (!p) return refusal(404, "there is no such project");
  try {
    return act(path, *p, body);
  } catch (const InputError& e) {
    return refusal(400, e.what());
  } catch (const Json::exception&) {
    return refusal(500, damaged);
  }
}

ApiAnswer Studio::upload(std::string_view query, const fs::path& content) {
  try {
    const std::string upload = query_value(query, "upload");
    if (const auto it = uploads_.find(upload); it != uploads_.end()) {
      uploads_.erase(it);
      return refusal(409, "cancelled");
    }
    const UploadKind kind = kind_of_upload(content);
    if (kind.extension.empty()) return refusal(kind.status, kind.refused);
    StudioProject p = projects_.create(query_value(query, "file"), kind.input(), content);
    if (is_upload_name(upload)) uploads_[upload] = p.name;
    if (kind.scan) p.work["scan"] = Json::object();
    inspect(p);
    return shown(p);
  } catch (const InputError& e) {
    return refusal(507, e.what());
  }
}

/// The page cannot know whether all of a file had arrived when it was cancelled.
ApiAnswer Studio::discard(const std::string& upload) {
  if (!is_upload_name(upload)) return refusal(400, "an upload has a name of letters and digits");
  if (uploads_.size() >= most_uploads) return refusal(409, "too many uploads: start the studio again");
  if (const std::string project = uploads_[upload]; !project.empty()) {
    jobs_.erase(project);  // its program ends with it
    projects_.remove(project);
    uploads_.erase(upload);
  }
  return {200, "{}\n"};
}

std::optional<fs::path> Studio::file(std::string_view path, std::string_view query) const {
  const auto p = projects_.read(query_value(query, "name"));
  if (!p) return std::nullopt;
  fs::path out;
  if (path == "pose_surface") {
    const std::string part = query_value(query, "part");
    if (part.empty() || part.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") != std::string::npos) return std::nullopt;
    out = projects_.folder(p->name) / pose_folder / (part + ".ply");
  } else if (path == "surface") out = projects_.folder(p->name) / found_in / "surface.ply";
  else if (path == "scan") out = scan_file(projects_.folder(p->name), ".raw");
  else if (const fs::path folder = case_folder(*p); folder.empty()) return std::nullopt;
  else if (path == "report") out = folder / "report.html";
  else if (path == "side" || path == "front" || path == "fissure")
    out = folder / ("report_" + std::string(path) + ".svg");
  std::error_code error;
  return fs::is_regular_file(out, error) ? std::optional(out) : std::nullopt;
}

}  // namespace insula::gateway
