// SPDX-License-Identifier: GPL-3.0-or-later
// insula session: what a recording contains, and whether it is whole.
#include <fmt/ostream.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/bus/channels.h"
#include "engine/command_line/sessions.h"
#include "engine/session/session_format.h"
#include "engine/session/session_reader.h"

namespace insula {
namespace {

std::int64_t ticks_of(SessionReader& session) {
  std::int64_t ticks = 0;
  session.ticks([&](double, const insula_lcm::servo_ticks_t& m) {
    ticks += m.ticks;
    return true;
  });
  return ticks;
}

/// Reads everything, so that all damage is found.
nlohmann::ordered_json read_through(SessionReader& session) {
  std::int64_t last = 0, resets = 0, commands = 0, hashes = 0, gaps = 0, events = 0;
  session.steps([&](const insula_lcm::session_step_t& step) {
    gaps += step.number > last + 1;
    hashes += step.hashed;
    if (step.number > last)
      for (const auto& input : step.input) {
        resets += SimulationInput::Kind(input.kind) == SimulationInput::Kind::reset;
        commands += SimulationInput::Kind(input.kind) == SimulationInput::Kind::command;
      }
    last = step.number;
    return true;
  });
  session.events([&](const auto&) {
    ++events;
    return true;
  });
  McapReader& file = session.container();
  std::int64_t hands = 0;
  if (const auto channel = file.channel(channel::device_state))
    file.read({*channel}, 0, UINT64_MAX, [&](const auto&) { return ++hands > 0; });
  const std::int64_t ticks = ticks_of(session);
  for (const auto& a : file.attachments()) file.data(a);
  std::vector<std::string> damage = file.damage();
  if (gaps > 0) damage.push_back(fmt::format("steps are missing in {} places", gaps));
  if (session.damaged() > 0) damage.push_back(fmt::format("{} messages are not valid", session.damaged()));

  nlohmann::ordered_json json;
  for (const char* key : {"title", "scene", "motion", "mode", "began", "seed", "instruction_set"})
    json[key] = session.about(key);
  json["fields"] = nlohmann::ordered_json::object();
  for (const auto& [key, value] : file.descriptions().at("session"))
    if (key.starts_with(session::field_prefix))
      json["fields"][key.substr(std::string(session::field_prefix).size())] = value;
  json["passes"] = nlohmann::ordered_json::array();
  for (const auto& pass : session.passes())
    json["passes"].push_back({{"mode", pass.mode},
                              {"state", pass.state},
                              {"seconds", pass.time_s},
                              {"whole", pass.last_of_pass},
                              {"metrics", pass.values.size()}});
  json["written_by"] = file.library();
  json["bytes"] = file.bytes();
  json["ended"] = file.ended();
  json["step_s"] = session.step_s();
  json["steps"] = last;
  json["seconds"] = double(last) * double(json["step_s"]);
  json["resets"] = resets;
  json["commands"] = commands;
  json["events"] = events;
  json["device_states"] = hands;
  json["servo_ticks"] = ticks;
  json["state_hashes"] = hashes;
  json["files"] = file.descriptions().contains("files") ? file.descriptions().at("files").size() : 0;
  json["damage"] = damage;
  return json;
}

void print(std::ostream& out, const nlohmann::ordered_json& json) {
  for (const auto& [key, value] : json.items())
    if (!value.is_array() && !value.is_object())
      fmt::print(out, "{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  for (const auto& [name, value] : json["fields"].items())
    fmt::print(out, "field            {}={}\n", name, value.get<std::string>());
  for (const auto& pass : json["passes"])
    fmt::print(out, "pass             {} {} after {:.1f} s\n", pass["mode"].get<std::string>(),
               pass["state"].get<std::string>(), pass["seconds"].get<double>());
}

}  // namespace

int cmd_session_info(const CommandContext& context, const SessionOptions& options) {
  try {
    SessionReader session(options.file);
    const nlohmann::ordered_json json = read_through(session);
    if (options.json) {
      fmt::print(context.out, "{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else {
      print(context.out, json);
      for (const auto& line : json["damage"]) fmt::print(context.out, "damage: {}\n", line.get<std::string>());
    }
    return 0;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
}

int cmd_session_verify(const CommandContext& context, const SessionOptions& options) {
  try {
    SessionReader session(options.file);
    const nlohmann::ordered_json json = read_through(session);
    if (options.json)
      fmt::print(context.out, "{}\n",
                 nlohmann::ordered_json{{"ended", json["ended"]}, {"damage", json["damage"]}}.dump(2));
    for (const auto& line : json["damage"])
      fmt::print(context.err, "{}: {}\n", options.file.string(), line.get<std::string>());
    if (!json["ended"].get<bool>())
      fmt::print(context.err, "{}: was not ended; its program died or still writes\n", options.file.string());
    const bool whole = json["damage"].empty() && json["ended"].get<bool>();
    if (whole && !options.json)
      fmt::print(context.out, "whole: {} steps, {} events\n", json["steps"].dump(), json["events"].dump());
    return whole ? 0 : 1;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
}

}  // namespace insula
