// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/station.h"

#include <boost/asio/ip/host_name.hpp>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace insula::gateway {
namespace {

using Ordered = nlohmann::ordered_json;

std::string machine_name() {
  boost::system::error_code error;
  const std::string name = boost::asio::ip::host_name(error);
  return error ? "station" : name;
}

std::string person_in(const std::filesystem::path& choice) {
  if (choice.empty()) return {};
  std::ifstream in(choice, std::ios::binary);
  const Ordered json = Ordered::parse(std::string(std::istreambuf_iterator<char>(in), {}), nullptr, false);
  return json.is_object() && json.contains("person") && json["person"].is_string() ? json["person"].get<std::string>()
                                                                                   : std::string();
}

}  // namespace

bool is_jpeg(std::string_view bytes, int most_px) {
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? int(static_cast<unsigned char>(bytes[i])) : -1; };
  const auto word = [&](std::size_t i) { return byte(i) * 256 + byte(i + 1); };
  if (word(0) != 0xffd8 || bytes.size() < 4 || word(bytes.size() - 2) != 0xffd9) return false;
  // Segments: marker, length with itself, content. The frame's header says how large the picture is.
  for (std::size_t at = 2; at + 9 < bytes.size() && byte(at) == 0xff; at += 2 + std::size_t(word(at + 2))) {
    const int marker = byte(at + 1);
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (!frame) {
      if (word(at + 2) < 2) return false;
      continue;
    }
    const int high = word(at + 5), wide = word(at + 7);
    return high > 0 && wide > 0 && high <= most_px && wide <= most_px;
  }
  return false;
}

Station::Station(std::string name, std::filesystem::path choice)
    : name_(name.empty() ? machine_name() : std::move(name)), choice_(std::move(choice)) {}

std::string Station::person() const { return person_in(choice_); }

void Station::scene(const insula_lcm::scene_info_t& info) {
  if (info.session != session_) alarms_.clear();
  session_ = info.session;
  title_ = info.title.empty() ? info.scene : info.title;
  state_ = info.state;
}

void Station::event(const insula_lcm::sim_event_t& event) {
  if (event.kind == "reset") alarms_.clear();
  if (event.kind != "fault" && event.kind != "complication") return;
  if (alarms_.size() == most_alarms) alarms_.pop_front();
  alarms_.push_back({event.kind, event.text.empty() ? event.id : event.text, event.sim_time_s});
}

void Station::frame(double sim_time_s, Clock::time_point now) {
  time_s_ = sim_time_s;
  frame_at_ = now;
}

std::string Station::json(Clock::time_point now) const {
  const bool seen = frame_at_ != Clock::time_point{};
  Ordered out{{"name", name_}, {"person", person()}, {"title", title_}, {"state", state_}, {"time_s", time_s_}};
  out["frame_age_ms"] = seen ? std::chrono::duration_cast<std::chrono::milliseconds>(now - frame_at_).count() : -1;
  out["alarms"] = Ordered::array();
  for (const Alarm& alarm : alarms_)
    out["alarms"].push_back({{"kind", alarm.kind}, {"text", alarm.text}, {"time_s", alarm.time_s}});
  out["picture"] = pictures_;
  return out.dump(-1, ' ', false, Ordered::error_handler_t::replace) + "\n";
}

std::string_view Station::set_picture(std::string jpeg) {
  if (jpeg.size() > most_picture_bytes) return "the picture has more than 64 KB";
  if (!is_jpeg(jpeg, most_picture_px)) return "this is no JPEG of at most 1024 pixels each way";
  picture_ = std::move(jpeg);
  ++pictures_;
  return {};
}

}  // namespace insula::gateway
