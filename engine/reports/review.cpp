// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/review.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/reports/metrics_report.h"
#include "engine/reports/svg_plot.h"

namespace insula {
namespace {

constexpr std::size_t most_things = 3, most_changes = 8;

std::string with_value(MetricValue metric, double value) {
  metric.value = value;
  return shown_value(metric);
}

std::string name_with_hand(const MetricValue& m) {
  return m.hand == both_hands ? m.text : fmt::format("{} ({} hand)", m.text, hand_name(m.hand));
}

std::vector<Review::Thing> things(const std::vector<MetricValue>& metrics, const ReferenceBands& bands,
                                  const MetricMoments& moments) {
  std::vector<Review::Thing> out;
  for (const MetricValue* m : to_work_on(metrics, bands, most_things)) {
    const ReferenceBand& band = *bands.find(*m);
    out.push_back({name_with_hand(*m), shown_value(*m), with_value(*m, band.low), with_value(*m, band.high),
                   moments.worst_s(*m)});
  }
  return out;
}

/// A metric with its values in the last and the best run.
struct Change {
  const MetricValue* metric;
  double last, best;
  /// Since the last run, as a share of the larger value.
  double size() const {
    return std::abs(metric->value - last) / std::max({std::abs(metric->value), std::abs(last), 1e-12});
  }
};

/// What has changed most since the last run, of what has a better side.
std::vector<Change> changes(const std::vector<MetricValue>& metrics, const OwnRun& last, const OwnRun& best) {
  std::vector<Change> out;
  for (const MetricValue& m : metrics) {
    const std::pair key(m.id, std::string(hand_name(m.hand)));
    const auto before = last.metrics.find(key), at_best = best.metrics.find(key);
    if (m.known && m.better != Better::none && before != last.metrics.end() && at_best != best.metrics.end())
      out.push_back({&m, before->second, at_best->second});
  }
  std::stable_sort(out.begin(), out.end(), [](const Change& a, const Change& b) { return a.size() > b.size(); });
  if (out.size() > most_changes) out.resize(most_changes);
  return out;
}

std::vector<Review::Line> compared(const std::vector<MetricValue>& metrics, const OwnRuns& earlier, const OwnRun& now) {
  if (!earlier.last || !earlier.best) return {};
  const OwnRun &last = *earlier.last, &best = *earlier.best;
  const auto yes = [](const OwnRun& r) { return std::string(r.done ? "✓ yes" : "✗ no"); };
  const auto time = [](const OwnRun& r) { return fmt::format("{:.1f} s", r.seconds); };
  const auto faults = [](const OwnRun& r) { return fmt::format("{}", r.faults); };
  std::vector<Review::Line> out{{"All goals reached", yes(now), yes(last), yes(best), int(now.done) - int(last.done)},
                                {"Time", time(now), time(last), time(best)},
                                {"Faults", faults(now), faults(last), faults(best),
                                 int(now.faults < last.faults) - int(now.faults > last.faults)}};
  for (const Change& c : changes(metrics, last, best)) {
    const MetricValue& m = *c.metric;
    const int more = int(m.value > c.last) - int(m.value < c.last);
    out.push_back({name_with_hand(m), shown_value(m), with_value(m, c.last), with_value(m, c.best),
                   m.better == Better::high ? more : -more});
  }
  return out;
}

std::string to_work_on_html(const Review& review) {
  if (review.group.empty()) return {};
  std::string out = fmt::format(
      "<h2>Three things to work on</h2>\n<p class=\"quiet\">What lies farthest beyond the middle half of {} sessions "
      "of the group {}.</p>\n",
      review.sessions, escaped(review.group));
  if (review.to_work_on.empty())
    return out + "<p class=\"good\">✓ Every metric lies within its band or on its better side.</p>\n";
  out += "<ol>\n";
  for (const Review::Thing& t : review.to_work_on)
    out += fmt::format("<li><b>{}</b>: {}, where the group has {} to {}{}</li>\n", escaped(t.text), escaped(t.value),
                       escaped(t.low), escaped(t.high),
                       t.worst_s ? fmt::format(". It became worse most at {:.0f} s", *t.worst_s) : "");
  return out + "</ol>\n";
}

std::string comparison_html(const Review& review) {
  if (review.comparison.empty()) return {};
  std::string out = fmt::format(
      "<h2>Beside your earlier runs</h2>\n<p class=\"quiet\">{} earlier run{} of this exercise. The best one reached "
      "all goals with the fewest faults, in the shortest time.</p>\n<table><thead><tr><th></th><th class=\"n\">This "
      "run</th><th class=\"n\">Last</th><th class=\"n\">Best</th></tr></thead><tbody>\n",
      review.earlier_runs, review.earlier_runs == 1 ? "" : "s");
  for (const Review::Line& l : review.comparison) {
    out += fmt::format("<tr><td>{}<span class=\"{}\">{}</span></td>", escaped(l.text), l.change < 0 ? "bad" : "good",
                       l.change > 0   ? " ✓ better"
                       : l.change < 0 ? " ✗ worse"
                                      : "");
    for (const std::string& text : {l.now, l.last, l.best})
      out += fmt::format("<td class=\"n\">{}</td>", escaped(text));
    out += "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

}  // namespace

Review review_of(const std::vector<MetricValue>& metrics, const ReferenceBands& bands, const MetricMoments& moments,
                 const OwnRuns& earlier, const OwnRun& now) {
  Review review{.group = bands.empty() ? "" : bands.group(), .sessions = bands.sessions()};
  review.to_work_on = things(metrics, bands, moments);
  review.earlier_runs = earlier.count;
  review.comparison = compared(metrics, earlier, now);
  return review;
}

std::string review_html(const Review& review) { return to_work_on_html(review) + comparison_html(review); }

nlohmann::ordered_json review_json(const Review& review) {
  nlohmann::ordered_json out{{"group", review.group}, {"sessions", review.sessions}};
  out["to_work_on"] = nlohmann::ordered_json::array();
  for (const Review::Thing& t : review.to_work_on)
    out["to_work_on"].push_back({{"text", t.text},
                                 {"value", t.value},
                                 {"low", t.low},
                                 {"high", t.high},
                                 {"worst_s", t.worst_s ? nlohmann::ordered_json(*t.worst_s) : nullptr}});
  out["earlier_runs"] = review.earlier_runs;
  out["comparison"] = nlohmann::ordered_json::array();
  for (const Review::Line& l : review.comparison)
    out["comparison"].push_back(
        {{"text", l.text}, {"now", l.now}, {"last", l.last}, {"best", l.best}, {"change", l.change}});
  return out;
}

std::string review_message(int pass, const Review& review) {
  return nlohmann::ordered_json{{"pass", pass}, {"review", review_json(review)}}.dump();
}

}  // namespace insula
