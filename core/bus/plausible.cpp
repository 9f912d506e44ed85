// SPDX-License-Identifier: GPL-3.0-or-later
// Validators of the generated message types.
#include "core/bus/plausible.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

namespace insula {
namespace {

constexpr std::size_t short_text = 256, path_text = 4096, long_text = 64 * 1024;

bool fail(std::string& why, const char* text) {
  why = text;
  return false;
}

/// No NUL inside, valid length.
bool text_ok(const std::string& s, std::size_t most) { return s.size() <= most && s.find('\0') == std::string::npos; }
/// A short plain word: letters, digits, _ - . : #
bool word_ok(const std::string& s, std::size_t most) {
  return s.size() <= most && std::all_of(s.begin(), s.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  std::string_view("_-.:#").find(c) != std::string_view::npos;
         });
}
bool non_negative(double v, double most) { return v >= 0 && v <= most; }  // false for NaN
bool flag_ok(int v) { return v == 0 || v == 1; }

constexpr double max_seconds = 1e9;
constexpr double max_us = 1e12;

}  // namespace

bool within(const double* values, int count, double most) {
  for (int i = 0; i < count; ++i)
    if (!(std::abs(values[i]) <= most)) return false;
  return true;
}
bool within(const float* values, int count, double most) {
  for (int i = 0; i < count; ++i)
    if (!(std::abs(double(values[i])) <= most)) return false;
  return true;
}
bool unit_quaternion(const double* q) {
  if (!within(q, 4, 2)) return false;
  return std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) <= 2 * limits::unit_tolerance;
}

bool plausible(const insula_lcm::device_state_t& m, std::string& why) {
  if (m.session < 0 || m.sequence < 0 || m.time_us < 0) return fail(why, "negative session, sequence or time");
  if (!consistent(m) || m.hands > 2) return fail(why, "more than two hands");
  for (int i = 0; i < m.hands; ++i) {
    const auto& h = m.hand[std::size_t(i)];
    if (h.hand != 0 && h.hand != 1) return fail(why, "hand is neither left nor right");
    if (i == 1 && h.hand == m.hand[0].hand) return fail(why, "the same hand twice");
    if (!word_ok(h.device, 64)) return fail(why, "device name is no short word");
    if (!flag_ok(h.connected) || !flag_ok(h.button1) || !flag_ok(h.button2))
      return fail(why, "flag is neither 0 nor 1");
    if (!within(h.p_m, 3, limits::position_m)) return fail(why, "device position out of range");
    if (!unit_quaternion(h.q)) return fail(why, "device orientation is no unit quaternion");
    if (!within(h.v_m_s, 3, limits::speed_m_s) || !within(h.w_rad_s, 3, limits::spin_rad_s))
      return fail(why, "device velocity out of range");
    if (!within(h.force_N, 3, 100) || !within(h.torque_Nm, 3, 100)) return fail(why, "device force out of range");
  }
  return true;
}

bool plausible(const insula_lcm::hand_input_t& m, std::string& why) {
  if (m.time_us < 0) return fail(why, "negative time");
  if (m.hand != 0 && m.hand != 1) return fail(why, "hand is neither left nor right");
  if (!within(m.p_m, 3, limits::position_m)) return fail(why, "position out of range");
  if (!unit_quaternion(m.q)) return fail(why, "orientation is no unit quaternion");
  if (!flag_ok(m.button1) || !flag_ok(m.button2)) return fail(why, "flag is neither 0 nor 1");
  return true;
}

bool plausible(const insula_lcm::haptic_status_t& m, std::string& why) {
  if (m.session < 0 || m.sequence < 0 || m.time_us < 0) return fail(why, "negative session, sequence or time");
  if (m.missed_ticks < 0 || m.problems_received < 0 || m.messages_refused < 0) return fail(why, "negative count");
  if (m.rows < 0 || m.rows > 1'000'000) return fail(why, "rows out of range");
  if (!flag_ok(m.realtime)) return fail(why, "flag is neither 0 nor 1");
  for (double v : {m.ticks_per_s, m.fresh_forces_per_s[0], m.fresh_forces_per_s[1]})
    if (!non_negative(v, 1e6)) return fail(why, "rate out of range");
  for (double v : {m.lateness_us_p50, m.lateness_us_p99, m.lateness_us_max, m.solve_us_p50, m.solve_us_p99})
    if (!non_negative(v, max_us)) return fail(why, "time out of range");
  if (std::any_of(std::begin(m.lateness_count), std::end(m.lateness_count), [](int n) { return n < 0; }))
    return fail(why, "negative count");
  if (!non_negative(m.sweeps_mean, 1e6) || !non_negative(m.residual_m_max, 1e6))
    return fail(why, "solver figures out of range");
  if (!non_negative(m.given_mJ[0], 1e6) || !non_negative(m.given_mJ[1], 1e6)) return fail(why, "energy out of range");
  if (!non_negative(m.force_scale, 100)) return fail(why, "force scale out of range");
  if (!(std::abs(m.problem_age_ms) <= max_us)) return fail(why, "age out of range");  // -1: no problem yet
  if (!text_ok(m.note, path_text)) return fail(why, "note too long");
  return true;
}

bool plausible(const insula_lcm::render_frame_t& m, std::string& why) {
  if (m.session < 0 || m.sequence < 0 || m.time_us < 0) return fail(why, "negative session, sequence or time");
  if (!consistent(m)) return fail(why, "counts disagree");
  if (!non_negative(m.sim_time_s, max_seconds)) return fail(why, "simulated time out of range");
  if (!flag_ok(m.paused)) return fail(why, "flag is neither 0 nor 1");
  if (m.bodies > 256 || m.tools > 100) return fail(why, "too many bodies or tools");
  for (std::size_t i = 0; i < m.body.size(); ++i) {
    const auto& b = m.body[i];
    if (b.index < 0 || b.index > 4095) return fail(why, "body number out of range");
    for (std::size_t j = 0; j < i; ++j)
      if (m.body[j].index == b.index) return fail(why, "the same body twice");
    for (const auto& x : b.x_m)
      if (!within(x.data(), 3, limits::position_m)) return fail(why, "node position out of range");
  }
  if (m.channels > 100'000 || m.drawables > 4096) return fail(why, "too many channels or drawables");
  for (float v : m.channel)  // NaN: unknown value
    if (std::isinf(v)) return fail(why, "channel is not finite");
  for (std::size_t i = 0; i < m.drawable.size(); ++i) {
    const auto& d = m.drawable[i];
    if (d.index < 0 || d.index > 4095) return fail(why, "drawable number out of range");
    for (std::size_t j = 0; j < i; ++j)
      if (m.drawable[j].index == d.index) return fail(why, "the same drawable twice");
    if (!std::all_of(d.data.begin(), d.data.end(), [](float v) { return std::isfinite(v); }))
      return fail(why, "drawable is not finite");
  }
  for (std::size_t i = 0; i < m.tool.size(); ++i) {
    const auto& t = m.tool[i];
    if (t.index < 0 || t.index > 127 || t.hand < -1 || t.hand > 1) return fail(why, "tool number or hand out of range");
    if (!within(t.p_m, 3, limits::position_m) || !within(t.device_p_m, 3, limits::position_m))
      return fail(why, "tool position out of range");
    if (!unit_quaternion(t.q)) return fail(why, "tool orientation is no unit quaternion");
    if (!within(t.force_N, 3, limits::force_N)) return fail(why, "tool force out of range");
    if (!(t.activity >= 0.f && t.activity <= 1.f)) return fail(why, "tool activity out of range");
    if (t.state < 0 || t.state > 2) return fail(why, "tool state is none of 0, 1, 2");
    if (!(t.opening_rad >= -limits::opening_rad && t.opening_rad <= limits::opening_rad))
      return fail(why, "tool opening out of range");
  }
  for (const auto& x : m.contact_x_m)
    if (!within(x.data(), 3, limits::position_m)) return fail(why, "contact position out of range");
  if (!within(m.contact_N.data(), m.contacts, limits::force_N)) return fail(why, "contact force out of range");
  for (const auto& sides : m.contact_side)
    if (sides[0] < -1 || sides[1] < -1) return fail(why, "contact of a negative side");
  if (!non_negative(m.step_ms, 1e6) || !non_negative(m.step_period_ms, 1e6)) return fail(why, "step time out of range");
  if (m.rows < 0 || m.sweeps < 0) return fail(why, "negative count");
  if (!within(m.body_force_N.data(), m.bodies, limits::force_N)) return fail(why, "body force out of range");
  if (!text_ok(m.hud_json, long_text)) return fail(why, "hud_json too long");
  if (!m.hud_json.empty() && !nlohmann::json::accept(m.hud_json)) return fail(why, "hud_json is no JSON");
  return true;
}

bool plausible(const insula_lcm::metrics_t& m, std::string& why) {
  if (m.session < 0 || m.time_us < 0) return fail(why, "negative session or time");
  if (!non_negative(m.sim_time_s, max_seconds)) return fail(why, "simulated time out of range");
  if (!flag_ok(m.at_end)) return fail(why, "flag is neither 0 nor 1");
  if (!text_ok(m.json, long_text)) return fail(why, "json too long");
  if (!nlohmann::json::accept(m.json)) return fail(why, "json is no JSON");
  return true;
}

bool plausible(const insula_lcm::scene_info_t& m, std::string& why) {
  if (m.session < 0 || m.time_us < 0) return fail(why, "negative session or time");
  for (const std::string* s : {&m.scene, &m.title, &m.bundle, &m.motion})
    if (!text_ok(*s, path_text)) return fail(why, "text too long");
  if (!text_ok(m.message, long_text)) return fail(why, "message too long");
  for (std::string_view s : {"loading", "running", "paused", "ended", "error"})
    if (m.state == s) return true;
  return fail(why, "unknown state");
}

bool plausible(const insula_lcm::servo_ticks_t& m, std::string& why) {
  if (m.session < 0 || m.sequence < 0 || m.time_us < 0) return fail(why, "negative session, sequence or time");
  if (!consistent(m) || m.ticks < 1 || m.ticks > 1000) return fail(why, "number of ticks out of range");
  for (std::size_t i = 0; i < m.after_us.size(); ++i)
    if (m.after_us[i] < (i == 0 ? 0 : m.after_us[i - 1])) return fail(why, "ticks are not in order");
  for (std::size_t at = 0; at < m.hands.size(); at += numbers_of_tick / 2) {
    const float* h = m.hands.data() + at;
    const double q[4] = {h[3], h[4], h[5], h[6]};
    if (!within(h, 3, limits::position_m)) return fail(why, "device position out of range");
    if (!unit_quaternion(q)) return fail(why, "device orientation is no unit quaternion");
    if (!within(h + 7, 3, 100)) return fail(why, "device force out of range");
  }
  return true;
}

bool plausible(const insula_lcm::session_step_t& m, std::string& why) {
  if (!consistent(m)) return fail(why, "counts disagree");
  if (m.number < 1) return fail(why, "number of the step is not positive");
  if (!non_negative(m.sim_time_s, max_seconds)) return fail(why, "simulated time out of range");
  if (!flag_ok(m.hashed)) return fail(why, "flag is neither 0 nor 1");
  if (!within(&m.energy_J, 1, 1e12) || !within(m.body_sum.data(), m.bodies, 1e12))
    return fail(why, "state out of range");
  for (const auto& i : m.input) {
    if (i.kind < 0 || i.kind > 5) return fail(why, "there is no such kind of input");
    if (i.index < 0) return fail(why, "negative index");
    if (!flag_ok(i.present) || !flag_ok(i.button1) || !flag_ok(i.button2)) return fail(why, "flag is neither 0 nor 1");
    if (i.kind == 0 && i.index > 1) return fail(why, "hand is neither left nor right");
    if (!within(i.p_m, 3, limits::position_m)) return fail(why, "position out of range");
    if (!unit_quaternion(i.q)) return fail(why, "orientation is no unit quaternion");
    if (!text_ok(i.verb, 512) || !text_ok(i.argument, 512)) return fail(why, "text too long");
    if (!non_negative(i.seconds, max_seconds)) return fail(why, "horizon out of range");
  }
  return true;
}

bool plausible(const insula_lcm::sim_event_t& m, std::string& why) {
  if (m.session < 0 || m.sequence < 0 || m.time_us < 0) return fail(why, "negative session, sequence or time");
  if (!non_negative(m.sim_time_s, max_seconds)) return fail(why, "simulated time out of range");
  if (m.kind.empty() || !word_ok(m.kind, 64)) return fail(why, "kind is no short word");
  if (!text_ok(m.id, short_text) || !text_ok(m.text, path_text)) return fail(why, "text too long");
  if (!within(&m.value, 1, 1e12)) return fail(why, "value out of range");
  if (m.hand < -1 || m.hand > 1) return fail(why, "there is no such hand");
  return true;
}

bool plausible(const insula_lcm::soft_guide_t& m, std::string& why) {
  if (m.session < 0 || m.sequence < 0 || m.time_us < 0) return fail(why, "negative session, sequence or time");
  if (m.number < 1) return fail(why, "guides are numbered from 1");
  if (m.hand != 0 && m.hand != 1) return fail(why, "hand is neither left nor right");
  const double* d = m.direction;
  if (!within(d, 3, 2) || std::abs(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1) > 2 * limits::unit_tolerance)
    return fail(why, "direction is no unit vector");
  if (!non_negative(m.force_N, limits::guide_N)) return fail(why, "force out of range");
  if (!(m.duration_s >= limits::guide_s[0] && m.duration_s <= limits::guide_s[1]))
    return fail(why, "duration out of range");
  return true;
}

bool plausible(const insula_lcm::user_command_t& m, std::string& why) {
  if (m.time_us < 0) return fail(why, "negative time");
  if (m.command.empty() || !word_ok(m.command, 64)) return fail(why, "command is no short word");
  if (!word_ok(m.sender, 64)) return fail(why, "sender is no short word");
  if (!text_ok(m.argument, path_text)) return fail(why, "argument too long");
  // Arguments of commands go into logs and onto screens.
  if (std::any_of(m.argument.begin(), m.argument.end(),
                  [](char c) { return (c >= 0 && c < 0x20 && c != '\t') || c == 0x7f; }))
    return fail(why, "argument holds control characters");
  return true;
}

bool consistent(const insula_lcm::device_state_t& m) { return m.hands >= 0 && m.hand.size() == std::size_t(m.hands); }

bool consistent(const insula_lcm::servo_ticks_t& m) {
  return m.ticks >= 0 && m.numbers == numbers_of_tick * m.ticks && m.after_us.size() == std::size_t(m.ticks) &&
         m.hands.size() == std::size_t(m.numbers);
}
bool consistent(const insula_lcm::session_step_t& m) {
  return m.bodies >= 0 && m.inputs >= 0 && m.body_sum.size() == std::size_t(m.bodies) &&
         m.input.size() == std::size_t(m.inputs);
}

bool consistent(const insula_lcm::render_frame_t& m) {
  const auto all_triples = [](const std::vector<std::vector<float>>& v) {
    return std::all_of(v.begin(), v.end(), [](const auto& x) { return x.size() == 3; });
  };
  if (m.bodies < 0 || m.channels < 0 || m.drawables < 0 || m.tools < 0 || m.contacts < 0) return false;
  if (m.body.size() != std::size_t(m.bodies) || m.body_force_N.size() != std::size_t(m.bodies)) return false;
  for (const auto& b : m.body)
    if (b.nodes < 0 || b.x_m.size() != std::size_t(b.nodes) || !all_triples(b.x_m)) return false;
  for (const auto& d : m.drawable)
    if (d.floats < 0 || d.data.size() != std::size_t(d.floats)) return false;
  return m.channel.size() == std::size_t(m.channels) && m.drawable.size() == std::size_t(m.drawables) &&
         m.tool.size() == std::size_t(m.tools) && m.contact_x_m.size() == std::size_t(m.contacts) &&
         all_triples(m.contact_x_m) && m.contact_N.size() == std::size_t(m.contacts) &&
         m.contact_side.size() == std::size_t(m.contacts) &&
         std::all_of(m.contact_side.begin(), m.contact_side.end(), [](const auto& x) { return x.size() == 2; });
}

}  // namespace insula
