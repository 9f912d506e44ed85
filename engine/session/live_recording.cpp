// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/live_recording.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include "core/base/input_error.h"
#include "engine/session/session_format.h"

namespace insula {
namespace fs = std::filesystem;

fs::path new_session_file(const fs::path& wanted, const fs::path& scene) {
  const bool named = wanted.extension() == session::extension;
  const fs::path folder = named ? fs::absolute(wanted).parent_path() : wanted;
  const std::string stem =
      named ? wanted.stem().string()
            : fmt::format("{:%Y%m%d_%H%M%S}_{}", fmt::localtime(std::time(nullptr)), scene.stem().string());
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": no folder can be made there: " + error.message());
  for (int n = 1;; ++n) {
    const fs::path file = folder / ((n == 1 ? stem : fmt::format("{}_{}", stem, n)) + session::extension);
    if (const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644); made >= 0) {
      ::close(made);
      return file;
    }
    if (errno != EEXIST) throw InputError(file.string() + ": cannot be made: " + std::strerror(errno));
  }
}

LiveRecording::LiveRecording(const fs::path& wanted, const Simulation& simulation, const SessionAbout& about) {
  if (wanted.empty()) return;
  try {
    recorder_ = std::make_unique<SessionRecorder>(new_session_file(wanted, about.scene), simulation, about);
    spdlog::info("recording into {}", recorder_->file().string());
  } catch (const std::exception& e) {
    failure_ = e.what();
    spdlog::error("nothing is recorded: {}. The session goes on", failure_);
  }
}

void LiveRecording::step(const Simulation& simulation) {
  if (!recorder_) return;
  stepped_ = true;
  recorder_->step(simulation);
}

void LiveRecording::end_pass(const Simulation& simulation) {
  if (recorder_ && stepped_) recorder_->end_pass(simulation);
}

void LiveRecording::note(const std::vector<Event>& events) {
  if (recorder_) recorder_->note(events);
}

void LiveRecording::review(const std::string& json) {
  if (recorder_) recorder_->review(json);
}

void LiveRecording::hands(mcap::Bytes device_state) {
  if (recorder_) recorder_->hands(device_state);
}

void LiveRecording::ticks(mcap::Bytes servo_ticks) {
  if (recorder_) recorder_->ticks(servo_ticks);
}

void LiveRecording::close(const Simulation& simulation) {
  if (!recorder_) return;
  recorder_->close(simulation);
  std::error_code ignored;
  if (!stepped_) fs::remove(recorder_->file(), ignored);
  recorder_.reset();
}

std::string LiveRecording::file() const {
  return recorder_ && recorder_->failure().empty() ? recorder_->file().string() : std::string();
}

std::string LiveRecording::failure() const { return recorder_ ? recorder_->failure() : failure_; }

}  // namespace insula
