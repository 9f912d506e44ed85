// SPDX-License-Identifier: GPL-3.0-or-later
// What the scene editor of the studio asks for. A scene is edited as a copy, with all files that it names. Shipped
// files, and those of built cases, are only read. Used on the network thread.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "viewer/gateway/api_answer.h"
#include "viewer/gateway/studio_player.h"
#include "viewer/gateway/studio_question.h"
#include "viewer/gateway/studio_scene_files.h"

namespace insula::gateway {

class StudioScenes {
 public:
  /// Of one file.
  static constexpr std::size_t most_text_bytes = 200'000;

  /// data: folder of the user's data. program: insula. The player is the studio's.
  StudioScenes(std::filesystem::path data, std::filesystem::path program, StudioPlayer& player);
  /// Whether what follows /api/studio/ is meant for this class.
  static bool answers(std::string_view path) { return path.starts_with("scene"); }

  ///   scenes                        {scenes: [{name, state, error}], most_bytes}
  ///   scene_sources, scene_elements {state, error, sources | elements}; asks a program first, so ask again
  ///   scene?name=                   {name, state: "copying" | "ready" | "failed", error, scenes, files, meshes, look}
  ///   scene_file?name=&file=        {text, draft, versions, revision}
  ///   scene_version?name=&file=&number=   {text}
  ///   scene_checked?name=&file=     {state: "" | "running" | "done" | "failed", number, error, ok, problems}
  ApiAnswer get(std::string_view path, std::string_view query);
  ///   scene_new {name}: a scene from nothing, by `insula cases new`. scene_open {source}; scene_check {name, scene,
  ///   file, text, revision} gives {number, revision}; scene_write {name, file, text, revision} gives {versions,
  ///   revision}; scene_look {name, scene} and scene_leave {name}: the scene; scene_remove {name}. revision: that of
  ///   the file when the page last heard of it. If the file was changed since, nothing is done (412).
  ApiAnswer post(std::string_view path, const nlohmann::json& body);
  /// Copies a scene, or the scenes in the folder of a built case. file: what the copy is named after.
  ApiAnswer open(const std::filesystem::path& from, const std::string& file);
  void look();

 private:
  struct Check {
    int number = 0;
    std::filesystem::path folder;  ///< of the files that are checked
    std::unique_ptr<StudioQuestion> asked;
  };

  ApiAnswer asked(std::unique_ptr<StudioQuestion>& question, const std::vector<std::string>& words, const char* what,
                  std::chrono::seconds valid);
  ApiAnswer shown(const std::string& name) const;
  ApiAnswer list() const;
  ApiAnswer file(const std::string& name, std::string_view query) const;
  ApiAnswer checked(const std::string& name, const std::string& file) const;
  ApiAnswer begin(const std::string& name);
  ApiAnswer open_source(const std::string& source);
  ApiAnswer edit(std::string_view path, const std::string& name, const nlohmann::json& body);
  ApiAnswer check(const std::string& name, const std::string& file, const std::string& before,
                  const nlohmann::json& body);
  ApiAnswer write(const std::string& name, const std::string& file, const std::string& text);
  ApiAnswer act(std::string_view path, const std::string& name, const nlohmann::json& body);
  nlohmann::json sources() const;

  std::filesystem::path data_, program_;
  StudioSceneFiles files_;
  StudioPlayer& player_;
  std::unique_ptr<StudioQuestion> sources_, elements_;
  std::map<std::string, std::unique_ptr<StudioQuestion>> copies_;  ///< by name: those that run or have failed
  std::map<std::pair<std::string, std::string>, Check> checks_;    ///< by name and file: the last one each
  int check_number_ = 0;
};

}  // namespace insula::gateway
