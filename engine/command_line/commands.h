// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of the program `insula` that need no running simulation. Each returns the exit status: 0 success, 1 an
// error of the system (a file that cannot be written), 2 an error of the input.
#pragma once
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "core/registry/registry.h"

namespace insula {

struct CommandContext {
  const Registry& registry;
  std::ostream& out;
  std::ostream& err;
};

struct ListOptions {
  bool json = false, scenes = false;
  std::filesystem::path data;  ///< folder of the user's data; empty: the platform's
};
/// Lists all elements by kind, one line each, or all about them as JSON (engine/authoring/declarations_json.h). With
/// `scenes`, lists the exercises of the project and of added cases instead, as JSON: [{scene, group, title, text}].
int cmd_list(const CommandContext& context, const ListOptions& options = {});
/// Describes one element: its parents and its parameters.
int cmd_describe(const CommandContext& context, const std::string& element);
/// Writes the XML schema (XSD 1.0) for editors to a file, or to `out` if the path is empty or "-".
int cmd_schema(const CommandContext& context, const std::filesystem::path& file);
/// The same of curriculum files.
int cmd_curriculum_schema(const CommandContext& context, const std::filesystem::path& file);
/// Writes a Markdown page for each element a page of curricula and an index into a folder. With `plugin_folder`, pages
/// show the plugins' example.xml.
int cmd_docs(const CommandContext& context, const std::filesystem::path& folder,
             const std::filesystem::path& plugin_folder = {});

struct DevicesOptions {
  std::string show, calibrate, test_force;  ///< a device each; all empty: list
  std::string hand = "right";
  double seconds = 0, newtons = 1, scale = 1;
  bool assume_yes = false;
};
/// Lists connected devices and what others need; shows a device live, calibrates it, or tests its force.
int cmd_devices(const CommandContext& context, const DevicesOptions& options);

}  // namespace insula
