// SPDX-License-Identifier: GPL-3.0-or-later
// The command lines of the commands for recorded sessions.
#include <memory>

#include "engine/command_line/common_options.h"
#include "engine/command_line/play.h"
#include "engine/command_line/sessions.h"

namespace insula {
namespace {

/// Options of one command; the callback keeps them.
template <class Options>
auto chooses(CommandLine& line, std::shared_ptr<Options> options, int (*run)(const CommandContext&, const Options&)) {
  return [&line, options = std::move(options), run] {
    line.chosen = [options, run](const CommandContext& context) { return run(context, *options); };
  };
}

constexpr const char* places_doc = "folder that has the scene's meshes; may be given several times";

void add_rerun(CommandLine& line) {
  auto o = std::make_shared<RerunOptions>();
  auto* command =
      line.app.add_subcommand("rerun", "the steps of a recorded session again, and whether their bits are the same");
  command->add_option("file", o->file, "session file")->required();
  command->add_option("--files", o->places, places_doc);
  command->add_option("--report", o->report, "folder for the report of its last pass through the exercise");
  add_threads(*command, o->threads);
  command->add_flag("--quiet", o->quiet, "print the result only");
  command->callback(chooses(line, o, cmd_rerun));
}

void add_score(CommandLine& line) {
  auto o = std::make_shared<ScoreOptions>();
  auto* command =
      line.app.add_subcommand("score", "recorded sessions by their rules and metrics, or by those of another scene");
  command->add_option("files", o->files, "session files")->required();
  command->add_option("--rules", o->rules, "scene whose rules and metrics are used (default: the recorded ones)");
  command->add_option("--files", o->places, places_doc);
  add_threads(*command, o->threads);
  command->add_flag("--json", o->json, "as JSON");
  command->callback(chooses(line, o, cmd_score));
}

void add_bands(CommandLine& line) {
  auto o = std::make_shared<BandsOptions>();
  auto* command =
      line.app.add_subcommand("bands", "how the metrics of groups of sessions lie, and which tell the groups apart");
  command->add_option("folder", o->folder, "folder that is searched for session files")->required();
  command->add_option("--group", o->group, "field that names a session's group: level, person, mode, motion, ...")
      ->required();
  command->add_option("--title", o->title, "title of the exercise (default: that of all sessions)");
  command->add_option("--pass", o->pass_group, "group whose values give the pass mark");
  command
      ->add_option("--pass-quantile", o->pass_share, "quantile of that group that is the pass mark (default: its mean)")
      ->check(CLI::Range(0.0, 1.0))
      ->needs("--pass");
  command->add_flag("--json", o->json, "as JSON");
  command->callback(chooses(line, o, cmd_bands));
}

void add_session(CommandLine& line) {
  auto* session = line.app.add_subcommand("session", "session files: what they contain, and removing them");
  session->require_subcommand(1);
  const auto add = [&](const char* name, const char* doc, int (*run)(const CommandContext&, const SessionOptions&)) {
    auto o = std::make_shared<SessionOptions>();
    auto* command = session->add_subcommand(name, doc);
    command->add_option("file", o->file, "session file")->required();
    command->add_flag("--json", o->json, "as JSON");
    command->callback(chooses(line, o, run));
  };
  add("info", "what it contains", cmd_session_info);
  add("verify", "read all of it, and list what is damaged", cmd_session_verify);

  auto e = std::make_shared<ExportOptions>();
  auto* exported = session->add_subcommand("export", "tables of hands, channels, metrics and events");
  exported->add_option("file", e->file, "session file")->required();
  exported->add_option("-o,--output", e->folder, "folder to write to")->required();
  exported->add_option("--format", e->format, "csv, json, parquet: one file for each table; lcm: a log of lcm-logger")
      ->check(CLI::IsMember({"csv", "json", "parquet", "lcm"}))
      ->capture_default_str();
  exported->callback(chooses(line, e, cmd_session_export));

  auto f = std::make_shared<ForgetOptions>();
  auto* forget = session->add_subcommand("forget", "remove all sessions and reports of a person");
  forget->add_option("person", f->person, "as given by --field person=NAME")->required();
  forget->add_option("--folder", f->folders,
                     "folder that is searched; may be given several times (default: those of play)");
  add_data(*forget, f->data);
  forget->add_flag("--list", f->list_only, "only list what would be removed");
  forget->callback([&line, f] {
    if (f->folders.empty()) f->folders = folders_of_play(f->data);
    line.chosen = [f](const CommandContext& context) { return cmd_session_forget(context, *f); };
  });
}

}  // namespace

void add_session_commands(CommandLine& line) {
  add_rerun(line);
  add_score(line);
  add_bands(line);
  add_session(line);
}

}  // namespace insula
