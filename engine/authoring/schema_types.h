// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of an XML Schema 1.0 that come from the declarations of parameters. The schemas of scenes and of curricula
// are made of them.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/params/param.h"
#include "engine/command_line/commands.h"

namespace insula {

inline constexpr std::string_view schema_head =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">\n";
inline constexpr std::string_view schema_promise =
    "A value that uses a variable ($name) is accepted as it stands; `insula check` checks more.";

std::string schema_annotation(std::string_view text, std::string_view indent);
/// "in_force_model": prefix and name, with "_" for blanks.
std::string schema_type_id(std::string_view prefix, std::string_view name);
/// The elements <include> and <variable>.
std::string schema_preprocessing();

class SchemaTypes {
 public:
  /// The attribute of a parameter. Its simple type becomes part of text().
  std::string attribute(const ParamBase& p);
  /// All simple types that attributes have used, and those of ids.
  std::string text();

 private:
  /// Registers a simple type on first use and returns its name.
  std::string simple_type(const ParamBase& p);

  std::map<std::string, std::string> simple_types_;  ///< pattern by name
};

/// Writes a schema to a file, or to `out` if the path is empty or "-". Returns the exit status.
int write_schema(const CommandContext& context, const std::string& text, const std::filesystem::path& file);

}  // namespace insula
