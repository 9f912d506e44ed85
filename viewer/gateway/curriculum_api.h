// SPDX-License-Identifier: GPL-3.0-or-later
// Curricula on the start page: which there are, which one a person follows, and how far he has come.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "training/curriculum/evaluate.h"
#include "training/store/store.h"
#include "viewer/gateway/api_answer.h"

namespace insula::gateway {

class CurriculumApi {
 public:
  /// file: curriculum_list_json() of engine/authoring/curriculum_list.h; empty: there are none. wanted: called when a
  /// page asks before the file is there.
  CurriculumApi(std::filesystem::path file, std::function<void()> wanted);

  /// {"state": "ready" | "loading" | "none" | "refused", "problem", "curricula": [{id, title, text, problem}]}.
  ApiAnswer list();
  /// {"state", "id"}: an empty id says that the person follows none. If ready, also progress_json() of
  /// training/progress/curriculum_json.h. There each task and what is next has the name of its exercise in "exercise"
  /// and of its scene in "scene_title", and the runs of a task are those that counted, the newest last.
  ApiAnswer progress(const training::Store& store, const std::string& person);
  /// certificate_json() of training/progress/certificate.h; 404 unless the curriculum has been passed.
  ApiAnswer certificate(const training::Store& store, const std::string& person, const std::string& curriculum);
  /// {"person", "curriculum"}: an id, or an empty text to follow none.
  ApiAnswer follow(training::Store& store, const nlohmann::json& body);
  /// The limits that a curriculum sets for a metric in this exercise: in its last task there that has any, of the
  /// followed curriculum, else of the first one that has. Null: none does.
  const Gate* metric_gate(const std::string& scene, const std::string& metric, const std::string& hand,
                          const std::string& followed);
  /// Whether a curriculum has a task in this exercise.
  bool has_scene(const std::string& name);

 private:
  struct Listed {
    std::string id, problem;
    std::optional<Curriculum> curriculum;
  };
  struct Scene {
    std::string name, title;
  };
  /// "ready", or why they are not there. Reads the file once it is there.
  const char* state();
  void read();
  const Listed* find(const std::string& id) const;
  Progress progress_in(const Curriculum& curriculum, const training::Store& store, const std::string& person) const;
  void name_scene(nlohmann::ordered_json& of) const;

  std::filesystem::path file_, project_;
  std::function<void()> wanted_;
  bool read_ = false;
  std::string version_;  ///< of the program that has read them
  std::string problem_;  ///< of the whole file
  std::vector<Listed> curricula_;
  std::map<std::string, Scene> scenes_;  ///< by their names in curricula
};

}  // namespace insula::gateway
