// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/session_export.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <insula_lcm/device_state_t.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/input_error.h"
#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "engine/reports/table_file.h"
#include "engine/session/session_format.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* hand_names[] = {"left", "right"};

fs::path export_hands(SessionReader& session, const fs::path& folder, const std::string& format) {
  TableFile table(folder, "hands", format,
                  {"time_s", "hand", "connected", "device", "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz", "button1",
                   "button2", "fx_N", "fy_N", "fz_N"});
  if (const auto channel = session.container().channel(channel::device_state)) {
    insula_lcm::device_state_t m{};
    std::string why;
    session.container().read({*channel}, 0, UINT64_MAX, [&](const McapReader::Message& message) {
      if (!decode(message.data, m, why)) return true;
      for (const auto& h : m.hand)
        table.row({1e-9 * double(message.time_ns), hand_names[h.hand == 1], bool(h.connected), h.device, h.p_m[0],
                   h.p_m[1], h.p_m[2], h.q[0], h.q[1], h.q[2], h.q[3], bool(h.button1), bool(h.button2), h.force_N[0],
                   h.force_N[1], h.force_N[2]});
      return true;
    });
  }
  return table.close();
}

fs::path export_servo(SessionReader& session, const fs::path& folder, const std::string& format) {
  std::vector<std::string> columns = {"received_s", "clock_us"};
  for (const char* hand : hand_names)
    for (const char* number : {"px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz", "fx_N", "fy_N", "fz_N"})
      columns.push_back(fmt::format("{}_{}", hand, number));
  TableFile table(folder, "servo", format, columns);
  std::vector<Json> row(columns.size());
  session.ticks([&](double received_s, const insula_lcm::servo_ticks_t& m) {
    for (int k = 0; k < m.ticks; ++k) {
      row[0] = received_s;
      row[1] = m.time_us + m.after_us[std::size_t(k)];
      for (std::size_t n = 0; n < std::size_t(numbers_of_tick); ++n)
        row[2 + n] = m.hands[std::size_t(numbers_of_tick * k) + n];
      table.row(row);
    }
    return true;
  });
  return table.close();
}

fs::path export_channels(SessionReader& session, const fs::path& folder, const std::string& format) {
  std::vector<std::string> columns = {"recorded_s", "time_s"};
  const auto& described = session.container().descriptions();
  if (const auto names = described.find(session::channel_names); names != described.end())
    for (const auto& [number, name] : names->second) columns.push_back(name);
  TableFile table(folder, "channels", format, columns);
  if (const auto channel = session.container().channel(session::channels_topic))
    session.container().read({*channel}, 0, UINT64_MAX, [&](const McapReader::Message& message) {
      const Json values = Json::parse(message.data.begin(), message.data.end(), nullptr, false);
      if (!values.is_array() || values.size() + 1 != columns.size()) return true;
      std::vector<Json> row = {1e-9 * double(message.time_ns)};
      row.insert(row.end(), values.begin(), values.end());
      table.row(row);
      return true;
    });
  return table.close();
}

fs::path export_metrics(SessionReader& session, const fs::path& folder, const std::string& format) {
  TableFile table(
      folder, "metrics", format,
      {"number", "pass", "time_s", "mode", "state", "last_of_pass", "id", "hand", "value", "unit", "better"});
  session.metrics([&](const SessionReader::Metrics& m) {
    for (const auto& v : m.values)
      table.row({m.number, m.pass, m.time_s, m.mode, m.state, m.last_of_pass, v.id, v.hand, v.value, v.unit, v.better});
    return true;
  });
  return table.close();
}

fs::path export_events(SessionReader& session, const fs::path& folder, const std::string& format) {
  TableFile table(folder, "events", format, {"time_s", "kind", "id", "text", "value", "hand"});
  session.events([&](const insula_lcm::sim_event_t& e) {
    table.row(
        {e.sim_time_s, e.kind, e.id, e.text, e.value, e.hand == 0 || e.hand == 1 ? Json(hand_names[e.hand]) : Json()});
    return true;
  });
  return table.close();
}

template <class T>
void put(std::string& out, T value) {
  for (int shift = 8 * int(sizeof value) - 8; shift >= 0; shift -= 8)
    out += char((std::uint64_t(value) >> shift) & 255);
}

}  // namespace

std::vector<fs::path> export_tables(SessionReader& session, const fs::path& folder, const std::string& format) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be created: " + error.message());
  return {export_hands(session, folder, format), export_servo(session, folder, format),
          export_channels(session, folder, format), export_metrics(session, folder, format),
          export_events(session, folder, format)};
}

std::int64_t export_lcm_log(SessionReader& session, const fs::path& file) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  std::set<std::uint16_t> wanted;
  for (const auto topic : {channel::device_state, channel::servo_ticks, channel::sim_event})
    if (const auto channel = session.container().channel(topic)) wanted.insert(*channel);
  std::int64_t number = 0;
  session.container().read(wanted, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    const std::string& topic = session.container().channels().at(m.channel).topic;
    std::string head;  // core/bus/event_log.h describes an event
    put(head, std::uint32_t(0xEDA1DA01));
    put(head, number++);
    put(head, std::int64_t(m.time_ns / 1000));
    put(head, std::int32_t(topic.size()));
    put(head, std::int32_t(m.data.size()));
    out << head << topic;
    out.write(reinterpret_cast<const char*>(m.data.data()), std::streamsize(m.data.size()));
    return bool(out);
  });
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written: " + std::strerror(errno));
  return number;
}

}  // namespace insula
