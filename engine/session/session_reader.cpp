// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/session_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "engine/session/session_format.h"

namespace insula {
namespace {

constexpr double most_steps = 1e8;  // of a session; a time beyond is damage

template <class Message>
void read_all(McapReader& file, std::string_view topic, std::int64_t& damaged,
              const std::function<bool(const Message&)>& take) {
  const auto channel = file.channel(topic);
  if (!channel) return;
  Message message{};
  std::string why;
  file.read({*channel}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    if (decode(m.data, message, why)) return take(message);
    ++damaged;
    return true;
  });
}

}  // namespace

SessionReader::SessionReader(const std::filesystem::path& file) : file_(file) {
  if (!file_.profile().empty() && file_.profile() != session::profile)
    throw InputError(file.string() + ": is an MCAP file of \"" + file_.profile() + "\", not a session of Insula");
  if (!file_.descriptions().contains("session"))
    throw InputError(file.string() + ": does not say which scene was recorded; the file is damaged at its beginning");
}

std::string SessionReader::about(const std::string& key) const {
  const mcap::Text& text = file_.descriptions().at("session");
  const auto found = text.find(key);
  return found == text.end() ? "" : found->second;
}

double SessionReader::step_s() const { return std::strtod(about("step_s").c_str(), nullptr); }

void SessionReader::steps(const std::function<bool(const insula_lcm::session_step_t&)>& take) {
  read_all(file_, session::step_topic, damaged_, take);
}

void SessionReader::events(const std::function<bool(const insula_lcm::sim_event_t&)>& take) {
  read_all(file_, channel::sim_event, damaged_, take);
}

void SessionReader::ticks(const std::function<bool(double, const insula_lcm::servo_ticks_t&)>& take) {
  const auto channel = file_.channel(channel::servo_ticks);
  if (!channel) return;
  insula_lcm::servo_ticks_t message{};
  std::string why;
  file_.read({*channel}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    if (decode(m.data, message, why)) return take(1e-9 * double(m.time_ns), message);
    ++damaged_;
    return true;
  });
}

std::string SessionReader::field(const std::string& name) const {
  const std::string said = about(session::field_prefix + name);
  return said.empty() ? about(name) : said;
}

void SessionReader::metrics(const std::function<bool(const Metrics&)>& take) {
  const auto channel = file_.channel(session::metrics_topic);
  if (!channel) return;
  file_.read({*channel}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    try {
      const auto json = nlohmann::json::parse(m.data.begin(), m.data.end());
      Metrics out;
      out.number = json.at("number");
      out.pass = json.at("pass");
      out.time_s = json.at("time_s");
      out.mode = json.at("mode");
      out.state = json.at("state");
      out.last_of_pass = json.at("last_of_pass");
      for (const auto& v : json.at("metrics"))
        out.values.push_back({v.at("id"), v.at("hand"), v.at("unit"), v.at("better"), v.at("value")});
      return take(out);
    } catch (const nlohmann::json::exception&) {
      ++damaged_;
      return true;
    }
  });
}

std::vector<SessionReader::Metrics> SessionReader::passes() {
  std::vector<Metrics> out;
  metrics([&](const Metrics& m) {
    if (out.empty() || out.back().pass != m.pass) out.push_back(m);
    else if (m.state == "running" || m.state != out.back().state) out.back() = m;
    return true;
  });
  return out;
}

std::vector<std::array<double, 2>> SessionReader::hand_forces() {
  std::vector<std::array<double, 2>> out;
  const double h = step_s();
  if (!(h > 0)) return out;
  ticks([&](double received_s, const insula_lcm::servo_ticks_t& m) {
    // A message has the time of the step before it.
    const double number = std::round(received_s / h) + 1;
    if (number > most_steps) return true;
    if (out.size() <= std::size_t(number)) out.resize(std::size_t(number) + 1);
    for (std::size_t at = 0; at < m.hands.size(); at += numbers_of_tick / 2) {
      const float* force = m.hands.data() + at + 7;
      double& largest = out[std::size_t(number)][at / (numbers_of_tick / 2) % 2];
      largest = std::max(largest, double(std::hypot(force[0], force[1], force[2])));
    }
    return true;
  });
  return out;
}

SimulationInput input_of(const insula_lcm::step_input_t& m) {
  SimulationInput out;
  out.kind = SimulationInput::Kind(m.kind);
  out.index = m.index;
  out.hand.present = m.present;
  out.hand.device.p = Vec3(m.p_m[0], m.p_m[1], m.p_m[2]);
  out.hand.device.q = Quat(m.q[0], m.q[1], m.q[2], m.q[3]);
  out.hand.button1 = m.button1;
  out.hand.button2 = m.button2;
  out.verb = m.verb;
  out.argument = m.argument;
  out.seed = std::uint64_t(m.seed);
  out.seconds = m.seconds;
  return out;
}

}  // namespace insula
