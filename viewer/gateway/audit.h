// SPDX-License-Identifier: GPL-3.0-or-later
// A record of who asked for what: a line of JSON for each command and login, in files of bounded size.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace spdlog {
class logger;
}

namespace insula::gateway {

struct AuditLine {
  std::string address;     ///< of the machine
  std::string role;        ///< under which it was asked
  std::uint64_t page = 0;  ///< number of the connected page; 0: a request
  std::string command;     ///< with its argument
  bool accepted = false;
  std::string why;       ///< it was refused
  std::string who = {};  ///< the login; empty: the person at this machine
};

class Audit {
 public:
  /// file: is continued; its folder must exist. Older lines move to NAME.1 and NAME.2. Empty: nothing is kept. Throws
  /// InputError if it cannot be written.
  explicit Audit(const std::filesystem::path& file, std::size_t most_bytes = 2 << 20);
  ~Audit();
  /// Tells who is at this machine now; empty: nobody is known.
  void set_person(std::function<std::string()> person) { person_ = std::move(person); }
  /// Adds the time (UTC, ISO 8601). Texts of more than 400 bytes are cut.
  void write(const AuditLine& line);

 private:
  std::shared_ptr<spdlog::logger> log_;
  std::function<std::string()> person_;
};

}  // namespace insula::gateway
