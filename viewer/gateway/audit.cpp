// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/audit.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/rotating_file_sink.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t older_files = 2, longest_text = 400;

std::string utc_now() {
  const auto now = std::chrono::system_clock::now();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)), ms);
}

std::string cut(const std::string& text) { return text.substr(0, longest_text); }

}  // namespace

Audit::Audit(const fs::path& file, std::size_t most_bytes) {
  if (file.empty()) return;
  spdlog::file_event_handlers handlers;
  // It tells what persons did.
  handlers.after_open = [](const spdlog::filename_t& name, std::FILE*) {
    std::error_code ignored;
    fs::permissions(name, fs::perms::owner_read | fs::perms::owner_write, ignored);
  };
  try {
    const auto sink =
        std::make_shared<spdlog::sinks::rotating_file_sink_st>(file.string(), most_bytes, older_files, false, handlers);
    sink->set_pattern("%v");
    log_ = std::make_shared<spdlog::logger>("audit", sink);
    log_->flush_on(spdlog::level::info);
  } catch (const spdlog::spdlog_ex& e) {
    throw InputError(fmt::format("the record of commands cannot be written: {}", e.what()));
  }
}

Audit::~Audit() = default;

void Audit::write(const AuditLine& line) {
  if (!log_) return;
  nlohmann::ordered_json json{{"time", utc_now()}, {"address", line.address}, {"role", line.role}};
  const std::string person = line.who.empty() && person_ ? person_() : line.who;
  json["who"] = person.empty() ? "guest" : cut(person);
  if (line.page != 0) json["page"] = line.page;
  json["command"] = cut(line.command);
  json["accepted"] = line.accepted;
  if (!line.why.empty()) json["why"] = cut(line.why);
  log_->info("{}", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace insula::gateway
