// SPDX-License-Identifier: GPL-3.0-or-later
// The program `insula`: one subcommand each for what can be done with scenes.
#include <CLI/CLI.hpp>

#include <string_view>

#include "core/params/option.h"
#include "engine/authoring/new_plugin.h"
#include "engine/command_line/cases.h"
#include "engine/command_line/commands.h"
#include "engine/command_line/common_options.h"
#include "engine/command_line/doctor.h"
#include "engine/command_line/people.h"
#include "engine/command_line/play.h"
#include "engine/command_line/room_command.h"
#include "engine/command_line/run.h"
#include "engine/command_line/run_command_line.h"
#include "engine/command_line/sessions.h"
#include "engine/command_line/studio_command.h"
#include "engine/command_line/study_command.h"
#include "engine/command_line/tool_program.h"
#include "training/store/data_folder.h"

namespace {

namespace fs = std::filesystem;

using insula::add_motion;
using insula::add_rate;
using insula::add_seed;
using insula::add_threads;
using insula::Duration;
using insula::Force;
using insula::seconds;

/// What the options of all commands are read into, and the command that was chosen.
struct Options : insula::CommandLine {
  Options() : CommandLine("Insula: aneurysm surgery with two-handed haptics", "insula") {}

  std::string element;
  fs::path output, folder, plugin_folder;
  std::vector<fs::path> scenes;
  bool json = false, curriculum = false, no_browser = false, no_reload = false, no_report = false, no_record = false,
       list_only = false;
  insula::ListOptions list;
  insula::NewPluginOptions new_plugin;
  insula::DevicesOptions devices;
  insula::RunOptions run;
  insula::EngineOptions engine;
  insula::ReplayOptions replay;
  insula::PlayOptions play;
};

/// list, describe, schema, docs: what needs no simulation.
void add_scene_commands(Options& c) {
  auto* list = c.app.add_subcommand("list", "all elements a scene may hold");
  list->add_flag("--json", c.list.json, "all about them, as JSON");
  list->add_flag("--scenes", c.list.scenes, "the exercises instead, as JSON");
  insula::add_data(*list, c.list.data);
  list->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_list(x, c.list); }; });

  auto* describe = c.app.add_subcommand("describe", "one element and its parameters");
  describe->add_option("name", c.element, "element name")->required();
  describe->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_describe(x, c.element); }; });

  auto* schema = c.app.add_subcommand("schema", "XML schema of scene files, for editors");
  schema->add_option("-o,--output,file", c.output, "file to write (default: standard output)");
  schema->add_flag("--curriculum", c.curriculum, "of curriculum files instead");
  schema->callback([&c] {
    c.chosen = [&](const auto& x) {
      return c.curriculum ? insula::cmd_curriculum_schema(x, c.output) : insula::cmd_schema(x, c.output);
    };
  });

  auto* docs = c.app.add_subcommand("docs", "reference pages of all elements, in Markdown");
  docs->add_option("-o,--output,folder", c.folder, "folder to write to")->required();
  docs->add_option("--plugins", c.plugin_folder, "folder of plugin sources, for their examples");
  docs->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_docs(x, c.folder, c.plugin_folder); }; });
}

void add_texts(Options& c) {
  auto* command =
      c.app.add_subcommand("texts", "what persons read of scenes and curricula, as JSON, for those who translate it");
  insula::add_scene(*command, "file", c.scenes, "scenes and curricula")->required();
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_texts(x, c.scenes); }; });
}

void add_new_plugin(Options& c) {
  auto& o = c.new_plugin;
  auto* command =
      c.app.add_subcommand("new-plugin", "begin a plugin: a folder with source, test, example and build file");
  command->add_option("name", o.name, "its name, and that of its element: small letters, digits, _")->required();
  command->add_option("--kind", o.kind, "what it is: " + insula::plugin_kinds())->required();
  command->add_option("--folder", o.folder, "folder to be made (default: the name)");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_new_plugin(x, c.new_plugin); }; });
}

void add_devices(Options& c) {
  auto& o = c.devices;
  auto* command = c.app.add_subcommand("devices", "what there is for the hands, what is missing and how to get it");
  auto* show = command->add_option("--show", o.show, "this device's live pose, buttons and force, until Ctrl-C");
  auto* calibrate =
      command->add_option("--calibrate", o.calibrate, "ask for this device's rest pose and axes and keep them");
  calibrate->excludes(show);
  auto* test = command->add_option("--test-force", o.test_force, "let this device push gently along each axis");
  test->excludes(show)->excludes(calibrate);
  command->add_option("--hand", o.hand, "hand that it serves")
      ->check(CLI::IsMember({"left", "right"}))
      ->capture_default_str();
  insula::add_quantity<Duration>(*command, "--duration", o.seconds,
                                 seconds("with --show: end after this time; 0: never"));
  insula::add_quantity<Force>(*command, "--newtons", o.newtons,
                              {.bare = "N", .min = "0.1 N", .max = "3 N", .doc = "with --test-force: largest force"})
      ->default_str("1 N");
  command->add_option("--scale", o.scale, "with --calibrate: movement of the tool over movement of the hand")
      ->check(CLI::Range(0.05, 5.0))
      ->capture_default_str();
  command->add_flag("--yes", o.assume_yes, "with --test-force: begin without asking");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_devices(x, c.devices); }; });
}

void add_doctor(Options& c) {
  auto* command = c.app.add_subcommand("doctor", "what this machine lacks for the program, and how to get it");
  command->add_flag("--json", c.json, "as JSON");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_doctor(x, c.json); }; });
}

void add_run(Options& c) {
  auto& o = c.run;
  auto* command = c.app.add_subcommand("run", "a scene from start to end without devices or viewer, with a report");
  insula::add_scene(*command, "scene", o.scene, "file or name of a scene")->required();
  insula::add_quantity<Duration>(*command, "--duration", o.duration,
                                 seconds("simulated time (default: the motion and one second more)"));
  add_motion(*command, o.motion);
  add_rate(*command, o.rate, false);
  command->add_option("--report", o.report, "folder for report.json and report.html");
  command->add_option("--export", o.export_folder, "folder for the bodies' final nodes as .vtu");
  command->add_option("--record", o.record, "session file to record into, usually NAME.insula");
  insula::add_fields(*command, o.fields);
  insula::add_bands(*command, o.bands, o.band_group);
  add_threads(*command, o.threads);
  add_seed(*command, o.seed);
  command->add_flag("--quiet", o.quiet, "print the last line only");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_run(x, c.run); }; });
}

void add_engine(Options& c) {
  auto& o = c.engine;
  auto* command = c.app.add_subcommand("engine", "the engine process of a session, over the bus");
  insula::add_scene(*command, "scene", o.scene, "file or name of a scene")->required();
  command->add_option("--motion", o.motion, "what simulated hands follow")->capture_default_str();
  command->add_option("--bundle-dir", o.bundle_root, "folder for the viewer's scene bundles");
  insula::add_quantity<Duration>(*command, "--duration", o.duration,
                                 seconds("end after this simulated time; 0: never"));
  add_rate(*command, o.rate, true);
  command->add_flag("--unthrottled", o.unthrottled, "as fast as the machine can, for measurements");
  add_threads(*command, o.threads);
  add_seed(*command, o.seed);
  command->add_flag("--still", o.still, "to be looked at: time never runs");
  command->add_flag("--standby", o.standby, "load, say so, and wait for SIGUSR1 before speaking on the bus");
  command->add_option("--notice", o.notice, "file whose text viewers are shown while it is not empty");
  command->add_option("--report", o.report,
                      "folder for reports of the session, each in a folder of its own named by date and time");
  command->add_option("--store", o.store, "training store that keeps the runs of the session's reports");
  command->add_option("--record", o.record, "session file to record into (NAME.insula), or a folder for a new one");
  insula::add_fields(*command, o.fields);
  insula::add_bands(*command, o.bands, o.band_group);
  command->add_option("--mode", o.mode, "how the session begins (default: a demonstration if there is a motion)")
      ->check(CLI::IsMember({"waiting", "demonstration", "practice", "test"}));
  command->add_flag("--keep-bundle", o.keep_bundle, "leave the bundle where it is at the end, for a replay");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_engine(x, c.engine); }; });
}

void add_replay(Options& c) {
  auto& o = c.replay;
  auto* command = c.app.add_subcommand("replay", "recorded sessions on a page, or a log of lcm-logger onto the bus");
  command->add_option("files", o.files, "recorded sessions (NAME.insula), or one log of lcm-logger")->required();
  command->add_option("--port", o.port, "of the page; following ones are tried if it is busy")->capture_default_str();
  command->add_option("--speed", o.speed, "of a log: times as fast as it was")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command->add_flag("--loop", o.loop, "of a log: again and again, until Ctrl-C");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_replay(x, c.replay); }; });
}

/// What play and view share.
void add_viewer_options(CLI::App& command, Options& c) {
  auto& o = c.play;
  command.add_option("--port", o.port, "port of the viewer; following ones are tried when it is busy")
      ->capture_default_str();
  command.add_option("--listen", o.listen, "address of the viewer; 0.0.0.0 lets other machines watch")
      ->capture_default_str();
  command.add_option("--host", o.hosts,
                     "a name under which other machines' pages may ask for the viewer; may be given several times");
  insula::add_quantity<Duration>(command, "--duration", o.duration_s, seconds("end after this time; 0: never"));
  command.add_flag("--no-browser", c.no_browser, "open no browser");
}

void add_play(Options& c) {
  auto& o = c.play;
  auto* command = c.app.add_subcommand("play", "engine, haptic server and viewer together, until Ctrl-C");
  insula::add_scene(*command, "scene", o.scene, "file or name of a scene (default: the first training exercise)");
  insula::add_room_options(*command, o.room);
  command->add_option("--motion", o.motion, "what simulated hands follow: a motion of the scene, a CSV file, or none");
  command->add_option(
      "--left", o.left,
      "device of the left hand, such as touch:\"Left Device\" (see insula devices); default: the scene's, else "
      "simulated");
  command->add_option("--right", o.right, "device of the right hand");
  add_viewer_options(*command, c);
  add_rate(*command, o.rate, true);
  add_seed(*command, o.seed);
  command->add_option("--keep-bundle", o.keep_bundle,
                      "folder in which the viewer's scene bundles stay, for a replay of a log");
  command->add_option("--mode", o.mode, "begin at once in this mode (default: chosen on the page)")
      ->check(CLI::IsMember({"demonstration", "practice", "test"}));
  insula::add_data(*command, o.data);
  insula::add_record_store(*command, o.records, "lrs-");
  command->add_option("--report", o.report,
                      "folder for reports of the session, each in a folder of its own named by date and time (default: "
                      "insula-reports in the home folder, or reports in the folder of --data)");
  command->add_flag("--no-report", c.no_report, "write no reports");
  command->add_option(
      "--record", o.record,
      "session file to record into (NAME.insula), or a folder for a new one (default: insula/sessions in "
      "the user's data folder)");
  command->add_flag("--no-record", c.no_record, "record nothing");
  insula::add_fields(*command, o.fields);
  insula::add_bands(*command, o.bands, o.band_group);
  command->add_flag("--no-reload", c.no_reload, "do not load the scene again when one of its files is saved");
  command->callback([&c, &o] {
    o.browser = !c.no_browser;
    o.reload = !c.no_reload;
    const insula::training::DataFolder data = insula::training::data_folder(o.data);
    if (c.no_report) o.report.clear();
    else if (o.report.empty()) o.report = insula::default_report_folder(o.data);
    if (c.no_record) o.record.clear();
    else if (o.record.empty()) o.record = data.sessions();
    if (!o.report.empty()) o.store = data.store();
    o.plugin_paths = c.plugin_paths;
    c.chosen = [&o](const auto& x) { return insula::cmd_play(x, o); };
  });
}

void add_view(Options& c) {
  auto* command = c.app.add_subcommand(
      "view", "a scene to be looked at: what is in it by name, with units and sizes; time stands still");
  insula::add_scene(*command, "scene", c.play.scene, "file or name of a scene")->required();
  command->add_flag("--list", c.list_only, "print what is in it and end");
  add_viewer_options(*command, c);
  command->callback([&c] {
    c.play.browser = !c.no_browser;
    c.play.view = true;
    c.play.motion = "none";
    c.play.plugin_paths = c.plugin_paths;
    c.chosen = [&](const auto& x) {
      return c.list_only ? insula::cmd_view_list(x, c.play.scene) : insula::cmd_play(x, c.play);
    };
  });
}

/// Programs of their own, which read what follows themselves.
void add_tool_programs(Options& c) {
  struct ToolProgram {
    const char *command, *doc, *program, *when_missing;
  };
  static const ToolProgram tools[] = {
      {"check",
       "read scenes and curricula and report everything that is wrong with them, and what a step of a scene costs",
       "insula_workbench", "Build it: ./insula build."},
      {"bench", "where the time of a step goes", "insula_workbench", "Build it: ./insula build."},
      {"case", "training cases from surfaces and scans (see docs/making-a-case.md)", "insula_case",
       "The case builder needs CGAL (Debian: libcgal-dev), and ITK for volumes (libinsighttoolkit5-dev). Install them, "
       "then build again."}};
  for (const ToolProgram& tool : tools) {
    auto* command = c.app.add_subcommand(tool.command, tool.doc)->prefix_command();
    command->set_help_flag();
    command->callback([&c, &tool, command] {
      std::vector<std::string> words;
      for (const fs::path& path : c.plugin_paths) words.insert(words.end(), {"--plugin-path", path.string()});
      if (std::string_view(tool.program) != "insula_case") words.emplace_back(tool.command);
      for (const std::string& word : command->remaining()) words.push_back(word);
      c.chosen = [&tool, words](const auto& x) {
        return insula::run_tool_program(tool.program, words, tool.when_missing, x.err);
      };
    });
  }
}

void add_commands(Options& c) {
  add_scene_commands(c);
  add_texts(c);
  add_new_plugin(c);
  add_devices(c);
  add_doctor(c);
  add_run(c);
  add_engine(c);
  insula::add_session_commands(c);
  insula::add_people_commands(c);
  insula::add_case_commands(c);
  add_replay(c);
  add_play(c);
  add_view(c);
  insula::add_room_command(c);
  insula::add_studio_command(c);
  insula::add_study_command(c);
  add_tool_programs(c);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  add_commands(options);
  return insula::run_command_line(options, argc, argv);
}
