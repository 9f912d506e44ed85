// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/play_children.h"

#include <cstdlib>
#include <utility>

#include "engine/live/project_folder.h"
#include "engine/live/session_mode.h"
#include "engine/session/session_format.h"
#include "training/store/data_folder.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

/// A motion that is named on the command line is shown at once.
std::string mode_of(const PlayOptions& options) {
  if (!options.mode.empty()) return options.mode;
  if (options.motion.empty()) return std::string(name_of(SessionMode::waiting));
  return std::string(name_of(options.motion == "none" ? SessionMode::practice : SessionMode::demonstration));
}

/// Where the page finds recorded sessions: beside those that this one becomes.
std::string session_folder(const PlayOptions& options) {
  if (options.record.empty()) return training::data_folder(options.data).sessions().string();
  const bool file = options.record.extension() == session::extension;
  return fs::absolute(file ? fs::absolute(options.record).parent_path() : options.record).string();
}

}  // namespace

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
  if (!options.store.empty()) engine.command.insert(engine.command.end(), {"--store", options.store.string()});
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

ChildSpec sender_child(const PlayOptions& options, const fs::path& program) {
  const RecordStoreOptions& records = options.records;
  ChildSpec sender;
  sender.name = "sender";
  sender.may_stay_away = true;
  sender.command = {program.string(), "people", "send", "--watch", "--lrs", records.lrs};
  if (!records.login.empty())
    sender.command.insert(sender.command.end(), {"--login", fs::absolute(records.login).string()});
  if (!records.authorities.empty())
    sender.command.insert(sender.command.end(), {"--ca", fs::absolute(records.authorities).string()});
  if (!options.data.empty()) sender.command.insert(sender.command.end(), {"--data", options.data.string()});
  return sender;
}

PlayOptions chosen_options(const PlayOptions& first, const ChosenExercise& choice) {
  PlayOptions out = first;
  out.scene = scene_file(choice.scene);
  std::erase_if(out.fields, [](const std::string& f) { return f.starts_with("person="); });
  if (!choice.person.empty()) out.fields.push_back("person=" + choice.person);
  if (choice.scene != scene_name(first.scene)) out.motion.clear(), out.bands.clear(), out.band_group.clear();
  out.mode = choice.mode;
  if (choice.seed) out.seed = *choice.seed;
  return out;
}

std::string person_of(const PlayOptions& options) {
  for (const std::string& field : options.fields)
    if (field.starts_with("person=")) return field.substr(field.find('=') + 1);
  return {};
}

ChildSpec gateway_child(const PlayOptions& options, const fs::path& folder, const StartPageFiles& files,
                        const fs::path& pins, const GatewayLines& lines) {
  ChildSpec gateway;
  gateway.name = "gateway";
  std::vector<std::string> command{(folder / "gateway").string(), "--listen", options.listen, "--sessions",
                                   session_folder(options)};
  for (const std::string& host : options.hosts) command.insert(command.end(), {"--host", host});
  if (!options.store.empty()) command.insert(command.end(), {"--store", options.store.string()});
  if (!files.catalogue.empty())
    command.insert(command.end(), {"--catalogue", files.catalogue.string(), "--choice", files.choice.string(),
                                   "--curricula", files.curricula.string()});
  const std::vector<std::string> room = room_arguments(options.room, pins, options.data);
  command.insert(command.end(), room.begin(), room.end());
  if (options.start_page) command.emplace_back("--start");
  gateway.command = command;
  gateway.command.insert(gateway.command.end(), {"--port", std::to_string(options.port)});
  gateway.on_line = [command, lines, first = true](ChildSpec& self, std::string_view line) mutable {
    constexpr std::string_view serving = "serving ", choose = "choose ";
    if (line.starts_with(choose)) {
      lines.chosen(line.substr(choose.size()));
      return false;
    }
    if (line == "curricula") {
      lines.curricula();
      return false;
    }
    if (!line.starts_with(serving)) return true;
    const std::string url(line.substr(serving.size()));
    const std::size_t colon = url.rfind(':');
    if (first && colon != std::string::npos) {
      // A restarted gateway must use the port that the pages know.
      self.command = command;
      self.command.insert(self.command.end(),
                          {"--exact-port", "--port", std::to_string(std::atoi(url.c_str() + colon + 1))});
    }
    lines.serving(url, std::exchange(first, false));
    return false;
  };
  return gateway;
}

}  // namespace insula
