// SPDX-License-Identifier: GPL-3.0-or-later
// insula play [SCENE]
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ostream>

#include "core/base/input_error.h"
#include "core/base/removed_at_end.h"
#include "core/bus/bus.h"
#include "core/bus/lcm_bus.h"
#include "core/scene/loader.h"
#include "core/sim/exercise.h"
#include "engine/command_line/curriculum_reader.h"
#include "engine/command_line/play.h"
#include "engine/command_line/play_children.h"
#include "engine/live/catalogue.h"
#include "engine/live/exercise_choice.h"
#include "engine/live/notice.h"
#include "engine/live/open_browser.h"
#include "engine/live/project_folder.h"
#include "engine/live/scene_devices.h"
#include "engine/live/scene_reload.h"
#include "engine/live/session_lock.h"
#include "engine/live/supervisor.h"
#include "engine/sharing/case_list.h"
#include "training/store/data_folder.h"
#include "training/xapi/http_record_store.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

/// Loads the scene only for a check, since the engine loads it again. Returns false if it has errors, which are
/// printed. Takes the scene's devices if the command line gives none.
bool scene_ok(const CommandContext& context, PlayOptions& options) {
  LoadResult result = load_scene(options.scene, context.registry);
  if (result.scene) check_scene_devices(*result.scene, result.diagnostics);
  context.err << result.diagnostics.format();
  if (!result.ok() || !result.diagnostics.ok()) return false;
  int hand = 0;
  for (std::string* device : {&options.left, &options.right}) {
    if (device->empty()) *device = scene_device(*result.scene, hand);
    const std::string obstacle = device->empty() ? std::string() : device_obstacle(*device);
    if (!obstacle.empty()) {
      context.err << "error: " << (hand == 0 ? "left" : "right") << " hand: " << obstacle << '\n';
      return false;
    }
    ++hand;
  }
  const std::string& motion = options.motion;
  if (!motion.empty() && motion != "none" && !fs::is_regular_file(motion)) {
    std::vector<std::string> ids;
    for (const MotionEntry* entry : result.scene->all<MotionEntry>()) ids.push_back(entry->id);
    if (std::find(ids.begin(), ids.end(), motion) == ids.end()) {
      std::string known;
      for (const std::string& id : ids) known += (known.empty() ? "" : ", ") + id;
      context.err << fmt::format("error: \"{}\" is neither a motion of {} ({}) nor a file\n", motion,
                                 options.scene.generic_string(), known.empty() ? "it has none" : "it has " + known);
      return false;
    }
  }
  context.out << fmt::format("insula: scene {} is fine{}{}\n", options.scene.generic_string(),
                             result.scene->title().empty() ? "" : ": ", result.scene->title());
  return true;
}

/// Whether the bus can be used and no other session does. It listens from its construction on.
class BusCheck {
 public:
  BusCheck() : bus_(make_bus()), engines_(*bus_) {}

  /// A machine without multicast gives one message.
  bool free(const CommandContext& context, SessionLock& lock) {
    if (!bus_->good()) {
      context.err << "error: " << bus_->error() << '\n';
      return false;
    }
    if (lock.take() && !engines_.heard()) return true;
    context.err << second_session_advice(lcm_url_from_environment(), lock.viewer());
    return false;
  }

 private:
  std::unique_ptr<Bus> bus_;
  EngineListener engines_;
};

/// Folder in which the engine writes the viewer's files. A killed engine leaves its files there, and they are removed
/// with the session.
RemovedAtEnd bundle_folder() {
  std::string name = (runtime_folder() / "insula-XXXXXX").string();
  return RemovedAtEnd(mkdtemp(name.data()) != nullptr ? fs::path(name) : fs::path());
}

std::vector<std::string> on_standby(std::vector<std::string> engine) {
  engine.emplace_back("--standby");
  return engine;
}

/// What persons do in this session can be sent; else it says why not.
bool sender_ok(const CommandContext& context, const PlayOptions& options) {
  const RecordStoreOptions& records = options.records;
  if (records.lrs.empty()) return true;
  try {
    if (options.store.empty()) throw InputError("--lrs: a session without reports keeps no runs to be sent");
    const xapi::HttpRecordStore checked(records.lrs, xapi::read_login(records.login), records.authorities);
  } catch (const InputError& e) {
    context.err << "error: " << e.what() << '\n';
    return false;
  }
  return true;
}

/// Writes what exercises there are. Without a folder to write to, pages show the running one only.
StartPageFiles start_page_files(const PlayOptions& options, const fs::path& bundles) {
  if (bundles.empty() || options.view) return {};
  const StartPageFiles files{bundles / "catalogue.json", bundles / "choice.json", bundles / "curricula.json"};
  std::vector<CatalogueEntry> exercises = catalogue(project_folder());
  for (CatalogueEntry& added : added_exercises(options.data)) exercises.push_back(std::move(added));
  const std::string text =
      catalogue_json(exercises).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return leave_notice(files.catalogue, text) ? files : StartPageFiles{};
}

}  // namespace

fs::path default_scene() {
  // The loader reports if it is missing.
  return (project_folder() / "scenes/training/1_sylvian_fissure.xml").lexically_normal();
}

fs::path default_report_folder(const fs::path& data) {
  if (!data.empty()) return training::data_folder(data).root / "reports";
  const char* home = std::getenv("HOME");
  return fs::absolute(home != nullptr && *home != '\0' ? fs::path(home) : fs::path(".")) / "insula-reports";
}

std::vector<fs::path> folders_of_play(const fs::path& data) {
  return {training::data_folder(data).sessions(), default_report_folder(data)};
}

int cmd_play(const CommandContext& context, const PlayOptions& given) {
  PlayOptions options = given;
  options.start_page = !options.view && options.scene.empty();
  if (options.scene.empty()) options.scene = default_scene();
  BusCheck bus;
  if (!scene_ok(context, options) || !sender_ok(context, options)) return 2;
  SessionLock lock(runtime_folder(), lcm_url_from_environment());
  if (!bus.free(context, lock)) return 1;
  const fs::path program = own_program(), folder = program.parent_path();
  for (const char* name : {"haptic_server", "gateway"})
    if (::access((folder / name).c_str(), X_OK) != 0) {
      context.err << fmt::format("error: {} is missing: build it first\n", (folder / name).string());
      return 1;
    }
  signal(SIGPIPE, SIG_IGN);
  const Supervisor::Print print = [&out = context.out](std::string_view line) { out << line << std::endl; };
  const RemovedAtEnd bundles = bundle_folder();
  const ChildSpec engine = engine_child(options, program, bundles.path());
  SceneReload reload(options.scene, options.plugin_paths, on_standby(engine.command),
                     bundles.path().empty() ? fs::path() : bundles.path() / "notice.txt", print);
  fs::path pins;
  try {
    pins = write_pins(options.room, bundles.path(), print);
  } catch (const InputError& e) {
    context.err << "error: " << e.what() << '\n';
    return 2;
  }
  const StartPageFiles files = start_page_files(options, bundles.path());
  const auto command_of = [&](const ChosenExercise& choice) {
    return engine_child(chosen_options(options, choice), program, bundles.path()).command;
  };
  ExerciseChoice choice({scene_name(options.scene), person_of(options)}, files.choice, command_of,
                        [&](const ChosenExercise& c) { reload.watch(scene_file(c.scene), on_standby(command_of(c))); });
  CurriculumReader curricula(program, options, files.curricula, print);
  SupervisorSettings settings;
  settings.duration_s = options.duration_s;
  Supervisor* running = nullptr;
  settings.look = [&] {
    choice.look(*running);
    curricula.look();
    if (options.reload) reload.look(*running);
  };
  Supervisor supervisor(settings, print);
  running = &supervisor;
  const auto serving = [&](const std::string& url, bool first) {
    print("insula: viewer at " + url);
    if (!options.view) print("insula: the instructor's page is " + url + "?role=instructor");
    lock.announce(url);
    if (first && options.browser) open_browser(url);
  };
  // The viewer starts first, so that it is available while the engine loads.
  supervisor.add(
      gateway_child(options, folder, files, pins,
                    {serving, [&](std::string_view json) { choice.ask(json); }, [&] { curricula.begin(); }}));
  if (!options.view) supervisor.add(haptic_child(options, folder));
  supervisor.add(engine);
  if (!options.records.lrs.empty()) supervisor.add(sender_child(options, program));
  return supervisor.run();
}

}  // namespace insula
