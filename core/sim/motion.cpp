// SPDX-License-Identifier: GPL-3.0-or-later
// Reading and interpolating scripted motions.
#include "core/sim/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "core/base/decimal.h"
#include "core/base/diagnostic.h"
#include "core/base/input_error.h"

namespace insula {
namespace {

constexpr std::string_view header = "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2";
constexpr std::array<std::string_view, 11> columns = {"time_s", "hand", "px_m", "py_m",    "pz_m",   "qw",
                                                      "qx",     "qy",   "qz",   "button1", "button2"};
constexpr std::uintmax_t largest_file = 64u << 20;
constexpr double farthest_m = 1.0;             // a hand farther from the scene's origin indicates a wrong unit
constexpr double quaternion_tolerance = 1e-3;  // error of rounding to four digits

struct Reader {
  std::string_view name;
  int line = 0;

  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(fmt::format("{}:{}: error: {}", name, line, text));
  }

  double number(std::string_view field, std::string_view column) const {
    double value = 0;
    const char* end = field.data() + field.size();
    const auto [rest, status] = read_decimal(field.data(), end, value);
    if (field.empty() || status != std::errc() || rest != end)
      fail(fmt::format("{}: \"{}\" is not a number", column, field.substr(0, 40)));
    if (!std::isfinite(value)) fail(fmt::format("{} must be finite", column));
    return value;
  }

  bool button(std::string_view field, std::string_view column) const {
    if (field == "0") return false;
    if (field == "1") return true;
    fail(fmt::format("{}: \"{}\" is neither 0 nor 1", column, field.substr(0, 40)));
  }
};

std::string_view stripped(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

constexpr std::array<std::string_view, 3> verbs = {"exchange", "ask", "message"};

/// The text of a field that may stand in quotes.
std::string unquoted(const Reader& at, std::string_view field) {
  if (field.empty() || field.front() != '"') return std::string(field);
  std::string out;
  for (std::size_t i = 1; i < field.size(); ++i) {
    if (field[i] != '"') {
      out += field[i];
    } else if (i + 1 < field.size() && field[i + 1] == '"') {
      out += '"';
      ++i;
    } else if (i + 1 == field.size()) {
      return out;
    } else {
      at.fail("argument: text after the closing quote");
    }
  }
  at.fail("argument: the closing quote is missing");
}

/// `rest`: what follows "time,command,".
void read_command(const Reader& at, double time, std::string_view rest, Motion& motion) {
  const std::size_t comma = rest.find(',');
  if (comma == std::string_view::npos) at.fail("a command needs a verb and an argument: time_s,command,verb,argument");
  MotionCommand c;
  c.time_s = time;
  c.verb = stripped(rest.substr(0, comma));
  if (std::find(verbs.begin(), verbs.end(), c.verb) == verbs.end()) {
    const std::string near = nearest_name(c.verb, {verbs.begin(), verbs.end()});
    at.fail(fmt::format("verb: \"{}\" is none of exchange, ask, message{}", c.verb.substr(0, 40), did_you_mean(near)));
  }
  c.argument = unquoted(at, stripped(rest.substr(comma + 1)));
  if (c.argument.empty()) at.fail(fmt::format("{} needs an argument", c.verb));
  if (c.argument.size() > longest_argument) at.fail(fmt::format("argument: longer than {} bytes", longest_argument));
  for (const char ch : c.argument)
    if ((ch >= 0 && ch < 0x20 && ch != '\t') || ch == 0x7f) at.fail("argument: holds a control character");
  motion.add(std::move(c));
}

void read_row(const Reader& at, std::string_view line, Motion& motion) {
  // The argument of a command may hold commas, so its row is not split any further.
  if (const std::size_t first = line.find(','); first != std::string_view::npos) {
    const std::size_t second = line.find(',', first + 1);
    if (stripped(line.substr(first + 1, second == std::string_view::npos ? second : second - first - 1)) == "command") {
      const double time = at.number(stripped(line.substr(0, first)), columns[0]);
      if (time < 0) at.fail("time_s must not be negative");
      return read_command(at, time, second == std::string_view::npos ? std::string_view() : line.substr(second + 1),
                          motion);
    }
  }
  std::array<std::string_view, columns.size()> field;
  std::size_t count = 0;
  for (std::string_view rest = line;;) {
    const std::size_t comma = rest.find(',');
    if (count < field.size()) field[count] = stripped(rest.substr(0, comma));
    ++count;
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (count != columns.size()) at.fail(fmt::format("{} fields, expected {}", count, columns.size()));

  Motion::Key key;
  key.time_s = at.number(field[0], columns[0]);
  if (key.time_s < 0) at.fail("time_s must not be negative");
  if (field[1] != "left" && field[1] != "right")
    at.fail(fmt::format("hand: \"{}\" is neither left nor right", field[1].substr(0, 40)));
  const int hand = field[1] == "right" ? 1 : 0;
  for (int i = 0; i < 3; ++i) {
    key.sample.pose.p[i] = at.number(field[std::size_t(2 + i)], columns[std::size_t(2 + i)]);
    if (std::abs(key.sample.pose.p[i]) > farthest_m)
      at.fail(
          fmt::format("{}: {} m is outside the range -1 m to 1 m", columns[std::size_t(2 + i)], key.sample.pose.p[i]));
  }
  std::array<double, 4> q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = at.number(field[5 + i], columns[5 + i]);
  Quat rotation(q[0], q[1], q[2], q[3]);
  const double length = rotation.norm();
  if (!(std::abs(length - 1) <= quaternion_tolerance))
    at.fail(fmt::format("the quaternion has length {:.6g}, expected 1", length));
  key.sample.pose.q = rotation.normalized();
  key.sample.button1 = at.button(field[9], columns[9]);
  key.sample.button2 = at.button(field[10], columns[10]);

  if (motion.has(hand) && key.time_s <= motion.keys(hand).back().time_s)
    at.fail(fmt::format("time_s of the {} hand must rise: {} s after {} s", field[1], key.time_s,
                        motion.keys(hand).back().time_s));
  motion.add(hand, key);
}

}  // namespace

void Motion::add(int hand, const Key& key) {
  if (hand < 0 || hand > 1) throw InputError("a motion has hands 0 (left) and 1 (right)");
  auto& keys = keys_[std::size_t(hand)];
  if (!keys.empty() && !(key.time_s > keys.back().time_s)) throw InputError("the times of a motion must rise");
  keys.push_back(key);
}

void Motion::add(MotionCommand command) {
  const auto after = std::upper_bound(commands_.begin(), commands_.end(), command.time_s,
                                      [](double t, const MotionCommand& c) { return t < c.time_s; });
  commands_.insert(after, std::move(command));
}

HandSample Motion::at(int hand, double t) const noexcept {
  if (!has(hand)) return {};
  const auto& keys = keys_[std::size_t(hand)];
  if (!(t > keys.front().time_s)) return keys.front().sample;  // also NaN
  if (t >= keys.back().time_s) return keys.back().sample;
  const auto next =
      std::upper_bound(keys.begin(), keys.end(), t, [](double time, const Key& k) { return time < k.time_s; });
  const Key& b = *next;
  const Key& a = *(next - 1);
  const double s = (t - a.time_s) / (b.time_s - a.time_s);
  HandSample out = a.sample;
  out.pose.p = (1 - s) * a.sample.pose.p + s * b.sample.pose.p;
  out.pose.q = a.sample.pose.q.slerp(s, b.sample.pose.q).normalized();
  return out;
}

double Motion::duration() const {
  double end = 0;
  for (const auto& keys : keys_)
    if (!keys.empty()) end = std::max(end, keys.back().time_s);
  if (!commands_.empty()) end = std::max(end, commands_.back().time_s);
  return end;
}

bool Motion::bounds(int hand, Vec3& low, Vec3& high) const {
  if (!has(hand)) return false;
  const auto& keys = keys_[std::size_t(hand)];
  low = high = keys.front().sample.pose.p;
  for (const Key& k : keys) {
    low = low.cwiseMin(k.sample.pose.p);
    high = high.cwiseMax(k.sample.pose.p);
  }
  return true;
}

Motion parse_motion(std::string_view text, std::string_view name) {
  Motion motion;
  Reader at{name};
  bool header_seen = false;
  while (!text.empty()) {
    ++at.line;
    const std::size_t end = text.find('\n');
    const std::string_view line = stripped(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty()) continue;
    if (!header_seen) {
      if (line != header) at.fail(fmt::format("the first line must be \"{}\"", header));
      header_seen = true;
      continue;
    }
    read_row(at, line, motion);
  }
  if (at.line == 0) at.line = 1;
  if (!header_seen) at.fail(fmt::format("the first line must be \"{}\"", header));
  if (motion.empty()) at.fail("no rows");
  return motion;
}

Motion load_motion(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem)) throw InputError(name + ": error: no such file");
  const auto size = std::filesystem::file_size(path, problem);
  if (problem) throw InputError(name + ": error: cannot be read");
  if (size > largest_file) throw InputError(name + ": error: larger than 64 MB");
  std::ifstream in(path, std::ios::binary);
  std::string text(std::size_t(size), '\0');
  if (!in || !in.read(text.data(), std::streamsize(size))) throw InputError(name + ": error: cannot be read");
  return parse_motion(text, name);
}

}  // namespace insula
