// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/session_reports.h"

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <system_error>
#include <utility>

#include "core/base/input_error.h"
#include "engine/reports/stored_run.h"
#include "training/store/store.h"

namespace fs = std::filesystem;

namespace insula {

fs::path new_report_folder(const fs::path& root, const std::string& name) {
  std::error_code error;
  fs::create_directories(root, error);
  for (int n = 1; !error; ++n) {
    const fs::path folder = root / (n == 1 ? name : fmt::format("{}_{}", name, n));
    if (fs::create_directory(folder, error)) return folder;
  }
  throw InputError(root.string() + ": no folder can be made there: " + error.message());
}

SessionReports::SessionReports(fs::path root, fs::path scene, std::string motion,
                               std::map<std::string, std::string> fields)
    : root_(std::move(root)),
      scene_(std::move(scene)),
      motion_(std::move(motion)),
      fields_(std::move(fields)),
      recorder_(root_.empty() ? 0 : RunRecorder::max_samples) {
  if (root_.empty()) return;
  // Reported at the start instead of after an hour of work.
  std::error_code error;
  fs::create_directories(root_, error);
  if (!error && ::access(root_.c_str(), W_OK | X_OK) != 0) error.assign(errno, std::generic_category());
  if (error)
    spdlog::error("{}: no report can be written there: {}; name another folder with --report. The session goes on",
                  root_.string(), error.message());
}

void SessionReports::hear(const insula_lcm::device_state_t& hands) {
  for (const auto& h : hands.hand) {
    if (h.hand < 0 || h.hand > 1) continue;
    const auto i = std::size_t(h.hand);
    hands_.force_N[i] = h.connected ? std::hypot(h.force_N[0], h.force_N[1], h.force_N[2]) : 0;
    hands_.largest_N[i] = std::max(hands_.largest_N[i], hands_.force_N[i]);
  }
}

void SessionReports::hear(const insula_lcm::haptic_status_t& status) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!(status.fresh_forces_per_s[i] > 0)) continue;
    hands_.fresh[i] += status.fresh_forces_per_s[i];
    ++hands_.seconds[i];
  }
}

void SessionReports::step(const Simulation& simulation, bool touched, bool followed) {
  const Exercise* exercise = simulation.exercise();
  // An instructor asked for more after the end: a new report begins.
  if (written_ && exercise && exercise->log().state() == ExerciseState::running) begin();
  if (root_.empty() || written_) return;
  if (recorder_.steps() == 0) began_ = std::time(nullptr);
  const std::array<double, 2> force = touched ? hands_.largest_N : std::array<double, 2>{};
  hands_.largest_N = hands_.force_N;
  recorder_.record(simulation.report(), simulation.events(), force, simulation.energy());
  for (std::size_t i = 0; i < 2; ++i) summary_.max_force_N[i] = std::max(summary_.max_force_N[i], force[i]);
  summary_.wall_seconds += simulation.report().step_ms / 1000;
  followed_ = followed;
  if (exercise) summary_.moments.observe(simulation.time(), *exercise);
  if (exercise && exercise->log().state() != ExerciseState::running) write(simulation);
}

void SessionReports::note(const std::vector<Event>& events) {
  if (!root_.empty() && !written_) recorder_.note(events);
}

void SessionReports::end_run(const Simulation& simulation) {
  if (root_.empty()) return;
  if (!written_ && recorder_.steps() > 0) write(simulation);
  begin();
}

void SessionReports::begin() {
  recorder_.clear();
  summary_ = {};
  hands_ = {};
  written_ = false;
  std::lock_guard lock(done_->mutex);
  done_->path.clear();
  ++done_->pass;
}

std::string SessionReports::last_report() const {
  std::lock_guard lock(done_->mutex);
  return done_->path;
}

std::vector<std::string> SessionReports::take_reviews() {
  std::lock_guard lock(done_->mutex);
  return std::exchange(done_->reviews, {});
}

void SessionReports::wait() {
  if (writing_.valid()) writing_.wait();
}

/// The smaller value of the hands that had contact, as in a run.
double SessionReports::fresh_forces_per_s() const {
  double least = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (hands_.seconds[i] == 0) continue;
    const double mean = hands_.fresh[i] / hands_.seconds[i];
    least = least > 0 ? std::min(least, mean) : mean;
  }
  return least;
}

void SessionReports::write(const Simulation& simulation) {
  written_ = true;
  summary_.take(simulation);
  summary_.scene = scene_.string();
  summary_.motion = followed_ ? motion_ : "";
  summary_.mode = name_of(mode_);
  summary_.fields = fields_;
  summary_.bands = bands_;
  summary_.recording = recording_;
  summary_.fresh_forces_per_s = fresh_forces_per_s();
  const std::tm began = fmt::localtime(began_);
  summary_.began = fmt::format("{:%Y-%m-%d %H:%M:%S}", began);
  summary_.began_ms = 1000 * std::int64_t(began_);
  std::string name = fmt::format("{:%Y-%m-%d_%H-%M-%S}_{}", began, scene_.stem().string());
  const auto failed = [](const std::exception& e) {
    spdlog::error("a report was not written: {}. The session goes on", e.what());
  };
  wait();  // folders are created in the order of the runs
  try {
    writing_ = std::async(std::launch::async, [root = root_, name = std::move(name), recorder = std::move(recorder_),
                                               summary = summary_, store = store_, failed, done = done_,
                                               pass = done_->pass, recorded = recorded_pass_]() mutable {
      try {
        const fs::path folder = new_report_folder(root, name);
        summary.own_runs = own_runs(root, summary.title, summary.person(), folder);
        write_report(folder, recorder, summary);
        const fs::path page = fs::absolute(folder / "report.html");
        spdlog::info("report: {}", page.string());
        if (!store.empty() && summary.exercise)
          training::Store(store).add(stored_run(recorder, summary, page.string()));
        std::string review = review_message(recorded, review_of(recorder, summary));
        std::lock_guard lock(done->mutex);
        done->reviews.push_back(std::move(review));
        if (done->pass == pass) done->path = page.string();
      } catch (const std::exception& e) {
        failed(e);
      }
    });
  } catch (const std::system_error& e) {  // no thread is available
    failed(e);
  }
}

}  // namespace insula
