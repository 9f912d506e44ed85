// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/curriculum_api.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "training/progress/attempts.h"
#include "training/progress/certificate.h"
#include "training/progress/curriculum_json.h"
#include "training/progress/local_time.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/run_json.h"

namespace insula::gateway {

using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;

CurriculumApi::CurriculumApi(std::filesystem::path file, std::function<void()> wanted)
    : file_(std::move(file)), wanted_(std::move(wanted)) {}

const char* CurriculumApi::state() {
  if (file_.empty()) return "none";
  std::error_code error;
  if (!read_ && std::filesystem::is_regular_file(file_, error)) read();
  if (!read_) {
    wanted_();
    return "loading";
  }
  return problem_.empty() ? "ready" : "refused";
}

void CurriculumApi::read() {
  read_ = true;
  const Json json = read_json(file_);
  problem_ = json.is_object() ? text_of(json, "problem") : "the list of curricula cannot be read";
  if (!problem_.empty()) return;
  try {
    version_ = json.at("version").get<std::string>();
    project_ = json.at("project").get<std::string>();
    for (const auto& [key, scene] : json.at("scenes").items())
      scenes_[key] = {scene.at("scene").get<std::string>(), scene.at("title").get<std::string>()};
    for (const Json& c : json.at("curricula")) {
      Listed listed{c.at("id"), c.at("problem"), std::nullopt};
      if (!c.at("curriculum").is_null()) listed.curriculum = training::curriculum_of(c.at("curriculum"));
      curricula_.push_back(std::move(listed));
    }
  } catch (const Json::exception& e) {
    problem_ = e.what();
  } catch (const InputError& e) {
    problem_ = e.what();
  }
}

ApiAnswer CurriculumApi::list() {
  Ordered out{{"state", state()}, {"problem", problem_}, {"curricula", Ordered::array()}};
  for (const Listed& c : curricula_)
    out["curricula"].push_back({{"id", c.id},
                                {"title", c.curriculum ? c.curriculum->title : c.id},
                                {"text", c.curriculum ? c.curriculum->text : ""},
                                {"problem", c.problem}});
  return answer_with(out);
}

const CurriculumApi::Listed* CurriculumApi::find(const std::string& id) const {
  const auto found = std::find_if(curricula_.begin(), curricula_.end(), [&](const Listed& c) { return c.id == id; });
  return found == curricula_.end() ? nullptr : &*found;
}

void CurriculumApi::name_scene(Ordered& of) const {
  const auto found = scenes_.find(of["scene"].get<std::string>());
  of["exercise"] = found == scenes_.end() ? "" : found->second.name;
  of["scene_title"] = found == scenes_.end() ? "" : found->second.title;
}

Progress CurriculumApi::progress_in(const Curriculum& curriculum, const training::Store& store,
                                    const std::string& person) const {
  const training::LocalTime at = training::local_time();
  return evaluate(curriculum, training::attempts_of(store, person, project_), at.ms, at.offset);
}

ApiAnswer CurriculumApi::certificate(const training::Store& store, const std::string& person, const std::string& id) {
  if (const std::string now = state(); now != "ready")
    return refusal(503, now == "loading" ? "the curricula are still being read" : "there are no curricula");
  const Listed* listed = find(id);
  if (!listed || !listed->curriculum) return refusal(404, fmt::format("there is no curriculum {}", in_quotes(id)));
  if (!store.find(person)) return refusal(404, fmt::format("nobody has the pseudonym {}", in_quotes(person)));
  const auto passed =
      training::certificate(store, person, *listed->curriculum, progress_in(*listed->curriculum, store, person));
  return passed ? answer_with(training::certificate_json(*passed, version_))
                : refusal(404, "the curriculum has not been passed yet");
}

ApiAnswer CurriculumApi::progress(const training::Store& store, const std::string& person) {
  const std::string id = person.empty() ? std::string() : store.followed(person);
  const std::string now = state();
  if (id.empty() || now != "ready") return answer_with(Ordered{{"state", now}, {"id", id}, {"problem", problem_}});
  const Listed* listed = find(id);
  if (!listed || !listed->curriculum)
    return refusal(404, listed ? listed->problem : fmt::format("the curriculum {} is not there", in_quotes(id)));
  Ordered out = training::progress_json(*listed->curriculum, progress_in(*listed->curriculum, store, person));
  out["state"] = now, out["id"] = id;
  name_scene(out["next"]);
  for (Ordered& module : out["modules"])
    for (Ordered& task : module["tasks"]) {
      name_scene(task);
      Ordered runs = Ordered::array();
      for (const Ordered& uuid : task["runs"])
        if (const auto run = store.run(uuid.get<std::string>())) runs.push_back(run_json(*run));
      task["runs"] = std::move(runs);
    }
  return answer_with(out);
}

ApiAnswer CurriculumApi::follow(training::Store& store, const Json& body) {
  const std::string person = text_of(body, "person"), id = text_of(body, "curriculum");
  if (!body.contains("curriculum") || !body["curriculum"].is_string())
    return refusal(400, "the request names no curriculum");
  if (!id.empty()) {
    if (const std::string now = state(); now != "ready")
      return refusal(503, now == "loading" ? "the curricula are still being read" : "there are no curricula");
    const Listed* listed = find(id);
    if (!listed || !listed->curriculum) return refusal(404, fmt::format("there is no curriculum {}", in_quotes(id)));
  }
  if (!store.find(person)) return refusal(404, fmt::format("nobody has the pseudonym {}", in_quotes(person)));
  store.follow(person, id);
  return answer_with(Json::object());
}

const Gate* CurriculumApi::metric_gate(const std::string& scene, const std::string& metric, const std::string& hand,
                                       const std::string& followed) {
  if (std::string_view(state()) != "ready") return nullptr;
  const Gate* found = nullptr;
  for (const Listed& listed : curricula_) {
    if (!listed.curriculum || (found && listed.id != followed)) continue;
    const Gate* last = nullptr;
    for (const Module& module : listed.curriculum->modules)
      for (const Task& task : module.tasks) {
        const auto named = scenes_.find(task.scene);
        if (named == scenes_.end() || named->second.name != scene) continue;
        for (const Gate& gate : task.gates)
          if (gate.kind == Gate::Kind::metric && gate.metric == metric && gate.hand == hand) last = &gate;
      }
    if (last) found = last;
    if (last && listed.id == followed) break;
  }
  return found;
}

bool CurriculumApi::has_scene(const std::string& name) {
  if (std::string_view(state()) != "ready") return false;
  return std::any_of(scenes_.begin(), scenes_.end(), [&](const auto& s) { return s.second.name == name; });
}

}  // namespace insula::gateway
