// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/training_api.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/learning_json.h"
#include "viewer/gateway/run_json.h"
#include "viewer/gateway/static_files.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;
using training::Person;

Ordered person_json(const Person& p) {
  return {{"pseudonym", p.pseudonym}, {"role", p.role}, {"handedness", p.handedness}, {"year", p.year}};
}

template <class T>
Ordered list_of(const std::vector<T>& values, Ordered (*one)(const T&)) {
  Ordered out = Ordered::array();
  for (const T& value : values) out.push_back(one(value));
  return out;
}

Ordered history_json(const std::vector<training::ExerciseHistory>& history) {
  Ordered out = Ordered::array();
  for (const auto& h : history)
    out.push_back({{"scene", h.scene},
                   {"title", h.title},
                   {"runs", h.runs},
                   {"last", h.last ? run_json(*h.last) : Ordered()},
                   {"best", h.best ? run_json(*h.best) : Ordered()}});
  return out;
}

/// Copies the terms of an attempt, if there are any. Returns what is wrong with them.
std::string add_terms(const Json& body, Json& choice) {
  constexpr std::int64_t largest_seed = 2147483647;  // as in curricula
  constexpr std::size_t longest_name = 64;
  if (const auto mode = body.find("mode"); mode != body.end()) {
    if (*mode != "practice" && *mode != "test") return "the mode is neither practice nor test";
    choice["mode"] = *mode;
  }
  if (const auto seed = body.find("seed"); seed != body.end() && !seed->is_null()) {
    if (!seed->is_number_unsigned() || *seed == 0 || *seed > largest_seed)
      return fmt::format("the seed is no whole number from 1 to {}", largest_seed);
    choice["seed"] = *seed;
  }
  if (const auto request = body.find("request"); request != body.end()) {
    if (!request->is_string() || request->get_ref<const std::string&>().size() > longest_name)
      return "the name of the request is no short text";
    choice["request"] = *request;
  }
  return {};
}

}  // namespace

std::string query_value(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view part = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    if (!part.starts_with(name) || part.size() <= name.size() || part[name.size()] != '=') continue;
    return percent_decoded(part.substr(name.size() + 1)).value_or("");
  }
  return {};
}

TrainingApi::TrainingApi(Files files, Asks asks)
    : files_(std::move(files)),
      choose_(asks.choose ? std::move(asks.choose) : [](const std::string&) {}),
      curricula_(
          files_.curricula, asks.curricula ? std::move(asks.curricula) : [] {}) {
  if (files_.catalogue.empty()) return;
  for (const Json& e : read_json(files_.catalogue))
    if (e.is_object() && e.contains("scene") && e["scene"].is_string() && e.contains("picture") &&
        e["picture"].is_string())
      exercises_.push_back(e);
}

training::Store& TrainingApi::store() {
  if (files_.store.empty()) throw InputError("this session keeps nothing");
  if (!store_) store_ = std::make_unique<training::Store>(files_.store);
  return *store_;
}

ApiAnswer TrainingApi::get(std::string_view path, std::string_view query) {
  const auto value = [&](std::string_view name) { return query_value(query, name); };
  try {
    if (path == "exercises") {
      Json list = exercises_;
      for (Json& e : list) e["picture"] = !e["picture"].get<std::string>().empty();  // pages need no path
      return answer_with(list);
    }
    if (path == "state") {
      const Json state = files_.choice.empty() ? Json() : read_json(files_.choice);
      return answer_with(state.is_object() ? state : Json::object());
    }
    if (path == "curricula") return curricula_.list();
    if (path == "curriculum") return curricula_.progress(store(), value("person"));
    if (path == "certificate") return curricula_.certificate(store(), value("person"), value("curriculum"));
    const bool listed = path == "people" || path == "history" || path == "runs";
    if (listed && files_.store.empty()) return {200, "[]\n"};
    if (path == "people") return answer_with(list_of(store().persons(), person_json));
    if (path == "history") return answer_with(history_json(store().history(value("person"))));
    if (path == "runs") return answer_with(list_of(store().runs(value("person")), run_json));
    if (path == "run") {
      const auto run = store().run(value("uuid"));
      return run ? answer_with(full_run_json(*run)) : refusal(404, "there is no such run");
    }
    if (path == "curves") return curves(value("person"), value("scene"));
  } catch (const InputError& e) {
    return refusal(503, e.what());
  }
  return refusal(404, "not found");
}

ApiAnswer TrainingApi::curves(const std::string& person, const std::string& scene) {
  Ordered out = Ordered::array();
  const std::string followed = person.empty() ? std::string() : store().followed(person);
  for (const training::LearningCurve& c : store().curves(person, scene)) {
    const Gate* gate = curricula_.metric_gate(scene, c.metric.id, c.metric.hand, followed);
    out.push_back(
        curve_json(c, gate ? std::optional(level_of(*gate)) : level_of_specialists(store(), scene, c.metric)));
  }
  return answer_with(out);
}

ApiAnswer TrainingApi::post(std::string_view path, const std::string& text) {
  const Json body = Json::parse(text, nullptr, false);
  if (!body.is_object()) return refusal(400, "this is no JSON object");
  if (path == "people") return add_person(body);
  if (path == "choose") return choose_exercise(body);
  if (path == "curriculum") return follow_curriculum(body);
  return refusal(404, "not found");
}

ApiAnswer TrainingApi::add_person(const Json& body) {
  Person p;
  p.pseudonym = text_of(body, "pseudonym");
  if (body.contains("role")) p.role = text_of(body, "role");
  if (body.contains("handedness")) p.handedness = text_of(body, "handedness");
  if (const auto year = body.find("year"); year != body.end()) {
    if (!year->is_number_integer()) return refusal(400, "the year of training is no whole number");
    p.year = int(std::clamp<std::int64_t>(year->get<std::int64_t>(), -1, 1000));
  }
  if (files_.store.empty()) return refusal(503, "this session keeps nothing, so nobody can be added");
  try {
    return answer_with(person_json(store().add(p)));
  } catch (const InputError& e) {
    return refusal(400, e.what());
  }
}

ApiAnswer TrainingApi::choose_exercise(const Json& body) {
  const std::string scene = text_of(body, "scene"), person = text_of(body, "person");
  bool known = curricula_.has_scene(scene);
  for (const Json& e : exercises_) known = known || e["scene"] == scene;
  if (!known) return refusal(404, fmt::format("there is no exercise {}", in_quotes(scene)));
  Json choice{{"scene", scene}, {"person", person}};
  if (const std::string why = add_terms(body, choice); !why.empty()) return refusal(400, why);
  try {
    if (!person.empty() && !store().find(person))
      return refusal(404, fmt::format("nobody has the pseudonym {}", in_quotes(person)));
  } catch (const InputError& e) {
    return refusal(503, e.what());
  }
  choose_(choice.dump());
  return {202, "{}\n"};
}

ApiAnswer TrainingApi::follow_curriculum(const Json& body) {
  try {
    return curricula_.follow(store(), body);
  } catch (const InputError& e) {
    return refusal(503, e.what());
  }
}

fs::path TrainingApi::picture(const std::string& scene) const {
  for (const Json& e : exercises_)
    if (e["scene"] == scene) return fs::path(e["picture"].get<std::string>());
  return {};
}

}  // namespace insula::gateway
