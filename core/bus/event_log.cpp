// SPDX-License-Identifier: GPL-3.0-or-later
// The file format of lcm-logger.
#include "core/bus/event_log.h"

#include <fmt/format.h>

#include <array>

#include "core/base/input_error.h"
#include "core/bus/byte_io.h"
#include "core/bus/channels.h"

namespace insula {
namespace {

constexpr std::uint32_t mark = 0xEDA1DA01;
constexpr std::size_t head_bytes = 28;
constexpr int max_name = 63;                   // LCM_MAX_CHANNEL_NAME_LENGTH
constexpr int max_message = 64 * 1024 * 1024;  // other programs may share the bus; our messages are far smaller

}  // namespace

EventLog::EventLog(const std::filesystem::path& file) : file_(file), in_(file, std::ios::binary) {
  if (!in_ || std::filesystem::is_directory(file)) throw InputError(fmt::format("{}: cannot be read", file.string()));
  if (in_.peek() == std::ifstream::traits_type::eof())
    throw InputError(fmt::format("{}: the log is empty", file.string()));
}

void EventLog::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: byte {}: {}", file_.string(), at_, what));
}

bool EventLog::next(LogEvent& event) {
  std::array<std::uint8_t, head_bytes> head;
  in_.read(reinterpret_cast<char*>(head.data()), head_bytes);
  const auto got = std::size_t(in_.gcount());
  if (got == 0) return false;
  if (got >= 4 && wire::load32(head.data()) != mark)
    fail(at_ == 0 ? "this is no log of lcm-logger" : "no event begins here: the log is damaged");
  if (got < head_bytes) fail("the log ends within an event");
  event.number = std::int64_t(wire::load64(head.data() + 4));
  event.time_us = std::int64_t(wire::load64(head.data() + 12));
  const auto name = std::int32_t(wire::load32(head.data() + 20)), size = std::int32_t(wire::load32(head.data() + 24));
  if (name < 1 || name > max_name || size < 0 || size > max_message)
    fail(fmt::format("an event with a name of {} and a message of {} bytes: the log is damaged", name, size));
  event.channel.resize(std::size_t(name));
  event.message.resize(std::size_t(size));
  in_.read(event.channel.data(), name);
  if (in_.gcount() == name) in_.read(reinterpret_cast<char*>(event.message.data()), size);
  if (!in_) fail("the log ends within an event");
  at_ += head_bytes + std::uint64_t(name) + std::uint64_t(size);
  return true;
}

}  // namespace insula
