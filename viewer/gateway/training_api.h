// SPDX-License-Identifier: GPL-3.0-or-later
// What the start page asks for: exercises, persons, their runs, and another exercise. JSON in, JSON out. Only for pages
// on this machine, since runs are a person's data.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "training/store/store.h"
#include "viewer/gateway/api_answer.h"
#include "viewer/gateway/curriculum_api.h"

namespace insula::gateway {

class TrainingApi {
 public:
  struct Files {
    std::filesystem::path store;  ///< training store; empty: nobody is known, and nothing is kept
    std::filesystem::path
        catalogue;                 ///< read once; exercises that may be chosen (engine/live/catalogue.h); empty: none
    std::filesystem::path choice;  ///< the running exercise (engine/live/exercise_choice.h)
    std::filesystem::path curricula =
        {};  ///< what may be followed (engine/authoring/curriculum_list.h); empty: nothing
  };
  /// What is asked of the program that started this one; an empty function: nothing is asked.
  struct Asks {
    std::function<void(const std::string& json)> choose = {};  ///< gets a choice that is allowed
    std::function<void()> curricula = {};                      ///< the file of curricula is wanted
  };
  TrainingApi(Files files, Asks asks);

  /// path: what follows /api/. query: what follows the question mark.
  ///   exercises                     [{scene, group, title, text, picture: whether there is one}]
  ///   state                         {scene, person, state, text}
  ///   people                        [{pseudonym, role, handedness, year}]
  ///   history?person=               [{scene, title, runs, last, best}], guests' without a person
  ///   runs?person=                  the newest 200
  ///   run?uuid=                     one with metrics and faults
  ///   curricula, curriculum?person=, certificate?person=&curriculum= (curriculum_api.h)
  ///   curves?person=&scene=         [...], learning_json.h
  ApiAnswer get(std::string_view path, std::string_view query);
  ///   people {pseudonym, role, handedness, year}; choose {scene, person, mode, seed, request}, the last three if they
  ///   are wanted; curriculum {person, curriculum}
  ApiAnswer post(std::string_view path, const std::string& body);
  /// Picture of an exercise of the catalogue; empty: there is none.
  std::filesystem::path picture(const std::string& scene) const;

 private:
  training::Store& store();
  ApiAnswer curves(const std::string& person, const std::string& scene);
  ApiAnswer add_person(const nlohmann::json& body);
  ApiAnswer choose_exercise(const nlohmann::json& body);
  ApiAnswer follow_curriculum(const nlohmann::json& body);

  Files files_;
  std::vector<nlohmann::json> exercises_;  ///< each with a scene and the file of its picture
  std::function<void(const std::string&)> choose_;
  std::unique_ptr<training::Store> store_;  ///< opened when it is first needed
  CurriculumApi curricula_;
};

/// The decoded value of a name in a query ("a=1&b=2"); empty if it is not there.
std::string query_value(std::string_view query, std::string_view name);

}  // namespace insula::gateway
