// SPDX-License-Identifier: GPL-3.0-or-later
// The program `insula`: one subcommand each for what can be done with scenes.
#include <CLI/CLI.hpp>

#include <functional>
#include <iostream>
#include <string_view>

#include "core/registry/plugin_loader.h"
#include "core/registry/registry.h"
#include "engine/command_line/case_command.h"
#include "engine/command_line/commands.h"
#include "engine/authoring/new_plugin.h"
#include "engine/command_line/play.h"
#include "engine/command_line/run.h"

namespace {

namespace fs = std::filesystem;

/// Built-in elements, then the installation's plugins, then those of --plugin-path. Exit status 2 on the first bad one.
int fill_registry(insula::Registry& registry, const std::vector<fs::path>& plugin_paths) {
  insula::register_builtin(registry);
  std::vector<fs::path> files = insula::plugin_files(insula::installed_plugin_folder());
  for (const auto& path : plugin_paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    const auto found = insula::plugin_files(path);
    files.insert(files.end(), found.begin(), found.end());
  }
  int status = 0;
  for (const auto& file : files) {
    const std::string error = insula::load_plugin(registry, file);
    if (error.empty()) continue;
    std::cerr << "error: " << error << '\n';
    status = 2;
  }
  return status;
}

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

  auto* check = app.add_subcommand("check", "read scenes and report everything that is wrong with them");
  check->add_option("scene", files, "scene files")->required();
  bool settle = false;
  check->add_flag("--settle", settle, "let scenes settle that do so first: slower, and tells what a step of them costs");
  check->callback([&] { run = [&](const auto& c) { return insula::cmd_check(c, files, settle); }; });

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

  insula::BenchOptions bench_options;
  auto* bench = app.add_subcommand("bench", "where the time of a step goes");
  insula::ScalingOptions scaling;
  bool scale = false;
  auto* bench_scene = bench->add_option("scene", bench_options.scene, "scene file");
  auto* scaling_flag = bench->add_flag("--scaling", scale, "without a scene: the stages against nodes, rows and strands, with their slopes; one thread unless --threads says otherwise")->excludes(bench_scene);
  bench->add_flag("--quick", scaling.quick, "with --scaling: small sizes only")->needs(scaling_flag);
  bench->add_option("--output", scaling.output, "with --scaling: folder for scaling.json and scaling.svg")->needs(scaling_flag);
  bench->add_option("--steps", bench_options.steps, "steps to measure")->check(CLI::PositiveNumber)->capture_default_str();
  bench->add_option("--from", bench_options.from, "simulated second at which measuring begins")->check(CLI::NonNegativeNumber);
  bench->add_option("--motion", bench_options.motion, "what the hands do: a motion of the exercise, a CSV file, or none")->capture_default_str();
  bench->add_option("--threads", bench_options.threads, "threads; 0 takes the machine's");
  bench->add_flag("--json", bench_options.json, "print JSON");
  bench->add_flag("--solvers", bench_options.solvers, "compare the solvers on the matrices and rows of the step at --from");
  bench->add_option("--rows", bench_options.rows, "with --solvers: so many rows of each body at most; 0 takes all")->check(CLI::NonNegativeNumber);
  auto* record = bench->add_option("--record", bench_options.record, "write the steps' constraint problems to this folder instead");
  bench->add_option("--every", bench_options.every, "with --record: a problem of so many is written")->check(CLI::PositiveNumber)->needs(record);
  bench->add_option("--problems", bench_options.problems, "solve this folder's constraint problems instead of stepping a scene")->excludes(bench_scene);
  insula::HapticBenchOptions haptics;
  bool measure_haptics = false;
  auto* haptics_flag = bench->add_flag("--haptics", measure_haptics, "how far the servo's force is from that of the engine stepped at 1 kHz, devices on the motion's path");
  bench->add_option("--rates", haptics.rates, "with --haptics: the engine's rates, Hz")->delimiter(',')->check(CLI::Range(20.0, 1000.0))->needs(haptics_flag);
  bench->add_option("--duration", haptics.duration, "with --haptics: simulated seconds; 0: the whole motion")->check(CLI::NonNegativeNumber)->needs(haptics_flag);
  bench->add_option("--latency", haptics.latency, "with --haptics: from poses to the problem's arrival, in steps (0.5) or as a time (3ms)")->capture_default_str()->needs(haptics_flag);
  bench->add_option("--jitter", haptics.jitter, "with --haptics: and so much later still at most, in steps")->check(CLI::Range(0.0, 3.0))->needs(haptics_flag);
  bench->add_flag("--fine", haptics.fine, "with --haptics: problems come at the rate, but from an engine that steps at 1 kHz: what is left is the servo's part of the error")->needs(haptics_flag);
  bench->add_flag("--ablation", haptics.ablation, "with --haptics: what goes beyond equation 7, one after the other")->needs(haptics_flag);
  bench->add_option("--traces", haptics.traces, "with --haptics: folder for the forces as CSV")->needs(haptics_flag);
  bench->callback([&] {
    if (scale) {
      scaling.threads = bench_options.threads > 0 ? bench_options.threads : 1;
      scaling.json = bench_options.json;
      run = [&](const auto& c) { return insula::cmd_bench_scaling(c, scaling); };
      return;
    }
    if (!bench_options.problems.empty()) {
      run = [&](const auto& c) { return insula::cmd_bench_problems(c, bench_options); };
      return;
    }
    if (bench_options.scene.empty()) throw CLI::RequiredError("scene (or --scaling)");
    if (measure_haptics) {
      haptics.scene = bench_options.scene;
      haptics.motion = bench_options.motion;
      haptics.threads = bench_options.threads;
      run = [&](const auto& c) { return insula::cmd_bench_haptics(c, haptics); };
      return;
    }
    if (!bench_options.record.empty()) {
      run = [&](const auto& c) { return insula::cmd_record_problems(c, bench_options); };
      return;
    }
    run = [&](const auto& c) { return bench_options.solvers ? insula::cmd_bench_solvers(c, bench_options) : insula::cmd_bench(c, bench_options); };
  });

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
  play->add_option("--host", play_options.hosts,
                   "a name under which other machines' pages may ask for the viewer; may be given several times");
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
  view->add_option("--host", play_options.hosts,
                   "a name under which other machines' pages may ask for the viewer; may be given several times");
  view->add_option("--duration", play_options.duration_s, "end after so many seconds; 0: never")->check(CLI::NonNegativeNumber);
  view->add_flag("--no-browser", no_browser, "open no browser");
  view->callback([&] {
    play_options.browser = !no_browser;
    play_options.view = true;
    play_options.motion = "none";
    play_options.plugin_paths = plugin_paths;
    run = [&](const auto& c) { return list_only ? insula::cmd_view_list(c, play_options.scene) : insula::cmd_play(c, play_options); };
  });

  // It reads what follows itself.
  if (argc > 1 && std::string_view(argv[1]) == "case") return insula::cmd_case({argv + 2, argv + argc}, std::cerr);
  app.add_subcommand("case", "training cases from surfaces and scans (see docs/making-a-case.md)");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int status = app.exit(e);
    return status == 0 ? 0 : 2;
  }
  try {
    insula::Registry registry;
    if (const int status = fill_registry(registry, plugin_paths)) return status;
    return run({registry, std::cout, std::cerr});
  } catch (const std::exception& e) {
    std::cerr << "error: " << e.what() << '\n';
    return 1;
  }
}
