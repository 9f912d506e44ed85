// SPDX-License-Identifier: GPL-3.0-or-later
// The program `insula`: one subcommand each for what can be done with scenes.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <iostream>
#include <string_view>

#include "core/params/option.h"
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

using insula::CommandContext;
using insula::Duration;
using insula::Force;
using insula::Frequency;
using insula::QuantityOption;

/// What the options of all commands are read into, and the command that was chosen.
struct CommandLine {
  CLI::App app{"Insula: aneurysm surgery with two-handed haptics", "insula"};
  std::vector<fs::path> plugin_paths, files;
  std::string element;
  fs::path output, folder, plugin_folder;
  bool settle = false, measure_scaling = false, measure_haptics = false;
  bool no_browser = false, no_reload = false, list_only = false;
  insula::NewPluginOptions new_plugin;
  insula::DevicesOptions devices;
  insula::RunOptions run;
  insula::BenchOptions bench;
  insula::ScalingOptions scaling;
  insula::HapticBenchOptions haptics;
  insula::EngineOptions engine;
  insula::ReplayOptions replay;
  insula::PlayOptions play;
  std::function<int(const CommandContext&)> chosen;
};

/// Checks a whole number that is at least `least`.
auto at_least(int least) {
  return CLI::Validator([least](std::string& text) { return insula::below(text, least); }, "", "at least");
}

QuantityOption seconds(std::string doc) { return {.bare = "s", .min = "0 s", .doc = std::move(doc)}; }

void add_seed(CLI::App& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "what complications are drawn from; 0: the scene's own seed");
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads; 0 takes the machine's")->check(at_least(0));
}

void add_motion(CLI::App& command, std::string& motion) {
  command.add_option("--motion", motion, "what the hands do: a motion of the exercise, a CSV file, or none");
}

/// check, list, describe, schema, docs: what needs no simulation.
void add_scene_commands(CommandLine& c) {
  auto* check = c.app.add_subcommand("check", "read scenes and report everything that is wrong with them");
  check->add_option("scene", c.files, "scene files")->required();
  check->add_flag("--settle", c.settle, "let scenes settle that do so first: slower, and tells what a step of them costs");
  check->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_check(x, c.files, c.settle); }; });

  auto* list = c.app.add_subcommand("list", "all elements a scene may hold");
  list->callback([&c] { c.chosen = [](const auto& x) { return insula::cmd_list(x); }; });

  auto* describe = c.app.add_subcommand("describe", "one element and its parameters");
  describe->add_option("name", c.element, "element name")->required();
  describe->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_describe(x, c.element); }; });

  auto* schema = c.app.add_subcommand("schema", "XML schema of scene files, for editors");
  schema->add_option("-o,--output,file", c.output, "file to write (default: standard output)");
  schema->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_schema(x, c.output); }; });

  auto* docs = c.app.add_subcommand("docs", "reference pages of all elements, in Markdown");
  docs->add_option("-o,--output,folder", c.folder, "folder to write to")->required();
  docs->add_option("--plugins", c.plugin_folder, "folder of plugin sources, for their examples");
  docs->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_docs(x, c.folder, c.plugin_folder); }; });
}

void add_new_plugin(CommandLine& c) {
  auto& o = c.new_plugin;
  auto* command = c.app.add_subcommand("new-plugin", "begin a plugin: a folder with source, test, example and build file");
  command->add_option("name", o.name, "its name, and that of its element: small letters, digits, _")->required();
  command->add_option("--kind", o.kind, "what it is: " + insula::plugin_kinds())->required();
  command->add_option("--folder", o.folder, "folder to be made (default: the name)");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_new_plugin(x, c.new_plugin); }; });
}

void add_devices(CommandLine& c) {
  auto& o = c.devices;
  auto* command = c.app.add_subcommand("devices", "what there is for the hands, what is missing and how to get it");
  auto* show = command->add_option("--show", o.show, "this device's live pose, buttons and force, until Ctrl-C");
  auto* calibrate = command->add_option("--calibrate", o.calibrate, "ask for this device's rest pose and axes and keep them");
  calibrate->excludes(show);
  auto* test = command->add_option("--test-force", o.test_force, "let this device push gently along each axis");
  test->excludes(show)->excludes(calibrate);
  command->add_option("--hand", o.hand, "hand that it serves")->check(CLI::IsMember({"left", "right"}))->capture_default_str();
  insula::add_quantity<Duration>(*command, "--duration", o.seconds, seconds("with --show: end after this time; 0: never"));
  insula::add_quantity<Force>(*command, "--newtons", o.newtons,
                              {.bare = "N", .min = "0.1 N", .max = "3 N", .doc = "with --test-force: largest force"})
      ->default_str("1 N");
  command->add_option("--scale", o.scale, "with --calibrate: movement of the tool over movement of the hand")
      ->check(CLI::Range(0.05, 5.0))
      ->capture_default_str();
  command->add_flag("--yes", o.assume_yes, "with --test-force: begin without asking");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_devices(x, c.devices); }; });
}

void add_run(CommandLine& c) {
  auto& o = c.run;
  auto* command = c.app.add_subcommand("run", "a scene from start to end without devices or viewer, with a report");
  command->add_option("scene", o.scene, "scene file")->required();
  insula::add_quantity<Duration>(*command, "--duration", o.duration,
                                 seconds("simulated time (default: the motion and one second more)"));
  add_motion(*command, o.motion);
  command->add_option("--report", o.report, "folder for report.json and report.html");
  command->add_option("--export", o.export_folder, "folder for the bodies' final nodes as .vtu");
  add_threads(*command, o.threads);
  add_seed(*command, o.seed);
  command->add_flag("--quiet", o.quiet, "print the last line only");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_run(x, c.run); }; });
}

void add_haptic_bench(CLI::App& bench, CommandLine& c) {
  auto& o = c.haptics;
  auto* flag = bench.add_flag("--haptics", c.measure_haptics,
                              "how far the servo's force is from that of the engine stepped at 1 kHz, devices on the motion's path");
  insula::add_quantities<Frequency>(bench, "--rates", o.rates,
                                    {.bare = "Hz", .min = "20 Hz", .max = "1 kHz", .doc = "with --haptics: the engine's rates"})
      ->needs(flag);
  insula::add_quantity<Duration>(bench, "--duration", o.duration,
                                 seconds("with --haptics: simulated time; 0: the whole motion"))
      ->needs(flag);
  bench.add_option("--latency", o.latency, "with --haptics: from poses to the problem's arrival, in steps (0.5) or as a time (3ms)")
      ->capture_default_str()
      ->needs(flag);
  bench.add_option("--jitter", o.jitter, "with --haptics: and so much later still at most, in steps")
      ->check(CLI::Range(0.0, 3.0))
      ->needs(flag);
  bench.add_flag("--fine", o.fine,
                 "with --haptics: problems come at the rate, but from an engine that steps at 1 kHz: what is left is the servo's "
                 "part of the error")
      ->needs(flag);
  bench.add_flag("--ablation", o.ablation, "with --haptics: what goes beyond equation 7, one after the other")->needs(flag);
  bench.add_option("--traces", o.traces, "with --haptics: folder for the forces as CSV")->needs(flag);
}

/// The benchmark that the options ask for.
void choose_bench(CommandLine& c) {
  if (c.measure_scaling) {
    c.scaling.threads = c.bench.threads > 0 ? c.bench.threads : 1;
    c.scaling.json = c.bench.json;
    c.chosen = [&](const auto& x) { return insula::cmd_bench_scaling(x, c.scaling); };
  } else if (!c.bench.problems.empty()) {
    c.chosen = [&](const auto& x) { return insula::cmd_bench_problems(x, c.bench); };
  } else if (c.bench.scene.empty()) {
    throw CLI::RequiredError("scene (or --scaling)");
  } else if (c.measure_haptics) {
    c.haptics.scene = c.bench.scene;
    c.haptics.motion = c.bench.motion;
    c.haptics.threads = c.bench.threads;
    c.chosen = [&](const auto& x) { return insula::cmd_bench_haptics(x, c.haptics); };
  } else if (!c.bench.record.empty()) {
    c.chosen = [&](const auto& x) { return insula::cmd_record_problems(x, c.bench); };
  } else if (c.bench.solvers) {
    c.chosen = [&](const auto& x) { return insula::cmd_bench_solvers(x, c.bench); };
  } else {
    c.chosen = [&](const auto& x) { return insula::cmd_bench(x, c.bench); };
  }
}

void add_bench(CommandLine& c) {
  auto& o = c.bench;
  auto* command = c.app.add_subcommand("bench", "where the time of a step goes");
  auto* scene = command->add_option("scene", o.scene, "scene file");
  auto* scaling = command->add_flag("--scaling", c.measure_scaling,
                                    "without a scene: the stages against nodes, rows and strands, with their slopes; one thread "
                                    "unless --threads says otherwise");
  scaling->excludes(scene);
  command->add_flag("--quick", c.scaling.quick, "with --scaling: small sizes only")->needs(scaling);
  command->add_option("--output", c.scaling.output, "with --scaling: folder for scaling.json and scaling.svg")->needs(scaling);
  command->add_option("--steps", o.steps, "steps to measure")->check(at_least(1))->capture_default_str();
  insula::add_quantity<Duration>(*command, "--from", o.from, seconds("simulated time at which measuring begins"));
  add_motion(*command, o.motion);
  add_threads(*command, o.threads);
  command->add_flag("--json", o.json, "print JSON");
  command->add_flag("--solvers", o.solvers, "compare the solvers on the matrices and rows of the step at --from");
  command->add_option("--rows", o.rows, "with --solvers: so many rows of each body at most; 0 takes all")->check(at_least(0));
  auto* record = command->add_option("--record", o.record, "write the steps' constraint problems to this folder instead");
  command->add_option("--every", o.every, "with --record: a problem of so many is written")->check(at_least(1))->needs(record);
  command->add_option("--problems", o.problems, "solve this folder's constraint problems instead of stepping a scene")
      ->excludes(scene);
  add_haptic_bench(*command, c);
  command->callback([&c] { choose_bench(c); });
}

void add_engine(CommandLine& c) {
  auto& o = c.engine;
  auto* command = c.app.add_subcommand("engine", "the engine process of a session, over the bus");
  command->add_option("scene", o.scene, "scene file")->required();
  command->add_option("--motion", o.motion, "what simulated hands follow")->capture_default_str();
  command->add_option("--bundle-dir", o.bundle_root, "folder for the viewer's scene bundles");
  insula::add_quantity<Duration>(*command, "--duration", o.duration, seconds("end after this simulated time; 0: never"));
  command->add_flag("--unthrottled", o.unthrottled, "as fast as the machine can, for measurements");
  add_threads(*command, o.threads);
  add_seed(*command, o.seed);
  command->add_flag("--still", o.still, "to be looked at: time never runs");
  command->add_flag("--standby", o.standby, "load, say so, and wait for SIGUSR1 before speaking on the bus");
  command->add_option("--notice", o.notice, "file whose text viewers are shown while it is not empty");
  command->add_option("--report", o.report, "folder for reports of the session, each in a folder of its own named by date and time");
  command->add_flag("--keep-bundle", o.keep_bundle, "leave the bundle where it is at the end, for a replay");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_engine(x, c.engine); }; });
}

void add_replay(CommandLine& c) {
  auto& o = c.replay;
  auto* command = c.app.add_subcommand("replay", "a log of lcm-logger onto the bus, for viewers");
  command->add_option("log", o.log, "log of a session")->required();
  command->add_option("--speed", o.speed, "times as fast as it was")->check(CLI::Range(0.01, 1000.0))->capture_default_str();
  command->add_flag("--loop", o.loop, "again and again, until Ctrl-C");
  command->callback([&c] { c.chosen = [&](const auto& x) { return insula::cmd_replay(x, c.replay); }; });
}

/// What play and view share.
void add_viewer_options(CLI::App& command, CommandLine& c) {
  auto& o = c.play;
  command.add_option("--port", o.port, "port of the viewer; following ones are tried when it is busy")->capture_default_str();
  command.add_option("--listen", o.listen, "address of the viewer; 0.0.0.0 lets other machines watch")->capture_default_str();
  insula::add_quantity<Duration>(command, "--duration", o.duration_s, seconds("end after this time; 0: never"));
  command.add_flag("--no-browser", c.no_browser, "open no browser");
}

void add_play(CommandLine& c) {
  auto& o = c.play;
  auto* command = c.app.add_subcommand("play", "engine, haptic server and viewer together, until Ctrl-C");
  command->add_option("scene", o.scene, "scene file (default: the first training exercise)");
  command->add_option("--motion", o.motion, "what simulated hands follow: a motion of the scene, a CSV file, or none");
  command->add_option("--left", o.left,
                      "device of the left hand, such as touch:\"Left Device\" (see insula devices); default: the scene's, else "
                      "simulated");
  command->add_option("--right", o.right, "device of the right hand");
  add_viewer_options(*command, c);
  add_seed(*command, o.seed);
  command->add_option("--keep-bundle", o.keep_bundle, "folder in which the viewer's scene bundles stay, for a replay of a log");
  command->add_option("--report", o.report, "folder for reports of the session, each in a folder of its own named by date and time");
  command->add_flag("--no-reload", c.no_reload, "do not load the scene again when one of its files is saved");
  command->callback([&c] {
    c.play.browser = !c.no_browser;
    c.play.reload = !c.no_reload;
    c.play.plugin_paths = c.plugin_paths;
    c.chosen = [&](const auto& x) { return insula::cmd_play(x, c.play); };
  });
}

void add_view(CommandLine& c) {
  auto* command = c.app.add_subcommand("view", "a scene to be looked at: what is in it by name, with units and sizes; time stands still");
  command->add_option("scene", c.play.scene, "scene file")->required();
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

void add_commands(CommandLine& c) {
  c.app.require_subcommand(1);
  c.app.add_option("--plugin-path", c.plugin_paths, "folder of shared plugins, or one plugin (may be given more than once)")
      ->allow_extra_args(false);
  add_scene_commands(c);
  add_new_plugin(c);
  add_devices(c);
  add_run(c);
  add_bench(c);
  add_engine(c);
  add_replay(c);
  add_play(c);
  add_view(c);
  c.app.add_subcommand("case", "training cases from surfaces and scans (see docs/making-a-case.md)");
}

}  // namespace

int main(int argc, char** argv) {
  // It reads what follows itself.
  if (argc > 1 && std::string_view(argv[1]) == "case") return insula::cmd_case({argv + 2, argv + argc}, std::cerr);
  CommandLine line;
  add_commands(line);
  try {
    std::vector<std::string> words = insula::command_words(argc, argv);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    line.app.parse(std::move(words));
  } catch (const CLI::ParseError& e) {
    const int status = line.app.exit(e);
    return status == 0 ? 0 : 2;
  }
  try {
    insula::Registry registry;
    if (const int status = fill_registry(registry, line.plugin_paths)) return status;
    return line.chosen({registry, std::cout, std::cerr});
  } catch (const std::exception& e) {
    std::cerr << "error: " << e.what() << '\n';
    return 1;
  }
}
