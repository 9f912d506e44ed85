// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the results of a run's steps and writes report.json and metrics.csv for programs, report.html for people
// and technical.html for those who look after the machine.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/exercise.h"
#include "core/sim/reference_bands.h"
#include "core/sim/report.h"
#include "engine/reports/channel_record.h"
#include "engine/reports/exercise_outcome.h"
#include "engine/reports/force_record.h"
#include "engine/reports/metric_moments.h"
#include "engine/reports/own_runs.h"
#include "engine/reports/review.h"
#include "engine/reports/run_outcome.h"

namespace insula {

class Simulation;

/// Data of a run as a whole. It holds copies, so a report may be written while the simulation continues.
struct RunSummary {
  /// Takes title, step rate, state hash, and the present exercise and complications.
  void take(const Simulation& simulation);
  /// The field of that name; empty: a guest.
  std::string person() const;

  std::string title;                          ///< of the scene
  std::string scene, motion;                  ///< as named on the command line
  double step_rate_hz = 0;                    ///< of the engine
  std::string mode;                           ///< name of a SessionMode; empty: not a live session
  ReferenceBands bands;                       ///< for its metrics; empty: none
  MetricMoments moments;                      ///< of its metrics
  OwnRuns own_runs;                           ///< earlier ones of the same person
  std::string recording;                      ///< file that the run was recorded into; empty: none
  std::map<std::string, std::string> fields;  ///< what the person says of the session: "person", "level"
  std::string began;                          ///< local date and time of a live session; empty: none
  std::int64_t began_ms = 0;                  ///< the same, since 1970 UTC
  double wall_seconds = 0;                    ///< of all steps
  double fresh_forces_per_s = 0;              ///< number of distinct fresh forces per simulated second of contact
  std::array<double, 2> max_force_N{};        ///< on the hands: left, right
  std::uint64_t state_hash = 0;
  std::optional<ExerciseOutcome> exercise;            ///< none if the scene has none
  std::optional<ComplicationsOutcome> complications;  ///< likewise
  std::vector<std::string> bad_events;                ///< kinds that components declare as bad
  std::vector<std::string> unlisted_events;           ///< kinds that are left out of the report's list
};

class RunRecorder {
 public:
  /// Sample of one step, or of several consecutive steps: the largest value of each quantity, and the last time.
  struct Sample {
    float time_s = 0;
    std::int32_t steps = 1;
    std::array<float, stage_count> stage_ms{};
    float step_ms = 0;
    std::array<float, 2> hand_force_N{};  ///< sent to the hand
    std::array<float, 2> tool_force_N{};  ///< of all contacts of the hand's tool and of what it holds
    float separation_m = NAN;             ///< of the tips of both tools, the last one; NaN: there are not two
    float residual_N = 0;
    float residual_m = 0;
    float energy_J = 0;
    std::int32_t rows = 0, contacts = 0, sweeps = 0;
  };

  /// Every step of half an hour at 60 Hz, in 11 MB that are allocated at the start. A longer run needs no more memory.
  /// When it is full, neighbours are merged, and from then on a sample covers twice as many steps.
  static constexpr std::size_t max_samples = 120'000;
  /// `most`: largest number of samples, even and at least 2.
  explicit RunRecorder(std::size_t most = max_samples);

  /// Called after a step with its report, its events (with those of the exercise), the force on each hand (N; left,
  /// right) and the energy of all bodies, J.
  void record(const StepReport& report, const std::vector<Event>& events, const std::array<double, 2>& hand_force_N,
              double energy_J);
  /// Takes events that belong to no step, for example while paused.
  void note(const std::vector<Event>& events);
  void clear();

  std::int64_t steps() const { return steps_; }
  /// Number of steps that a sample covers. The last one may cover fewer.
  int steps_per_sample() const { return per_sample_; }
  const std::vector<Sample>& samples() const { return samples_; }
  /// The first events of the run, 5,000 at most.
  const std::vector<Event>& events() const { return events_; }
  std::int64_t events_left_out() const { return events_left_out_; }
  const ChannelRecord& channels() const { return channels_; }  ///< its curves have one sample for each of samples()
  const ForceRecord& forces() const { return forces_; }
  bool finite() const { return finite_; }
  const RunOutcome& outcome() const { return outcome_; }

 private:
  void add(const Sample& sample, const std::vector<double>& channels);

  std::size_t max_samples_;
  int per_sample_ = 1;
  std::int64_t steps_ = 0;
  std::vector<Sample> samples_;
  std::vector<Event> events_;
  std::int64_t events_left_out_ = 0;
  ChannelRecord channels_;
  ForceRecord forces_;
  bool finite_ = true;
  RunOutcome outcome_;
};

/// Series for a plot: at most `most` points, each with the largest value of its steps (for channels, the last).
struct RunSeries {
  std::vector<double> time_s, step_ms, residual_N, rows, contacts, sweeps, energy_J;
  std::vector<std::vector<double>> channels;  ///< by curve of the record, SI
  std::array<std::vector<double>, stage_count> stage_ms;
  std::array<std::vector<double>, 2> hand_force_N, tool_force_N;
  std::vector<double> separation_m;
};
RunSeries series_of(const RunRecorder& recorder, std::size_t most);

/// Names of the stages in reports.
const std::array<const char*, stage_count>& stage_names();

/// The percentile of `values` for the given share, by nearest rank; 0 if there are none.
double percentile(std::vector<double> values, double share);
/// 0 when there are none.
double largest(const std::vector<double>& values);
double mean(const std::vector<double>& values);

/// What `get` returns for each sample.
template <class Get>
std::vector<double> column(const RunRecorder& recorder, Get get) {
  std::vector<double> out;
  out.reserve(recorder.samples().size());
  for (const auto& s : recorder.samples()) out.push_back(double(get(s)));
  return out;
}

/// Empty if the scene has no exercise.
Review review_of(const RunRecorder& recorder, const RunSummary& summary);
std::string report_json(const RunRecorder& recorder, const RunSummary& summary);
std::string report_html(const RunRecorder& recorder, const RunSummary& summary);
/// The page for those who look after the machine: times of steps, rows, residuals.
std::string technical_html(const RunRecorder& recorder, const RunSummary& summary);
/// Writes report.json, metrics.csv, report.html and technical.html into `dir`, which is created. Throws InputError if
/// it cannot.
void write_report(const std::filesystem::path& dir, const RunRecorder& recorder, const RunSummary& summary);

}  // namespace insula
