// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/statements.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "training/xapi/identifiers.h"

namespace insula::xapi {
namespace {

using training::Run;

// Scenes are written in English, and so are their titles.
constexpr const char* language = "en";

/// RFC 3339, UTC, to the millisecond.
std::string timestamp(std::int64_t ms) {
  const std::int64_t seconds = ms >= 0 ? ms / 1000 : -((999 - ms) / 1000);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::time_t(seconds)), ms - 1000 * seconds);
}

/// ISO 8601. The specification compares durations to a hundredth of a second.
std::string duration(double seconds) { return fmt::format("PT{:.2f}S", seconds); }

bool has_ended(const Run& run) { return run.state == "done" || run.state == "failed"; }

std::string ending(const Run& run) {
  if (!run.done()) return "failed";
  return run.mode == "test" ? "passed" : "completed";
}

std::string extension(std::string_view path) { return fmt::format("{}/extensions/{}", vocabulary, path); }

Json actor_of(const Run& run, const Origin& origin) {
  return {{"objectType", "Agent"}, {"account", {{"homePage", origin.home_page}, {"name", run.person}}}};
}

Json verb_of(const std::string& name) {
  return {{"id", "http://adlnet.gov/expapi/verbs/" + name}, {"display", {{"en-US", name}}}};
}

Json object_of(const Run& run, const Origin& origin) {
  Json definition = {{"type", "http://adlnet.gov/expapi/activities/simulation"}};
  if (!run.title.empty()) definition["name"] = {{language, run.title}};
  const std::string text = origin.description ? origin.description(run.scene) : std::string();
  if (!text.empty()) definition["description"] = {{language, text}};
  return {{"objectType", "Activity"}, {"id", activity_of(run.scene, origin.home_page)}, {"definition", definition}};
}

Json extensions_of_result(const Run& run) {
  Json out = Json::object();
  for (const auto& m : run.metrics)
    if (std::isfinite(m.value))
      out[extension(fmt::format("metrics/{}/{}", encoded(m.id), encoded(m.hand)))] = {{"value", m.value},
                                                                                      {"unit", m.unit}};
  for (const auto& f : run.fault_counts) out[extension("faults/" + encoded(f.id))] = f.count;
  out[extension("faults")] = run.faults;
  return out;
}

Json result_of(const Run& run) {
  Json out = Json::object();
  if (run.goals > 0) {
    const int reached = std::clamp(run.goals_done, 0, run.goals);
    out["score"] = {{"scaled", double(reached) / run.goals}, {"raw", reached}, {"min", 0}, {"max", run.goals}};
  }
  if (has_ended(run)) out["success"] = run.done();
  out["completion"] = run.done();
  if (std::isfinite(run.duration_s) && run.duration_s >= 0) out["duration"] = duration(run.duration_s);
  out["extensions"] = extensions_of_result(run);
  return out;
}

Json context_of(const Run& run) {
  Json extensions = {{extension("mode"), run.mode}, {extension("guided"), run.guided}};
  if (run.seed) extensions[extension("seed")] = *run.seed;
  if (std::isfinite(run.step_rate_hz) && run.step_rate_hz > 0) extensions[extension("step_rate_hz")] = run.step_rate_hz;
  if (!run.version.empty()) extensions[extension("version")] = run.version;
  return {{"registration", run.uuid}, {"platform", "Insula"}, {"language", language}, {"extensions", extensions}};
}

}  // namespace

std::string activity_of(const std::string& scene, const std::string& home_page) {
  const std::filesystem::path path(scene);
  if (path.is_absolute()) {
    const std::string apart = uuid_v5(uuid_v5("6ba7b811-9dad-11d1-80b4-00c04fd430c8", home_page), scene).substr(0, 8);
    return fmt::format("{}/activities/installation/{}-{}", vocabulary, encoded(path.stem().string()), apart);
  }
  std::string out(vocabulary);
  out += "/activities";
  for (const auto& part : path) out += "/" + encoded(part.string());
  return out;
}

std::vector<Json> statements_of(const Run& run, const Origin& origin) {
  if (!run.is_attempt()) return {};
  if (!is_uuid(run.uuid)) throw InputError(fmt::format("the run {} has no UUID", in_quotes(run.uuid)));
  if (!is_iri(origin.home_page))
    throw InputError(fmt::format("the home page {} is no address", in_quotes(origin.home_page)));
  const auto statement = [&](const std::string& verb, std::int64_t at_ms) {
    return Json{{"id", uuid_v5(run.uuid, verb)},    {"actor", actor_of(run, origin)}, {"verb", verb_of(verb)},
                {"object", object_of(run, origin)}, {"context", context_of(run)},     {"timestamp", timestamp(at_ms)}};
  };
  std::vector<Json> out{statement("attempted", run.began_ms)};
  if (!has_ended(run)) {
    out[0]["result"] = result_of(run);
    return out;
  }
  const double lasted = std::isfinite(run.duration_s) ? std::clamp(run.duration_s, 0.0, 1e9) : 0;
  out.push_back(statement(ending(run), run.began_ms + std::llround(1000 * lasted)));
  out[1]["result"] = result_of(run);
  return out;
}

}  // namespace insula::xapi
