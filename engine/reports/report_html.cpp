// SPDX-License-Identifier: GPL-3.0-or-later
// report.html: one file that needs no other, dark on white, fit to print; well-formed XML as well.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/spoken.h"
#include "engine/live/session_mode.h"
#include "engine/reports/hints_report.h"
#include "engine/reports/metrics_report.h"
#include "engine/reports/perceptible_forces.h"
#include "engine/reports/report_writer.h"
#include "engine/reports/svg_plot.h"

namespace insula {
namespace {

constexpr std::size_t plotted_moments = 700;  // about one for each pixel
constexpr const char* left_colour = "#1f6fb2";
constexpr const char* right_colour = "#c2410c";
constexpr const char* goal_colour = "#15803d";
constexpr const char* fault_colour = "#b91c1c";

constexpr const char* style = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 800px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; margin: 0 0 .1em; } h2 { font-size: 1.15em; margin: 1.6em 0 .4em; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; width: 100%; } th, td { text-align: left; padding: .25em .6em; border-bottom: 1px solid #e3e3e3; vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; } .notice { font-weight: bold; }
.good { color: #15803d; } .bad { color: #b91c1c; } .quiet { color: #666; } svg { width: 100%; height: auto; display: block; margin: .6em 0; }
code { font-size: .9em; overflow-wrap: anywhere; }
@media print { body { margin: 0; max-width: none; font-size: 11pt; } svg, table { break-inside: avoid; } h2 { break-after: avoid; } }
)";

std::string row(const std::string& name, const std::string& value) {
  return fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", escaped(name), escaped(value));
}

std::string state_part(const ExerciseLog& log) {
  switch (log.state()) {
    case ExerciseState::running: return "<p>The run ended before the exercise did.</p>\n";
    case ExerciseState::done: return fmt::format("<p class=\"good\">✓ Completed after {:.1f} s.</p>\n", log.end_time());
    case ExerciseState::failed:
      return fmt::format("<p class=\"bad\">✗ Failed after {:.1f} s: {}</p>\n", log.end_time(),
                         escaped(log.last_message()));
  }
  return {};
}

std::string goals_part(const ExerciseLog& log) {
  if (log.goals().empty()) return {};
  std::string out =
      "<table><thead><tr><th>Goal</th><th>Reached</th><th class=\"n\">Time (s)</th></tr></thead><tbody>\n";
  for (const auto& g : log.goals())
    out += fmt::format("<tr><td>{}{}</td><td class=\"{}\">{}</td><td class=\"n\">{}</td></tr>\n", escaped(g.text),
                       g.required ? "" : " <span class=\"quiet\">(optional)</span>", g.done ? "good" : "bad",
                       g.done ? "✓ yes" : "✗ no", g.done ? fmt::format("{:.1f}", g.time) : "");
  return out + "</tbody></table>\n";
}

/// "12.3, 40.1 and 3 more".
std::string times_text(const FaultState& fault) {
  std::string out;
  for (const double t : fault.times) out += fmt::format("{}{:.1f}", out.empty() ? "" : ", ", t);
  const std::size_t more = std::size_t(fault.count) - std::min(fault.times.size(), std::size_t(fault.count));
  return more > 0 ? fmt::format("{} and {} more", out, more) : out;
}

std::string faults_part(const ExerciseLog& log) {
  if (log.faults().empty()) return {};
  std::string out =
      "<table><thead><tr><th>Fault</th><th class=\"n\">Count</th><th>At (s)</th><th>What to "
      "do</th></tr></thead><tbody>\n";
  for (const auto& f : log.faults())
    out += fmt::format("<tr><td>{}</td><td class=\"n {}\">{} {}</td><td>{}</td><td>{}</td></tr>\n", escaped(f.text),
                       f.count ? "bad" : "good", f.count ? "✗" : "✓", f.count, times_text(f),
                       f.count ? escaped(f.advice) : "");
  return out + "</tbody></table>\n";
}

std::string measures_part(const ExerciseLog& log) {
  if (log.measures().empty()) return {};
  std::string out =
      "<table><thead><tr><th>Measure</th><th class=\"n\">At the end</th><th>Good "
      "is</th><th></th></tr></thead><tbody>\n";
  for (const auto& m : log.measures())
    out += fmt::format("<tr><td>{}</td><td class=\"n {}\">{}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n",
                       escaped(m.text),
                       m.good > 0   ? "good"
                       : m.good < 0 ? "bad"
                                    : "",
                       m.known ? escaped(fmt::format("{:.3g} {}", m.value, m.unit)) : "", escaped(m.limit),
                       m.good > 0   ? "good"
                       : m.good < 0 ? "bad"
                                    : "",
                       !m.known     ? ""
                       : m.good > 0 ? "✓"
                       : m.good < 0 ? "✗"
                                    : "");
  return out + "</tbody></table>\n";
}

std::string clocks_part(const ExerciseLog& log) {
  if (log.timers().empty()) return {};
  std::string out =
      "<table><thead><tr><th>Clock</th><th class=\"n\">Longest (s)</th><th class=\"n\">Limit "
      "(s)</th></tr></thead><tbody>\n";
  for (const auto& t : log.timers())
    out += fmt::format("<tr><td>{}</td><td class=\"n {}\">{:.1f}</td><td class=\"n\">{}</td></tr>\n", escaped(t.text),
                       t.limit > 0 && t.longest > t.limit ? "bad" : "", t.longest,
                       t.limit > 0 ? fmt::format("{:.0f}", t.limit) : "");
  return out + "</tbody></table>\n";
}

std::string exercise_part(const ExerciseOutcome& exercise) {
  const ExerciseLog& log = exercise.log;
  std::string out = fmt::format("<h2>Exercise: {}</h2>\n", escaped(exercise.title));
  if (!exercise.text.empty()) out += fmt::format("<p class=\"quiet\">{}</p>\n", escaped(exercise.text));
  return out + state_part(log) + goals_part(log) + faults_part(log) + measures_part(log) + clocks_part(log);
}

std::string events_part(const RunRecorder& recorder, const RunSummary& summary) {
  const auto among = [](const std::vector<std::string>& kinds, const std::string& kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  std::string rows;
  std::size_t shown = 0, more = 0;
  for (const auto& e : recorder.events()) {
    if (among(summary.unlisted_events, e.kind) || e.kind == "command" || e.kind == "refused")
      continue;  // shown in another place
    if (++shown > 200) {
      ++more;
      continue;
    }
    rows += fmt::format("<tr><td class=\"n\">{:.2f}</td><td class=\"{}\">{}</td><td>{}</td></tr>\n", e.time,
                        e.kind == "fault" || among(summary.bad_events, e.kind) || e.kind == "goal_lost" ? "bad"
                        : e.kind == "goal"                                                              ? "good"
                                                                                                        : "",
                        escaped(e.kind), escaped(e.text.empty() ? e.id : e.text));
  }
  if (rows.empty()) return "";
  std::string out =
      "<h2>What happened</h2>\n<table><thead><tr><th class=\"n\">Time "
      "(s)</th><th>Kind</th><th>Text</th></tr></thead><tbody>\n" +
      rows + "</tbody></table>\n";
  const std::int64_t left_out = std::int64_t(more) + recorder.events_left_out();
  if (left_out > 0) out += fmt::format("<p class=\"quiet\">{} more are not shown.</p>\n", left_out);
  return out;
}

std::string stage_table(const RunRecorder& recorder) {
  using S = RunRecorder::Sample;
  std::string out =
      "<table><thead><tr><th>Stage</th><th class=\"n\">median (ms)</th><th class=\"n\">95th percentile (ms)</th><th "
      "class=\"n\">largest (ms)</th></tr></thead><tbody>\n";
  const auto line = [&](const std::string& name, const std::vector<double>& v) {
    out += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.3f}</td></tr>\n",
        spoken(name), percentile(v, 0.5), percentile(v, 0.95), largest(v));
  };
  for (std::size_t k = 0; k < stage_count; ++k)
    line(stage_names()[k], column(recorder, [k](const S& s) { return s.stage_ms[k]; }));
  line("whole step", column(recorder, [](const S& s) { return s.step_ms; }));
  return out + "</tbody></table>\n";
}

/// A plot for each kind of channel of a component, with a curve for each group. Constant channels are left out.
std::string channel_plots(const RunRecorder& recorder, const RunSeries& s, const std::vector<PlotMark>& marks) {
  static constexpr const char* colours[] = {"#1f6fb2", "#c2410c", "#15803d", "#9333ea",
                                            "#d4a017", "#4b5563", "#dc2626", "#0891b2"};
  const auto& all = recorder.channels().channels();
  std::string out;
  std::vector<char> done(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<PlotCurve> curves;
    for (std::size_t k = i; k < all.size(); ++k) {
      const auto& c = all[k];
      if (done[k] || c.curve < 0 || c.component != all[i].component || c.name != all[i].name) continue;
      done[k] = 1;
      const auto& f = recorder.channels().figures(c);
      if (f.steps == 0 || f.min == f.max) continue;
      std::vector<double> y = s.channels[std::size_t(c.curve)];
      for (double& v : y) v *= c.scale;
      curves.push_back(
          {c.group.empty() ? c.name : c.group, colours[curves.size() % std::size(colours)], std::move(y), ""});
    }
    if (curves.empty()) continue;
    out += svg({spoken(all[i].component + ": " + all[i].name), "time (s)",
                all[i].display_unit.empty() ? all[i].name : all[i].name + " (" + all[i].display_unit + ")", s.time_s,
                curves, marks, false});
  }
  return out.empty() ? out : "<h2>Channels</h2>\n" + out;
}

std::string force_plots(const RunRecorder& recorder) {
  const RunSeries s = series_of(recorder, plotted_moments);
  std::vector<PlotMark> marks;
  for (const auto& e : recorder.events()) {
    if (marks.size() >= 300) break;
    if (e.kind == "goal" || e.kind == "fault")
      marks.push_back(
          {e.time, e.kind + ": " + (e.text.empty() ? e.id : e.text), e.kind == "goal" ? goal_colour : fault_colour});
  }
  std::string out = "<h2>Forces</h2>\n<p class=\"quiet\">Dashed lines: goals (green) and faults (red).</p>\n";
  out += svg({"Force on the hands",
              "time (s)",
              "force (N)",
              s.time_s,
              {{"left", left_colour, s.hand_force_N[0], ""}, {"right", right_colour, s.hand_force_N[1], ""}},
              marks,
              false});
  out += svg({"Force of the tools on the tissue",
              "time (s)",
              "force (N)",
              s.time_s,
              {{"left", left_colour, s.tool_force_N[0], ""}, {"right", right_colour, s.tool_force_N[1], ""}},
              marks,
              false});
  std::vector<double> separation_mm = s.separation_m;
  for (double& v : separation_mm) v *= 1000;
  if (std::any_of(separation_mm.begin(), separation_mm.end(), [](double v) { return std::isfinite(v); }))
    out += svg({"Distance of the tips",
                "time (s)",
                "distance (mm)",
                s.time_s,
                {{"distance", left_colour, std::move(separation_mm), ""}},
                marks,
                false});
  return out + channel_plots(recorder, s, marks);
}

std::string technical_plots(const RunRecorder& recorder) {
  const RunSeries s = series_of(recorder, plotted_moments);
  std::string out = "<h2>Constraints</h2>\n";
  out += svg({"Rows, contacts and sweeps",
              "time (s)",
              "count",
              s.time_s,
              {{"rows", "#1f6fb2", s.rows, ""},
               {"contacts", "#15803d", s.contacts, ""},
               {"sweeps", "#9333ea", s.sweeps, "4 3"}},
              {},
              false});
  out += svg({"Residual of the solver",
              "time (s)",
              "residual (N)",
              s.time_s,
              {{"residual", "#4b5563", s.residual_N, ""}},
              {},
              true});
  out += "<h2>Time of a step</h2>\n";
  static constexpr const char* colours[] = {"#1f6fb2", "#15803d", "#d4a017", "#dc2626", "#9333ea", "#9ca3af"};
  std::vector<PlotCurve> curves;
  for (std::size_t k = 0; k < stage_count; ++k) {
    curves.push_back({spoken(stage_names()[k]), colours[k], s.stage_ms[k], ""});
  }
  curves.push_back({"step", "#111", s.step_ms, ""});
  out += svg({"Stages", "time (s)", "wall time (ms)", s.time_s, curves, {}, false});
  return out + stage_table(recorder);
}

/// The head of a page, up to the notice that it is for training only.
std::string page_head(const RunSummary& summary, const char* what) {
  const std::string title = escaped(summary.title.empty() ? "Run" : summary.title);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{0}: {1}</title>\n"
      "<style>{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n"
      "<p class=\"notice\">For training only. Not a medical device, and no measure of fitness to operate.</p>\n",
      title, what, style);
}

/// Whose result this is.
std::string mode_part(const RunSummary& summary) {
  if (summary.mode == "demonstration")
    return "<p class=\"bad\">Demonstration by the simulator: this result is no trainee's.</p>\n";
  if (summary.mode == "practice") return "<p>Practice, with targets shown.</p>\n";
  if (summary.mode == "test") return "<p>Test, without help.</p>\n";
  return {};
}

/// How large the run's forces were, and how long it took.
std::string run_part(const RunRecorder& recorder, const RunSummary& summary, double sim_s) {
  std::string out = "<h2>The run</h2>\n<table><tbody>\n";
  if (!summary.scene.empty()) out += row("scene", summary.scene);
  if (!summary.motion.empty()) out += row("motion", summary.motion);
  out += row("simulated time", fmt::format("{:.3f} s", sim_s));
  out += row("largest force on the left hand", fmt::format("{:.3f} N", summary.max_force_N[0]));
  out += row("largest force on the right hand", fmt::format("{:.3f} N", summary.max_force_N[1]));
  const PerceptibleForces left = perceptible_forces(recorder, 0), right = perceptible_forces(recorder, 1);
  for (std::size_t d = 0; d < known_frictions.size(); ++d)
    out += row(
        fmt::format("time in touch above the friction of {} ({:.2f} N)", known_frictions[d].devices,
                    known_frictions[d].friction_N),
        fmt::format("left {:.0f} %, right {:.0f} %", 100 * left.above[d].time_share, 100 * right.above[d].time_share));
  return out + "</tbody></table>\n";
}

double simulated_seconds(const RunRecorder& recorder) {
  return recorder.samples().empty() ? 0 : double(recorder.samples().back().time_s);
}

}  // namespace

Review review_of(const RunRecorder& recorder, const RunSummary& summary) {
  if (!summary.exercise) return {};
  OwnRun now;
  now.done = summary.exercise->log.state() == ExerciseState::done;
  now.seconds = simulated_seconds(recorder);
  for (const FaultState& f : summary.exercise->log.faults()) now.faults += f.count;
  return review_of(summary.exercise->metrics, summary.bands, summary.moments, summary.own_runs, now);
}

std::string report_html(const RunRecorder& recorder, const RunSummary& summary) {
  std::string out = page_head(summary, "report");
  if (!summary.began.empty()) out += fmt::format("<p class=\"quiet\">Begun {}</p>\n", escaped(summary.began));
  out += mode_part(summary);
  if (!recorder.finite())
    out += "<p class=\"bad\">The simulation lost its numbers (not finite): nothing below can be relied upon.</p>\n";
  if (summary.exercise)
    out += exercise_part(*summary.exercise) +
           cues_html(summary.exercise->cues, summary.mode != name_of(SessionMode::test)) +
           review_html(review_of(recorder, summary)) + metrics_html(summary.exercise->metrics);
  out += recorder.forces().html() + recorder.channels().html() + recorder.outcome().html();
  if (summary.complications) out += complications_html(*summary.complications);
  out += run_part(recorder, summary, simulated_seconds(recorder));
  out += force_plots(recorder) + events_part(recorder, summary);
  if (!summary.recording.empty())
    out += fmt::format("<p>To watch this run again: <code>insula replay {}</code></p>\n", escaped(summary.recording));
  out +=
      "<p class=\"quiet\"><a href=\"technical.html\">Times of steps and solver, for those who look after the "
      "machine</a></p>\n";
  return out + "</body>\n</html>\n";
}

std::string technical_html(const RunRecorder& recorder, const RunSummary& summary) {
  using S = RunRecorder::Sample;
  const double sim_s = simulated_seconds(recorder);
  const auto rows = column(recorder, [](const S& s) { return s.rows; });
  const auto residual = column(recorder, [](const S& s) { return s.residual_N; });
  std::string out = page_head(summary, "technical page") + "<table><tbody>\n";
  out += row("steps", fmt::format("{} at {:.4g} Hz", recorder.steps(), summary.step_rate_hz));
  if (recorder.steps_per_sample() > 1)
    out += row("gathered for what follows, each with its largest values",
               fmt::format("{} steps", recorder.steps_per_sample()));
  out += row("simulated time", fmt::format("{:.3f} s", sim_s));
  out += row("wall time of the steps", fmt::format("{:.3f} s", summary.wall_seconds));
  out += row("simulated over wall time",
             fmt::format("{:.2f}", summary.wall_seconds > 0 ? sim_s / summary.wall_seconds : 0));
  out += row("fresh forces", fmt::format("{:.0f} per second of touch", summary.fresh_forces_per_s));
  out += row("constraint rows, mean and largest", fmt::format("{:.0f}, {:.0f}", mean(rows), largest(rows)));
  out += row("residual, median and largest",
             fmt::format("{:.2g} N, {:.2g} N", percentile(residual, 0.5), largest(residual)));
  out += fmt::format("<tr><td>state hash</td><td class=\"n\"><code>{:016x}</code></td></tr>\n</tbody></table>\n",
                     summary.state_hash);
  return out + technical_plots(recorder) + "<p><a href=\"report.html\">The report</a></p>\n</body>\n</html>\n";
}

}  // namespace insula
