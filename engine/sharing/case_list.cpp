// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/sharing/case_list.h"

#include <algorithm>
#include <map>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "engine/sharing/case_archive.h"
#include "training/store/data_folder.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr const char* group = "cases";

nlohmann::json read_report(const fs::path& folder) {
  std::error_code error;
  const fs::path file = folder / "report.json";
  if (!fs::is_regular_file(file, error)) return {};
  nlohmann::json json = nlohmann::json::parse(read_file_bytes(file), nullptr, false);
  return json.is_object() ? json : nlohmann::json();
}

/// The exercises of an unpacked archive; empty if it is none.
std::vector<CatalogueEntry> exercises_of(const fs::path& unpacked) {
  std::vector<CatalogueEntry> out;
  std::error_code error;
  if (!fs::is_regular_file(unpacked / case_manifest, error)) return out;
  const auto manifest = nlohmann::json::parse(read_file_bytes(unpacked / case_manifest), nullptr, false);
  if (!manifest.is_object() || !manifest.contains("scenes") || !manifest["scenes"].is_array()) return out;
  for (const auto& scene : manifest["scenes"]) {
    if (!scene.is_string()) continue;
    const fs::path file = fs::absolute(unpacked / scene.get<std::string>()).lexically_normal();
    if (auto entry = catalogue_entry(file)) {
      entry->scene = file.string(), entry->group = group, entry->of_case = fs::absolute(unpacked).string();
      out.push_back(std::move(*entry));
    }
  }
  return out;
}

std::vector<fs::path> added_folders(const fs::path& data) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator it(added_cases_folder(data), error), end; !error && it != end; it.increment(error))
    if (it->is_directory(error) && is_case_name(it->path().filename().string())) out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

fs::path added_cases_folder(const fs::path& data) { return training::data_folder(data).root / "cases"; }

std::vector<CatalogueEntry> added_exercises(const fs::path& data) {
  std::vector<CatalogueEntry> out;
  for (const fs::path& folder : added_folders(data))
    for (CatalogueEntry& e : exercises_of(folder)) out.push_back(std::move(e));
  return out;
}

ListedCase built_case(const fs::path& given) {
  const fs::path folder = fs::weakly_canonical(given);
  ListedCase out{folder.filename().string(), folder, false, {}, read_report(folder)};
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != ".xml") continue;
    if (auto entry = catalogue_entry(it->path())) {
      entry->scene = it->path().string();
      out.exercises.push_back(std::move(*entry));
    }
  }
  if (out.exercises.empty()) throw InputError(folder.string() + ": no exercise is in this folder");
  std::sort(out.exercises.begin(), out.exercises.end(),
            [](const CatalogueEntry& a, const CatalogueEntry& b) { return a.scene < b.scene; });
  return out;
}

std::vector<ListedCase> list_cases(const fs::path& project, const fs::path& data) {
  std::map<std::string, ListedCase> cases;
  for (CatalogueEntry& e : catalogue(project)) {
    if (e.group != group) continue;
    const fs::path scene(e.scene);
    const bool alone = e.of_case.empty();
    const std::string name = alone ? scene.stem().string() : e.of_case;
    ListedCase& c = cases[name];
    c.name = name, c.folder = fs::absolute(project / scene.parent_path()).lexically_normal();
    if (!alone && c.report.is_null()) c.report = read_report(c.folder);
    c.exercises.push_back(std::move(e));
  }
  for (const fs::path& folder : added_folders(data)) {
    std::vector<CatalogueEntry> exercises = exercises_of(folder);
    if (exercises.empty()) continue;
    const fs::path of_scenes = fs::path(exercises.front().scene).parent_path();
    const std::string name = folder.filename().string();
    // An added case of a name that the project has too is another one.
    cases[name + (cases.count(name) ? " (added)" : "")] = {name, of_scenes, true, std::move(exercises),
                                                           read_report(of_scenes)};
  }
  std::vector<ListedCase> out;
  for (auto& [name, c] : cases) out.push_back(std::move(c));
  return out;
}

std::string exercise_id(const CatalogueEntry& e) { return e.id.empty() ? fs::path(e.scene).stem().string() : e.id; }

nlohmann::ordered_json cases_json(const std::vector<ListedCase>& cases) {
  auto out = nlohmann::ordered_json::array();
  for (const ListedCase& c : cases) {
    auto exercises = nlohmann::ordered_json::array();
    for (const CatalogueEntry& e : c.exercises)
      exercises.push_back({{"id", exercise_id(e)},
                           {"name", e.name},
                           {"scene", e.scene},
                           {"title", e.title},
                           {"difficulty", e.difficulty},
                           {"text", e.text},
                           {"picture", e.picture}});
    out.push_back({{"name", c.name},
                   {"added", c.added},
                   {"site", c.site()},
                   {"difficulty", c.difficulty()},
                   {"title", c.title()},
                   {"folder", c.folder.string()},
                   {"exercises", exercises},
                   {"report", c.report}});
  }
  return out;
}

}  // namespace insula
