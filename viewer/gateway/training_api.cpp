// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/training_api.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "viewer/gateway/static_files.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;
using training::Person;
using training::Run;

template <class J>
std::string dump(const J& json) {
  return json.dump(-1, ' ', false, J::error_handler_t::replace) + "\n";
}

TrainingApi::Answer error(int status, const std::string& text) { return {status, dump(Json{{"error", text}})}; }

Json read_json(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return Json::parse(std::string(std::istreambuf_iterator<char>(in), {}), nullptr, false);
}

Ordered person_json(const Person& p) {
  return {{"pseudonym", p.pseudonym}, {"role", p.role}, {"handedness", p.handedness}, {"year", p.year}};
}

/// Recordings are named to pages without their folder (sessions.h).
Ordered run_json(const Run& r) {
  return {{"uuid", r.uuid},
          {"person", r.person},
          {"scene", r.scene},
          {"title", r.title},
          {"mode", r.mode},
          {"began_ms", r.began_ms},
          {"duration_s", r.duration_s},
          {"state", r.state},
          {"goals", r.goals},
          {"goals_done", r.goals_done},
          {"faults", r.faults},
          {"step_rate_hz", r.step_rate_hz},
          {"recording", fs::path(r.recording).stem().string()}};
}

Ordered full_run_json(const Run& r) {
  Ordered out = run_json(r);
  out["metrics"] = Ordered::array();
  for (const auto& m : r.metrics)
    out["metrics"].push_back({{"id", m.id},
                              {"hand", m.hand},
                              {"value", m.value},
                              {"text", m.text},
                              {"unit", m.unit},
                              {"better", m.better},
                              {"digits", m.digits}});
  out["fault_counts"] = Ordered::array();
  for (const auto& f : r.fault_counts)
    out["fault_counts"].push_back({{"id", f.id}, {"text", f.text}, {"count", f.count}});
  return out;
}

Ordered curves_json(const std::vector<training::LearningCurve>& curves) {
  Ordered out = Ordered::array();
  for (const auto& c : curves) {
    Ordered points = Ordered::array();
    for (const auto& p : c.points)
      points.push_back(
          {{"uuid", p.uuid}, {"began_ms", p.began_ms}, {"mode", p.mode}, {"done", p.done}, {"value", p.value}});
    out.push_back({{"metric", c.metric.id},
                   {"hand", c.metric.hand},
                   {"text", c.metric.text},
                   {"unit", c.metric.unit},
                   {"better", c.metric.better},
                   {"digits", c.metric.digits},
                   {"points", std::move(points)}});
  }
  return out;
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

std::string text_of(const Json& body, const char* name) {
  const auto found = body.find(name);
  return found != body.end() && found->is_string() ? found->get<std::string>() : std::string();
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

TrainingApi::TrainingApi(Files files, std::function<void(const std::string&)> choose)
    : files_(std::move(files)), choose_(std::move(choose)) {
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

TrainingApi::Answer TrainingApi::get(std::string_view path, std::string_view query) {
  const auto value = [&](std::string_view name) { return query_value(query, name); };
  try {
    if (path == "exercises") {
      Json list = exercises_;
      for (Json& e : list) e["picture"] = !e["picture"].get<std::string>().empty();  // pages need no path
      return {200, dump(list)};
    }
    if (path == "state") {
      const Json state = files_.choice.empty() ? Json() : read_json(files_.choice);
      return {200, dump(state.is_object() ? state : Json::object())};
    }
    const bool listed = path == "people" || path == "history" || path == "runs";
    if (listed && files_.store.empty()) return {200, "[]\n"};
    if (path == "people") return {200, dump(list_of(store().persons(), person_json))};
    if (path == "history") return {200, dump(history_json(store().history(value("person"))))};
    if (path == "runs") return {200, dump(list_of(store().runs(value("person")), run_json))};
    if (path == "run") {
      const auto run = store().run(value("uuid"));
      return run ? Answer{200, dump(full_run_json(*run))} : error(404, "there is no such run");
    }
    if (path == "curves") return {200, dump(curves_json(store().curves(value("person"), value("scene"))))};
  } catch (const InputError& e) {
    return error(503, e.what());
  }
  return error(404, "not found");
}

TrainingApi::Answer TrainingApi::post(std::string_view path, const std::string& text) {
  const Json body = Json::parse(text, nullptr, false);
  if (!body.is_object()) return error(400, "this is no JSON object");
  if (path == "people") return add_person(body);
  if (path == "choose") return choose_exercise(body);
  return error(404, "not found");
}

TrainingApi::Answer TrainingApi::add_person(const Json& body) {
  Person p;
  p.pseudonym = text_of(body, "pseudonym");
  if (body.contains("role")) p.role = text_of(body, "role");
  if (body.contains("handedness")) p.handedness = text_of(body, "handedness");
  if (const auto year = body.find("year"); year != body.end()) {
    if (!year->is_number_integer()) return error(400, "the year of training is no whole number");
    p.year = int(std::clamp<std::int64_t>(year->get<std::int64_t>(), -1, 1000));
  }
  if (files_.store.empty()) return error(503, "this session keeps nothing, so nobody can be added");
  try {
    return {200, dump(person_json(store().add(p)))};
  } catch (const InputError& e) {
    return error(400, e.what());
  }
}

TrainingApi::Answer TrainingApi::choose_exercise(const Json& body) {
  const std::string scene = text_of(body, "scene"), person = text_of(body, "person");
  bool known = false;
  for (const Json& e : exercises_) known = known || e["scene"] == scene;
  if (!known) return error(404, fmt::format("there is no exercise {}", in_quotes(scene)));
  try {
    if (!person.empty() && !store().find(person))
      return error(404, fmt::format("nobody has the pseudonym {}", in_quotes(person)));
  } catch (const InputError& e) {
    return error(503, e.what());
  }
  choose_(Json{{"scene", scene}, {"person", person}}.dump());
  return {202, "{}\n"};
}

fs::path TrainingApi::picture(const std::string& scene) const {
  for (const Json& e : exercises_)
    if (e["scene"] == scene) return fs::path(e["picture"].get<std::string>());
  return {};
}

}  // namespace insula::gateway
