// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the results of a run's steps; report.json.
#include "engine/reports/report_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/sim/simulation.h"
#include "engine/reports/hints_report.h"
#include "engine/reports/metrics_report.h"
#include "engine/reports/perceptible_forces.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t max_events = 5000;
constexpr std::size_t max_moments = 2000;

Json mean_max(const std::vector<double>& v) { return {{"mean", mean(v)}, {"max", largest(v)}}; }

Json perceptible_json(const PerceptibleForces& perceptible) {
  Json out = {{"touching_s", perceptible.touching_s},
              {"median_N", perceptible.median_N},
              {"max_N", perceptible.largest_N},
              {"above_friction", Json::array()}};
  for (std::size_t d = 0; d < known_frictions.size(); ++d)
    out["above_friction"].push_back({{"devices", known_frictions[d].devices},
                                     {"friction_N", known_frictions[d].friction_N},
                                     {"time_share", perceptible.above[d].time_share},
                                     {"range_share", perceptible.above[d].range_share},
                                     {"scale_for_half", perceptible.above[d].scale}});
  return out;
}

Json series_json(const RunRecorder& recorder, const RunSeries& s) {
  Json stages;
  for (std::size_t k = 0; k < stage_count; ++k) stages[stage_names()[k]] = s.stage_ms[k];
  Json channels = Json::object();
  for (const ChannelRecord::Known& c : recorder.channels().channels())
    if (c.curve >= 0) channels[c.id] = s.channels[std::size_t(c.curve)];
  return {{"time_s", s.time_s},
          {"hand_force_N", {{"left", s.hand_force_N[0]}, {"right", s.hand_force_N[1]}}},
          {"tool_force_N", {{"left", s.tool_force_N[0]}, {"right", s.tool_force_N[1]}}},
          {"channels", channels},
          {"rows", s.rows},
          {"contacts", s.contacts},
          {"sweeps", s.sweeps},
          {"residual_N", s.residual_N},
          {"energy_J", s.energy_J},
          {"step_ms", s.step_ms},
          {"stage_ms", stages}};
}

void write(const std::filesystem::path& file, const std::string& text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out)
    throw InputError(
        fmt::format("{}: cannot be written{}", file.string(), errno ? fmt::format(": {}", std::strerror(errno)) : ""));
}

/// Merges `b`, the next sample, into `a`.
void join(RunRecorder::Sample& a, const RunRecorder::Sample& b) {
  const auto larger = [](auto& x, auto y) { x = std::max(x, y); };
  a.time_s = b.time_s;
  a.separation_m = b.separation_m;
  a.steps += b.steps;
  for (std::size_t k = 0; k < stage_count; ++k) larger(a.stage_ms[k], b.stage_ms[k]);
  larger(a.step_ms, b.step_ms);
  for (std::size_t h = 0; h < 2; ++h) {
    larger(a.hand_force_N[h], b.hand_force_N[h]);
    larger(a.tool_force_N[h], b.tool_force_N[h]);
  }
  larger(a.residual_N, b.residual_N);
  larger(a.residual_m, b.residual_m);
  larger(a.energy_J, b.energy_J);
  larger(a.rows, b.rows);
  larger(a.contacts, b.contacts);
  larger(a.sweeps, b.sweeps);
}

}  // namespace

RunRecorder::RunRecorder(std::size_t most) : max_samples_(most) { samples_.reserve(most); }

void RunRecorder::record(const StepReport& r, const std::vector<Event>& events,
                         const std::array<double, 2>& hand_force_N, double energy_J) {
  Sample s;
  s.time_s = float(r.time);
  for (std::size_t k = 0; k < stage_count; ++k) s.stage_ms[k] = float(r.stage_ms[k]);
  s.step_ms = float(r.step_ms);
  for (std::size_t h = 0; h < 2; ++h) s.hand_force_N[h] = float(hand_force_N[h]);
  for (const auto& t : r.tools)
    if (t.hand == 0 || t.hand == 1) s.tool_force_N[std::size_t(t.hand)] += float(t.contact_force);
  if (r.hands[0].tool && r.hands[1].tool) s.separation_m = float((r.hands[0].tip.p - r.hands[1].tip.p).norm());
  s.residual_N = float(r.solve.residual_N);
  s.residual_m = float(r.solve.residual_m);
  s.energy_J = float(energy_J);
  s.rows = r.rows;
  s.contacts = int(r.contacts.size());
  s.sweeps = r.solve.sweeps;
  if (r.channel_table && !channels_.begun()) channels_.begin(*r.channel_table, max_samples_);
  channels_.observe(r.channels);
  forces_.observe(r);
  add(s, r.channels);
  note(events);
  finite_ = finite_ && r.finite;
}

void RunRecorder::note(const std::vector<Event>& events) {
  for (const auto& e : events) {
    if (events_.size() < max_events) events_.push_back(e);
    else ++events_left_out_;
  }
  outcome_.note(events);
}

void RunRecorder::add(const Sample& sample, const std::vector<double>& channels) {
  ++steps_;
  if (!samples_.empty() && samples_.back().steps < per_sample_) {
    channels_.replace_last(channels);
    return join(samples_.back(), sample);
  }
  if (samples_.size() == max_samples_) {
    for (std::size_t i = 0; i < max_samples_ / 2; ++i) {
      samples_[i] = samples_[2 * i];
      join(samples_[i], samples_[2 * i + 1]);
    }
    samples_.resize(max_samples_ / 2);
    channels_.halve(max_samples_);
    per_sample_ *= 2;
  }
  samples_.push_back(sample);
  channels_.push(channels);
}

void RunRecorder::clear() { *this = RunRecorder(max_samples_); }

void RunSummary::take(const Simulation& simulation) {
  step_rate_hz = 1 / simulation.h();
  title = simulation.scene().title();
  state_hash = simulation.state_hash();
  exercise.reset();
  complications.reset();
  if (simulation.exercise()) exercise.emplace(*simulation.exercise());
  if (simulation.complications()) complications.emplace(*simulation.complications());
  bad_events.clear();
  unlisted_events.clear();
  for (const Component* c : simulation.scene().components())
    for (const EventKind* e : c->event_kinds()) {
      if (e->spec().bad) bad_events.push_back(e->name());
      if (!e->spec().listed) unlisted_events.push_back(e->name());
    }
}

std::string RunSummary::person() const {
  const auto found = fields.find("person");
  return found == fields.end() ? std::string() : found->second;
}

const std::array<const char*, stage_count>& stage_names() {
  static constexpr std::array<const char*, stage_count> names{"free_motion", "collision", "build",
                                                              "solve",       "correct",   "publish"};
  return names;
}

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x;
  return v.empty() ? 0 : sum / double(v.size());
}
double largest(const std::vector<double>& v) { return v.empty() ? 0 : *std::max_element(v.begin(), v.end()); }

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank =
      std::size_t(std::clamp(std::ceil(share * double(values.size())) - 1, 0.0, double(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(rank), values.end());
  return values[rank];
}

RunSeries series_of(const RunRecorder& recorder, std::size_t most) {
  RunSeries out;
  const auto& samples = recorder.samples();
  const std::size_t bin = std::max<std::size_t>(1, (samples.size() + most - 1) / std::max<std::size_t>(1, most));
  const auto add = [&](std::vector<double>& to, std::size_t begin, std::size_t end, auto get) {
    double v = double(get(samples[begin]));
    for (std::size_t i = begin + 1; i < end; ++i) v = std::max(v, double(get(samples[i])));
    to.push_back(v);
  };
  using S = RunRecorder::Sample;
  out.channels.resize(std::size_t(recorder.channels().curves()));
  for (std::size_t begin = 0; begin < samples.size(); begin += bin) {
    const std::size_t end = std::min(begin + bin, samples.size());
    add(out.time_s, begin, end, [](const S& s) { return s.time_s; });
    add(out.step_ms, begin, end, [](const S& s) { return s.step_ms; });
    add(out.residual_N, begin, end, [](const S& s) { return s.residual_N; });
    add(out.energy_J, begin, end, [](const S& s) { return s.energy_J; });
    add(out.rows, begin, end, [](const S& s) { return s.rows; });
    add(out.contacts, begin, end, [](const S& s) { return s.contacts; });
    add(out.sweeps, begin, end, [](const S& s) { return s.sweeps; });
    out.separation_m.push_back(double(samples[end - 1].separation_m));
    for (int c = 0; c < recorder.channels().curves(); ++c)
      out.channels[std::size_t(c)].push_back(recorder.channels().sample(end - 1, c));
    for (std::size_t k = 0; k < stage_count; ++k)
      add(out.stage_ms[k], begin, end, [k](const S& s) { return s.stage_ms[k]; });
    for (std::size_t h = 0; h < 2; ++h) {
      add(out.hand_force_N[h], begin, end, [h](const S& s) { return s.hand_force_N[h]; });
      add(out.tool_force_N[h], begin, end, [h](const S& s) { return s.tool_force_N[h]; });
    }
  }
  return out;
}

std::string report_json(const RunRecorder& recorder, const RunSummary& summary) {
  using S = RunRecorder::Sample;
  const auto& samples = recorder.samples();
  const double sim_seconds = samples.empty() ? 0 : double(samples.back().time_s);
  Json json;
  json["for_training_only"] = true;
  json["title"] = summary.title;
  json["scene"] = summary.scene;
  json["motion"] = summary.motion;
  if (!summary.mode.empty()) json["mode"] = summary.mode;
  if (!summary.fields.empty()) json["fields"] = summary.fields;
  if (!summary.began.empty()) json["began"] = summary.began;
  json["step_rate_hz"] = summary.step_rate_hz;
  json["steps"] = recorder.steps();
  json["steps_per_sample"] = recorder.steps_per_sample();
  json["sim_seconds"] = sim_seconds;
  json["wall_seconds"] = summary.wall_seconds;
  json["real_time_factor"] = summary.wall_seconds > 0 ? sim_seconds / summary.wall_seconds : 0;
  for (std::size_t k = 0; k < stage_count; ++k) {
    const auto v = column(recorder, [k](const S& s) { return s.stage_ms[k]; });
    json["stage_ms"][stage_names()[k]] = {{"p50", percentile(v, 0.5)}, {"p95", percentile(v, 0.95)}};
  }
  const auto step = column(recorder, [](const S& s) { return s.step_ms; });
  json["step_ms"] = {{"p50", percentile(step, 0.5)}, {"p95", percentile(step, 0.95)}, {"max", largest(step)}};
  json["rows"] = mean_max(column(recorder, [](const S& s) { return s.rows; }));
  json["contacts"] = mean_max(column(recorder, [](const S& s) { return s.contacts; }));
  json["sweeps"] = mean_max(column(recorder, [](const S& s) { return s.sweeps; }));
  const auto newtons = column(recorder, [](const S& s) { return s.residual_N; });
  json["residual"] = {{"p50", percentile(newtons, 0.5)}, {"max", largest(newtons)}, {"unit", "N"}};
  const auto metres = column(recorder, [](const S& s) { return s.residual_m; });
  json["residual_m"] = {{"p50", percentile(metres, 0.5)}, {"max", largest(metres)}};
  json["haptic"] = {{"fresh_forces_per_s", summary.fresh_forces_per_s},
                    {"max_force_N", {{"left", summary.max_force_N[0]}, {"right", summary.max_force_N[1]}}},
                    {"perceptible",
                     {{"left", perceptible_json(perceptible_forces(recorder, 0))},
                      {"right", perceptible_json(perceptible_forces(recorder, 1))}}}};
  json["exercise"] = exercise_json(summary.exercise);
  json["hints"] = cues_json(summary.exercise ? summary.exercise->cues : std::vector<Cue>{});
  json["metrics"] = metrics_json(summary.exercise ? summary.exercise->metrics : std::vector<MetricValue>{});
  if (summary.exercise) {
    add_bands(json["metrics"], summary.exercise->metrics, summary.bands);
    json["review"] = review_json(review_of(recorder, summary));
  }
  if (summary.complications) json["complications"] = complications_json(*summary.complications);
  json["force_on"] = recorder.forces().json();
  json["channels"] = recorder.channels().json();
  recorder.outcome().add_to(json);
  json["finite"] = recorder.finite();
  json["state_hash"] = fmt::format("{:016x}", summary.state_hash);
  json["events"] = Json::array();
  for (const auto& e : recorder.events())
    json["events"].push_back(
        {{"time_s", e.time}, {"kind", e.kind}, {"id", e.id}, {"text", e.text}, {"value", e.value}});
  json["events_left_out"] = recorder.events_left_out();
  json["series"] = series_json(recorder, series_of(recorder, max_moments));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_report(const std::filesystem::path& dir, const RunRecorder& recorder, const RunSummary& summary) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error) throw InputError(dir.string() + ": cannot be created: " + error.message());
  write(dir / "report.json", report_json(recorder, summary));
  if (summary.exercise) write(dir / "metrics.csv", metrics_csv(summary.exercise->metrics));
  write(dir / "report.html", report_html(recorder, summary));
  write(dir / "technical.html", technical_html(recorder, summary));
}

}  // namespace insula
