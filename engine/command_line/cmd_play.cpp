// SPDX-License-Identifier: GPL-3.0-or-later
// insula play [SCENE]
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ostream>

#include "core/bus/bus.h"
#include "core/bus/lcm_bus.h"
#include "core/scene/loader.h"
#include "core/sim/exercise.h"
#include "engine/command_line/play.h"
#include "engine/live/scene_devices.h"
#include "engine/live/scene_reload.h"
#include "engine/live/session_lock.h"
#include "engine/live/session_mode.h"
#include "engine/live/supervisor.h"
#include "engine/session/live_recording.h"
#include "engine/session/session_format.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

fs::path own_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

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

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return true;
  return false;
}

/// Starts xdg-open independently of this process. It forks twice, so that xdg-open is not a child of this process and
/// continues after it.
void open_browser(const std::string& url) {
  const char* address = url.c_str();
  const pid_t pid = fork();
  if (pid == 0) {
    for (int s : {SIGINT, SIGTERM, SIGHUP, SIGCHLD, SIGPIPE}) signal(s, SIG_DFL);
    setsid();
    if (fork() == 0) {
      if (freopen("/dev/null", "w", stdout) == nullptr || freopen("/dev/null", "w", stderr) == nullptr) _exit(1);
      execlp("xdg-open", "xdg-open", address, static_cast<char*>(nullptr));
      _exit(127);
    }
    _exit(0);
  }
  if (pid > 0) waitpid(pid, nullptr, 0);
}

/// Folder in which the engine writes the viewer's files. A killed engine leaves its files there, and they are removed
/// with the session.
class BundleFolder {
 public:
  BundleFolder() {
    std::string name = (runtime_folder() / "insula-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~BundleFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  BundleFolder(const BundleFolder&) = delete;
  BundleFolder& operator=(const BundleFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A motion that is named on the command line is shown at once.
std::string mode_of(const PlayOptions& options) {
  if (!options.mode.empty()) return options.mode;
  if (options.motion.empty()) return std::string(name_of(SessionMode::waiting));
  return std::string(name_of(options.motion == "none" ? SessionMode::practice : SessionMode::demonstration));
}

ChildSpec engine_child(const PlayOptions& options, const fs::path& program, const fs::path& bundles) {
  ChildSpec engine;
  engine.name = "engine";
  engine.ends_session = true;
  engine.command = {program.string()};
  for (const fs::path& path : options.plugin_paths)
    engine.command.insert(engine.command.end(), {"--plugin-path", path.string()});
  engine.command.insert(engine.command.end(), {"engine", options.scene.string()});
  if (!options.motion.empty()) engine.command.insert(engine.command.end(), {"--motion", options.motion});
  if (!options.view) engine.command.insert(engine.command.end(), {"--mode", mode_of(options)});
  if (!options.rate.empty()) engine.command.insert(engine.command.end(), {"--rate", options.rate});
  if (options.seed != 0) engine.command.insert(engine.command.end(), {"--seed", std::to_string(options.seed)});
  if (!options.keep_bundle.empty())
    engine.command.insert(engine.command.end(), {"--bundle-dir", options.keep_bundle.string(), "--keep-bundle"});
  else if (!bundles.empty()) engine.command.insert(engine.command.end(), {"--bundle-dir", bundles.string()});
  if (options.view) engine.command.emplace_back("--still");
  if (!bundles.empty()) engine.command.insert(engine.command.end(), {"--notice", (bundles / "notice.txt").string()});
  if (!options.report.empty()) engine.command.insert(engine.command.end(), {"--report", options.report.string()});
  if (!options.record.empty() && !options.view)
    engine.command.insert(engine.command.end(), {"--record", options.record.string()});
  if (!options.bands.empty()) engine.command.insert(engine.command.end(), {"--bands", options.bands.string()});
  if (!options.band_group.empty()) engine.command.insert(engine.command.end(), {"--band-group", options.band_group});
  for (const std::string& field : options.fields) engine.command.insert(engine.command.end(), {"--field", field});
  engine.waits_for_offer = options.reload;
  return engine;
}

ChildSpec haptic_child(const PlayOptions& options, const fs::path& folder) {
  ChildSpec server;
  server.name = "haptic_server";
  server.command = {(folder / "haptic_server").string()};
  if (!options.left.empty()) server.command.insert(server.command.end(), {"--left", options.left});
  if (!options.right.empty()) server.command.insert(server.command.end(), {"--right", options.right});
  return server;
}

/// Where the page finds recorded sessions: beside those that this one becomes.
std::string session_folder(const PlayOptions& options) {
  if (options.record.empty()) return default_session_folder().string();
  const bool file = options.record.extension() == session::extension;
  return fs::absolute(file ? fs::absolute(options.record).parent_path() : options.record).string();
}

ChildSpec gateway_child(const PlayOptions& options, const fs::path& folder, const SessionLock& lock,
                        const Supervisor::Print& print) {
  ChildSpec gateway;
  gateway.name = "gateway";
  const auto command = [program = (folder / "gateway").string(), listen = options.listen, hosts = options.hosts,
                        sessions = session_folder(options)](int port) {
    std::vector<std::string> line{program, "--listen", listen, "--port", std::to_string(port), "--sessions", sessions};
    for (const std::string& host : hosts) line.insert(line.end(), {"--host", host});
    return line;
  };
  gateway.command = command(options.port);
  gateway.on_line = [=, &lock, first = true, browser = options.browser, view = options.view](
                        ChildSpec& self, std::string_view line) mutable {
    constexpr std::string_view serving = "serving ";
    if (!line.starts_with(serving)) return true;
    const std::string url(line.substr(serving.size()));
    print("insula: viewer at " + url);
    if (!view) print("insula: the instructor's page is " + url + "?role=instructor");
    lock.announce(url);
    const std::size_t colon = url.rfind(':');
    if (first && colon != std::string::npos) {
      // A restarted gateway must use the port that the pages know.
      self.command = command(std::atoi(url.c_str() + colon + 1));
      self.command.emplace_back("--exact-port");
      if (browser && has_display()) open_browser(url);
      first = false;
    }
    return false;
  };
  return gateway;
}

}  // namespace

fs::path default_scene() {
  const fs::path scene = "scenes/training/1_sylvian_fissure.xml";
  std::error_code error;
  const fs::path bin = own_program().parent_path();
  for (const fs::path& root : {fs::path("."), bin / "../../..", bin / "../share/insula"})
    if (fs::is_regular_file(root / scene, error)) return (root / scene).lexically_normal();
  return scene;  // the loader reports that it is missing
}

fs::path default_report_folder() {
  const char* home = std::getenv("HOME");
  return fs::absolute(home != nullptr && *home != '\0' ? fs::path(home) : fs::path(".")) / "insula-reports";
}

int cmd_play(const CommandContext& context, const PlayOptions& given) {
  PlayOptions options = given;
  if (options.scene.empty()) options.scene = default_scene();
  BusCheck bus;
  if (!scene_ok(context, options)) return 2;
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
  const BundleFolder bundles;
  const ChildSpec engine = engine_child(options, program, bundles.path());
  std::vector<std::string> standby = engine.command;
  standby.emplace_back("--standby");
  SceneReload reload(options.scene, options.plugin_paths, std::move(standby),
                     bundles.path().empty() ? fs::path() : bundles.path() / "notice.txt", print);
  SupervisorSettings settings;
  settings.duration_s = options.duration_s;
  Supervisor* running = nullptr;
  if (options.reload) settings.look = [&] { reload.look(*running); };
  Supervisor supervisor(settings, print);
  running = &supervisor;
  // The viewer starts first, so that it is available while the engine loads.
  supervisor.add(gateway_child(options, folder, lock, print));
  if (!options.view) supervisor.add(haptic_child(options, folder));
  supervisor.add(engine);
  return supervisor.run();
}

}  // namespace insula
