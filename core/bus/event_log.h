// SPDX-License-Identifier: GPL-3.0-or-later
// Strict reader of lcm-logger's logs. Damage is an error with its position and is never skipped silently.
//
// An event, all numbers big-endian: uint32 0xEDA1DA01, int64 number, int64 time (us since 1970), int32 length of the
// channel's name, int32 length of the message, name, message.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace insula {

struct LogEvent {
  std::int64_t number = 0;
  std::int64_t time_us = 0;  ///< when it was received, since 1970
  std::string channel;
  std::vector<std::uint8_t> message;
};

class EventLog {
 public:
  /// Throws InputError when the file cannot be read or does not begin with an event.
  explicit EventLog(const std::filesystem::path& file);
  /// False at the end. Throws InputError "file: byte N: ..." where the log is damaged or cut short. All events before
  /// are complete.
  bool next(LogEvent& event);

 private:
  [[noreturn]] void fail(const std::string& what) const;
  std::filesystem::path file_;
  std::ifstream in_;
  std::uint64_t at_ = 0;  ///< of the present event
};

}  // namespace insula
