// SPDX-License-Identifier: GPL-3.0-or-later
// The command lines of the commands for cases.
#include <memory>

#include "engine/command_line/cases.h"
#include "engine/command_line/common_options.h"

namespace insula {

void add_case_commands(CommandLine& line) {
  auto* cases = line.app.add_subcommand("cases", "the cases of this installation, and how they go to another one");
  const auto o = std::make_shared<CasesOptions>();
  const auto runs = [&line, o](int (*run)(const CommandContext&, const CasesOptions&)) {
    return [&line, o, run] { line.chosen = [o, run](const CommandContext& context) { return run(context, *o); }; };
  };
  add_data(*cases, o->data);
  cases->add_flag("--json", o->json, "all about them, as JSON");
  cases->require_subcommand(0, 1);
  const auto add = [&](const char* name, const char* doc, int (*run)(const CommandContext&, const CasesOptions&)) {
    auto* command = cases->add_subcommand(name, doc);
    add_data(*command, o->data);
    command->callback(runs(run));
    return command;
  };
  auto* pack = add("pack", "write a case as one file, with all that its exercises need", cmd_cases_pack);
  pack->add_option("name", o->name, "of the case")->required();
  pack->add_option("-o,--output", o->file, "the file (default: NAME.zip)");
  auto* added = add("add", "add a case that was packed or built; it then stands on the start page", cmd_cases_add);
  added->add_option("file", o->file, "NAME.zip, or the folder that insula case made")
      ->required()
      ->check(CLI::ExistingPath);
  added->add_flag("--replace", o->replace, "in place of an added case of the same name");
  auto* copy = add("copy", "copy a scene or a built case with all that it needs, to be edited", cmd_cases_copy);
  copy->add_option("file", o->file, "the scene, or the folder that insula case made")
      ->required()
      ->check(CLI::ExistingPath);
  copy->add_option("folder", o->to, "to be made; its name is that of the copy")->required();
  auto* begun = add("new", "begin a scene from nothing, with example meshes beside it", cmd_cases_new);
  begun->add_option("folder", o->to, "to be made; its name is that of the scene")->required();
  add("remove", "remove a case that was added", cmd_cases_remove)
      ->add_option("name", o->name, "of the case")
      ->required();
  add("page", "a page of all cases for a web server: index.html, pictures and packed cases", cmd_cases_page)
      ->add_option("folder", o->file, "to write to")
      ->required();
  cases->callback([&line, cases, o] {
    if (cases->get_subcommands().empty())
      line.chosen = [o](const CommandContext& context) { return cmd_cases(context, *o); };
  });
}

}  // namespace insula
