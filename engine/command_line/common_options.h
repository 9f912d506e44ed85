// SPDX-License-Identifier: GPL-3.0-or-later
// Options shared by several commands.
#pragma once
#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/input_error.h"
#include "core/params/option.h"
#include "engine/command_line/record_store_options.h"
#include "engine/live/project_folder.h"
#include "engine/live/step_rate.h"
#include "engine/session/session_format.h"
#include "engine/sharing/scene_names.h"

namespace insula {

/// Checks a whole number that is at least `least`.
inline auto at_least(int least) {
  return CLI::Validator([least](std::string& text) { return below(text, least); }, "", "at least");
}

inline QuantityOption seconds(std::string doc) { return {.bare = "s", .min = "0 s", .doc = std::move(doc)}; }

/// An option that takes a scene: its file, or the name of one of the project or of an added case.
template <class Value>
CLI::Option* add_scene(CLI::App& command, const std::string& name, Value& value, const std::string& doc) {
  const auto all = [] {
    std::vector<NamedScene> scenes = shipped_scenes(project_folder());
    for (NamedScene& added : added_scenes({})) scenes.push_back(std::move(added));
    return scenes;
  };
  const auto file_of = [all](std::string& text) {
    try {
      text = scene_called(text, all).string();
      return std::string();
    } catch (const InputError& e) {
      return std::string(e.what());
    }
  };
  return command.add_option(name, value, doc)->transform(CLI::Validator(file_of, ""));
}

inline void add_seed(CLI::App& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "what complications are drawn from; 0: the scene's own seed");
}

inline void add_bands(CLI::App& command, std::filesystem::path& file, std::string& group) {
  command
      .add_option(
          "--bands", file,
          "file of insula bands --json, by which the report says where the run lies (default: NAME_bands.json beside "
          "the scene)")
      ->check(CLI::ExistingFile);
  command.add_option("--band-group", group, "group whose bands they are (default: the only one)")->needs("--bands");
}

inline void add_fields(CLI::App& command, std::vector<std::string>& fields) {
  command
      .add_option("--field", fields,
                  "NAME=VALUE, kept in the recording, such as person=P07 or level=expert; may be given several times")
      ->check([](const std::string& text) {
        try {
          session::parse_field(text);
          return std::string();
        } catch (const InputError& e) {
          return std::string(e.what());
        }
      });
}

inline void add_data(CLI::App& command, std::filesystem::path& folder) {
  command.add_option("--data", folder,
                     "folder of the user's data: recordings, persons and their runs (default: insula in the "
                     "platform's folder for it)");
}

/// prefix: of the names of the options beside --lrs.
inline void add_record_store(CLI::App& command, RecordStoreOptions& o, const std::string& prefix) {
  command.add_option("--lrs", o.lrs, "address of the learning record store that is told what persons do");
  command
      .add_option("--" + prefix + "login", o.login,
                  "file with its NAME:PASSWORD, which nobody else may read (default: INSULA_LRS_USER and "
                  "INSULA_LRS_PASSWORD of the environment)")
      ->needs("--lrs");
  command
      .add_option("--" + prefix + "ca", o.authorities,
                  "PEM file of the certificates that it must descend from (default: those that this machine trusts)")
      ->needs("--lrs");
}

/// choice: "auto" is allowed.
inline void add_rate(CLI::App& command, std::string& rate, bool choice) {
  const std::string doc = choice ? "steps a second of the engine, or auto: the highest that this machine keeps "
                                   "(default: the scene's)"
                                 : "steps a second (default: the scene's)";
  command.add_option("--rate", rate, doc)
      ->type_name(choice ? "QUANTITY:{auto}" : "QUANTITY")
      ->check([choice](const std::string& text) {
        try {
          return read_step_rate(text).automatic && !choice ? std::string("auto is for live sessions") : std::string();
        } catch (const InputError& e) {
          return std::string(e.what());
        }
      });
}

inline void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads; 0 takes the machine's")->check(at_least(0));
}

inline void add_motion(CLI::App& command, std::string& motion) {
  command.add_option("--motion", motion, "what the hands do: a motion of the exercise, a CSV file, or none");
}

}  // namespace insula
