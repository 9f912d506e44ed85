// SPDX-License-Identifier: GPL-3.0-or-later
// insula cases: what cases there are, and how they go to another installation.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"
#include "engine/command_line/run_command_line.h"

namespace insula {

struct CasesOptions {
  std::filesystem::path data;  ///< folder of the user's data; empty: the platform's
  bool json = false;
  std::string name;            ///< of a case
  std::filesystem::path file;  ///< archive, folder of a built case, folder of a page, or scene to be copied
  std::filesystem::path to;    ///< folder of a copy
  bool replace = false;        ///< an added case of the same name
};

/// Lists all cases. Status 0.
int cmd_cases(const CommandContext& context, const CasesOptions& options);
/// Packs a case of the list. Status 0; 2 if there is none of that name or it cannot be packed.
int cmd_cases_pack(const CommandContext& context, const CasesOptions& options);
/// Adds a packed case, or the folder of a built one. All of its scenes must load. Status 0; 2 if it is refused, and
/// then nothing has changed.
int cmd_cases_add(const CommandContext& context, const CasesOptions& options);
/// Copies a scene, or all scenes of a built case, with every file that they name, to a folder that is not there yet.
/// They need not load, since a copy is there to be edited. Status 0; 2 if that cannot be done.
int cmd_cases_copy(const CommandContext& context, const CasesOptions& options);
/// Begins a scene from nothing: FOLDER/NAME.xml, NAME that of the folder, with the shipped example meshes beside it, to
/// be edited. Status 0; 2 if the folder is there already or has no name of a case.
int cmd_cases_new(const CommandContext& context, const CasesOptions& options);
/// Removes an added case. Status 0; 2 if there is none of that name.
int cmd_cases_remove(const CommandContext& context, const CasesOptions& options);
/// Writes a page of all cases into a folder. Status 0; 2 if a case cannot be packed.
int cmd_cases_page(const CommandContext& context, const CasesOptions& options);

void add_case_commands(CommandLine& line);

}  // namespace insula
