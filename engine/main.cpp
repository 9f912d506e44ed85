// SPDX-License-Identifier: GPL-3.0-or-later
// The program `insula`: one subcommand each for what can be done with scenes.
#include <CLI/CLI.hpp>

#include <functional>
#include <iostream>
#include <string_view>

#include "core/registry/registry.h"
#include "engine/command_line/commands.h"
#include "engine/command_line/load_plugins.h"
#include "engine/authoring/new_plugin.h"
#include "engine/command_line/play.h"
#include "engine/command_line/run.h"
#include "engine/command_line/tool_program.h"

namespace {

namespace fs = std::filesystem;

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Insula: aneurysm surgery with two-handed haptics", "insula"};
  app.require_subcommand(1);
  std::vector<fs::path> plugin_paths;
  app.add_option("--plugin-path", plugin_paths, "folder of shared plugins, or one plugin (may be given more than once)")
      ->allow_extra_args(false);

  std::vector<fs::path> files;
  std::string element;
  fs::path output, folder, plugin_folder;
  std::function<int(const insula::CommandContext&)> run;

  auto* list = app.add_subcommand("list", "all elements a scene may hold");
  list->callback([&] { run = [](const auto& c) { return insula::cmd_list(c); }; });

  auto* describe = app.add_subcommand("describe", "one element and its parameters");
  describe->add_option("name", element, "element name")->required();
  describe->callback([&] { run = [&](const auto& c) { return insula::cmd_describe(c, element); }; });

  auto* schema = app.add_subcommand("schema", "XML schema of scene files, for editors");
  schema->add_option("-o,--output,file", output, "file to write (default: standard output)");
  schema->callback([&] { run = [&](const auto& c) { return insula::cmd_schema(c, output); }; });

  auto* docs = app.add_subcommand("docs", "reference pages of all elements, in Markdown");
  docs->add_option("-o,--output,folder", folder, "folder to write to")->required();
  docs->add_option("--plugins", plugin_folder, "folder of plugin sources, for their examples");
  docs->callback([&] { run = [&](const auto& c) { return insula::cmd_docs(c, folder, plugin_folder); }; });

  insula::NewPluginOptions plugin_options;
  auto* new_plugin = app.add_subcommand("new-plugin", "begin a plugin: a folder with source, test, example and build file");
  new_plugin->add_option("name", plugin_options.name, "its name, and that of its element: small letters, digits, _")->required();
  new_plugin->add_option("--kind", plugin_options.kind, "what it is: constraint, force, instrument or exercise")->required();
  new_plugin->add_option("--folder", plugin_options.folder, "folder to be made (default: the name)");
  new_plugin->callback([&] { run = [&](const auto& c) { return insula::cmd_new_plugin(c, plugin_options); }; });

  insula::DevicesOptions devices_options;
  auto* devices = app.add_subcommand("devices", "what there is for the hands, what is missing and how to get it");
  auto* show_one = devices->add_option("--show", devices_options.show, "this device's live pose, buttons and force, until Ctrl-C");
  auto* calibrate_one = devices->add_option("--calibrate", devices_options.calibrate, "ask for this device's rest pose and axes and keep them")->excludes(show_one);
  devices->add_option("--test-force", devices_options.test_force, "let this device push gently along each axis")->excludes(show_one)->excludes(calibrate_one);
  devices->add_option("--hand", devices_options.hand, "hand that it serves")->check(CLI::IsMember({"left", "right"}))->capture_default_str();
  devices->add_option("--duration", devices_options.seconds, "with --show: end after so many seconds; 0: never")->check(CLI::NonNegativeNumber);
  devices->add_option("--newtons", devices_options.newtons, "with --test-force: largest force")->check(CLI::Range(0.1, 3.0))->capture_default_str();
  devices->add_option("--scale", devices_options.scale, "with --calibrate: movement of the tool over movement of the hand")->check(CLI::Range(0.05, 5.0))->capture_default_str();
  devices->add_flag("--yes", devices_options.assume_yes, "with --test-force: begin without asking");
  devices->callback([&] { run = [&](const auto& c) { return insula::cmd_devices(c, devices_options); }; });

  // --- commands that run a simulation ---
  insula::RunOptions run_options;
  auto* headless = app.add_subcommand("run", "a scene from start to end without devices or viewer, with a report");
  headless->add_option("scene", run_options.scene, "scene file")->required();
  headless->add_option("--duration", run_options.duration, "simulated seconds (default: the motion and one second more)")->check(CLI::NonNegativeNumber);
  headless->add_option("--motion", run_options.motion, "what the hands do: a motion of the exercise, a CSV file, or none");
  headless->add_option("--report", run_options.report, "folder for report.json and report.html");
  headless->add_option("--export", run_options.export_folder, "folder for the bodies' final nodes as .vtu");
  headless->add_option("--threads", run_options.threads, "threads; 0 takes the machine's");
  headless->add_option("--seed", run_options.seed, "what complications are drawn from; 0: the scene's own seed");
  headless->add_flag("--quiet", run_options.quiet, "print the last line only");
  headless->callback([&] { run = [&](const auto& c) { return insula::cmd_run(c, run_options); }; });

  insula::EngineOptions engine_options;
  auto* engine = app.add_subcommand("engine", "the engine process of a session, over the bus");
  engine->add_option("scene", engine_options.scene, "scene file")->required();
  engine->add_option("--motion", engine_options.motion, "what simulated hands follow")->capture_default_str();
  engine->add_option("--bundle-dir", engine_options.bundle_root, "folder for the viewer's scene bundles");
  engine->add_option("--duration", engine_options.duration, "end after so many simulated seconds; 0: never")->check(CLI::NonNegativeNumber);
  engine->add_flag("--unthrottled", engine_options.unthrottled, "as fast as the machine can, for measurements");
  engine->add_option("--threads", engine_options.threads, "threads; 0 takes the machine's");
  engine->add_option("--seed", engine_options.seed, "what complications are drawn from; 0: the scene's own seed");
  engine->add_flag("--still", engine_options.still, "to be looked at: time never runs");
  engine->add_flag("--standby", engine_options.standby, "load, say so, and wait for SIGUSR1 before speaking on the bus");
  engine->add_option("--notice", engine_options.notice, "file whose text viewers are shown while it is not empty");
  engine->add_option("--report", engine_options.report, "folder for reports of the session, each in a folder of its own named by date and time");
  engine->add_flag("--keep-bundle", engine_options.keep_bundle, "leave the bundle where it is at the end, for a replay");
  engine->callback([&] { run = [&](const auto& c) { return insula::cmd_engine(c, engine_options); }; });

  insula::ReplayOptions replay_options;
  auto* replay = app.add_subcommand("replay", "a log of lcm-logger onto the bus, for viewers");
  replay->add_option("log", replay_options.log, "log of a session")->required();
  replay->add_option("--speed", replay_options.speed, "times as fast as it was")->check(CLI::Range(0.01, 1000.0))->capture_default_str();
  replay->add_flag("--loop", replay_options.loop, "again and again, until Ctrl-C");
  replay->callback([&] { run = [&](const auto& c) { return insula::cmd_replay(c, replay_options); }; });

  insula::PlayOptions play_options;
  bool no_browser = false;
  auto* play = app.add_subcommand("play", "engine, haptic server and viewer together, until Ctrl-C");
  play->add_option("scene", play_options.scene, "scene file (default: the first training exercise)");
  play->add_option("--motion", play_options.motion, "what simulated hands follow: a motion of the scene, a CSV file, or none");
  play->add_option("--left", play_options.left, "device of the left hand, such as touch:\"Left Device\" (see insula devices); default: the scene's, else simulated");
  play->add_option("--right", play_options.right, "device of the right hand");
  play->add_option("--port", play_options.port, "port of the viewer; following ones are tried when it is busy")->capture_default_str();
  play->add_option("--listen", play_options.listen, "address of the viewer; 0.0.0.0 lets other machines watch")->capture_default_str();
  play->add_option("--host", play_options.hosts, "a name under which other machines' pages may ask for the viewer; may be given several times");
  play->add_option("--duration", play_options.duration_s, "end after so many seconds; 0: never")->check(CLI::NonNegativeNumber);
  play->add_option("--seed", play_options.seed, "what complications are drawn from; 0: the scene's own seed");
  play->add_option("--keep-bundle", play_options.keep_bundle, "folder in which the viewer's scene bundles stay, for a replay of a log");
  play->add_option("--report", play_options.report, "folder for reports of the session, each in a folder of its own named by date and time");
  play->add_flag("--no-browser", no_browser, "open no browser");
  bool no_reload = false;
  play->add_flag("--no-reload", no_reload, "do not load the scene again when one of its files is saved");
  play->callback([&] {
    play_options.browser = !no_browser;
    play_options.reload = !no_reload;
    play_options.plugin_paths = plugin_paths;
    run = [&](const auto& c) { return insula::cmd_play(c, play_options); };
  });

  bool list_only = false;
  auto* view = app.add_subcommand("view", "a scene to be looked at: what is in it by name, with units and sizes; time stands still");
  view->add_option("scene", play_options.scene, "scene file")->required();
  view->add_flag("--list", list_only, "print what is in it and end");
  view->add_option("--port", play_options.port, "port of the viewer; following ones are tried when it is busy")->capture_default_str();
  view->add_option("--listen", play_options.listen, "address of the viewer; 0.0.0.0 lets other machines watch")->capture_default_str();
  view->add_option("--host", play_options.hosts, "a name under which other machines' pages may ask for the viewer; may be given several times");
  view->add_option("--duration", play_options.duration_s, "end after so many seconds; 0: never")->check(CLI::NonNegativeNumber);
  view->add_flag("--no-browser", no_browser, "open no browser");
  view->callback([&] {
    play_options.browser = !no_browser;
    play_options.view = true;
    play_options.motion = "none";
    play_options.plugin_paths = plugin_paths;
    run = [&](const auto& c) { return list_only ? insula::cmd_view_list(c, play_options.scene) : insula::cmd_play(c, play_options); };
  });

  // Programs of their own, which read what follows themselves.
  struct ToolProgram {
    const char *command, *doc, *program, *when_missing;
  };
  const ToolProgram tools[] = {
      {"check", "read scenes and report everything that is wrong with them, and what a step of them costs", "insula_workbench", "Build it: ./insula build."},
      {"bench", "where the time of a step goes", "insula_workbench", "Build it: ./insula build."},
      {"case", "training cases from surfaces and scans (see docs/making-a-case.md)", "insula_case",
       "The case builder needs CGAL (Debian: libcgal-dev), and ITK for volumes (libinsighttoolkit5-dev). Install them, then build again."}};
  for (const ToolProgram& tool : tools) {
    auto* command = app.add_subcommand(tool.command, tool.doc)->prefix_command();
    command->set_help_flag();
    command->callback([&, command] {
      std::vector<std::string> words;
      for (const fs::path& path : plugin_paths) words.insert(words.end(), {"--plugin-path", path.string()});
      if (std::string_view(tool.program) != "insula_case") words.emplace_back(tool.command);
      for (const std::string& word : command->remaining()) words.push_back(word);
      run = [&tool, words](const auto& c) { return insula::run_tool_program(tool.program, words, tool.when_missing, c.err); };
    });
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int status = app.exit(e);
    return status == 0 ? 0 : 2;
  }
  try {
    insula::Registry registry;
    if (const int status = insula::load_plugins(registry, plugin_paths, std::cerr)) return status;
    return run({registry, std::cout, std::cerr});
  } catch (const std::exception& e) {
    std::cerr << "error: " << e.what() << '\n';
    return 1;
  }
}
