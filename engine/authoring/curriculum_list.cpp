// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/authoring/curriculum_list.h"

#include <map>

#include "engine/live/project_folder.h"
#include "engine/session/session_format.h"
#include "training/curriculum/loader.h"
#include "training/progress/curriculum_json.h"
#include "training/store/data_folder.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_curricula = 200;

}  // namespace

std::vector<fs::path> curriculum_folders(const fs::path& data) {
  return {project_folder() / "curricula", training::data_folder(data).root / "curricula"};
}

std::vector<ListedCurriculum> list_curricula(const std::vector<fs::path>& folders, CurriculumFiles& sources) {
  std::map<std::string, fs::path> files;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
      if (it->path().extension() == ".xml" && files.size() < most_curricula)
        files[it->path().stem().string()] = it->path();
  }
  std::vector<ListedCurriculum> out;
  for (const auto& [id, file] : files) {
    CurriculumResult loaded = load_curriculum(file, sources);
    out.push_back({id, file, std::move(loaded.curriculum), {}});
    if (!out.back().curriculum) out.back().problem = loaded.diagnostics.format();
  }
  return out;
}

nlohmann::ordered_json curriculum_list_json(const std::vector<ListedCurriculum>& list, const CurriculumFiles& sources) {
  using Json = nlohmann::ordered_json;
  Json curricula = Json::array(), scenes = Json::object();
  for (const ListedCurriculum& c : list)
    curricula.push_back({{"id", c.id},
                         {"problem", c.problem},
                         {"curriculum", c.curriculum ? training::curriculum_json(*c.curriculum) : Json()}});
  for (const auto& [file, facts] : sources.scenes())
    scenes[scene_key(file)] = {{"scene", scene_name(file)}, {"title", facts.title}};
  return {{"version", session::library()},
          {"project", fs::absolute(project_folder()).lexically_normal().string()},
          {"curricula", std::move(curricula)},
          {"scenes", std::move(scenes)}};
}

}  // namespace insula
