// SPDX-License-Identifier: GPL-3.0-or-later
// Another exercise, or another person, while a session runs. The start page asks for it through the gateway. A second
// engine loads the scene beside the first one and takes over when it is ready, as after a scene was saved.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/live/supervisor.h"

namespace insula {

struct ChosenExercise {
  std::string scene;                       ///< name (project_folder.h)
  std::string person;                      ///< pseudonym; empty: a guest
  std::string mode = {};                   ///< "practice" or "test"; empty: it is chosen on the page
  std::optional<std::uint32_t> seed = {};  ///< of the complications; none: that of the session
  std::string request = {};                ///< name by which the page that asks knows its own request; may be empty
};

class ExerciseChoice {
 public:
  /// The command line of the engine for a choice.
  using Command = std::function<std::vector<std::string>(const ChosenExercise&)>;
  /// state: file that tells pages how far it is (state_json()); empty: they are not told. taken: called when the
  /// engine of a choice has taken over.
  ExerciseChoice(ChosenExercise present, std::filesystem::path state, Command command,
                 std::function<void(const ChosenExercise&)> taken);

  /// A request as JSON: {"scene", "person"} and perhaps "mode", "seed", "request". Anything else is ignored, since a
  /// page may send anything.
  void ask(std::string_view json);
  /// Must be called repeatedly.
  void look(Supervisor& supervisor);

 private:
  void tell(const ChosenExercise& choice, const char* state, const std::string& text = {});

  ChosenExercise present_, wanted_;
  std::filesystem::path state_;
  Command command_;
  std::function<void(const ChosenExercise&)> taken_;
  bool waiting_ = false;  ///< wanted_ has not been offered yet
};

/// The choice in a request; none if it is wrong.
std::optional<ChosenExercise> read_choice(std::string_view json);
/// {"scene", "person", "mode", "request", "state": "running" | "loading" | "refused", "text"}.
std::string state_json(const ChosenExercise& choice, const char* state, const std::string& text);

}  // namespace insula
