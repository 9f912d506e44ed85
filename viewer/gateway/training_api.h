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

namespace insula::gateway {

class TrainingApi {
 public:
  struct Files {
    std::filesystem::path store;  ///< training store; empty: nobody is known, and nothing is kept
    std::filesystem::path
        catalogue;                 ///< read once; exercises that may be chosen (engine/live/catalogue.h); empty: none
    std::filesystem::path choice;  ///< the running exercise (engine/live/exercise_choice.h)
  };
  /// choose: gets {"scene", "person"} of a choice that is allowed.
  TrainingApi(Files files, std::function<void(const std::string& json)> choose);

  struct Answer {
    int status = 200;  ///< of HTTP
    std::string json;  ///< an error is {"error": text}
  };
  /// path: what follows /api/. query: what follows the question mark.
  ///   exercises                     [{scene, group, title, text, picture: whether there is one}]
  ///   state                         {scene, person, state, text}
  ///   people                        [{pseudonym, role, handedness, year}]
  ///   history?person=               [{scene, title, runs, last, best}], guests' without a person
  ///   runs?person=                  the newest 200
  ///   run?uuid=                     one with metrics and faults
  ///   curves?person=&scene=         [{metric, hand, text, unit, better, digits, points}]
  Answer get(std::string_view path, std::string_view query);
  ///   people {pseudonym, role, handedness, year}; choose {scene, person}
  Answer post(std::string_view path, const std::string& body);
  /// Picture of an exercise of the catalogue; empty: there is none.
  std::filesystem::path picture(const std::string& scene) const;

 private:
  training::Store& store();
  Answer add_person(const nlohmann::json& body);
  Answer choose_exercise(const nlohmann::json& body);

  Files files_;
  std::vector<nlohmann::json> exercises_;  ///< each with a scene and the file of its picture
  std::function<void(const std::string&)> choose_;
  std::unique_ptr<training::Store> store_;  ///< opened when it is first needed
};

/// The decoded value of a name in a query ("a=1&b=2"); empty if it is not there.
std::string query_value(std::string_view query, std::string_view name);

}  // namespace insula::gateway
