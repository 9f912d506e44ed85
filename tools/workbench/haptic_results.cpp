// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/haptic_results.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/reports/report_writer.h"

namespace insula {
namespace {

using Chosen = std::function<bool(const HapticResult&)>;

std::vector<double> rates(const std::vector<HapticResult>& results) {
  std::vector<double> out;
  for (const HapticResult& r : results)
    if (std::find(out.begin(), out.end(), r.hz) == out.end()) out.push_back(r.hz);
  return out;
}

std::vector<double> values(const std::vector<HapticResult>& results, const Chosen& chosen,
                           const std::function<double(const HapticResult&)>& value) {
  std::vector<double> out;
  for (const HapticResult& r : results)
    if (chosen(r)) out.push_back(value(r));
  return out;
}

double rms_pct(const HapticResult& r) { return 100 * r.truth.rms; }
double jump_pct(const HapticResult& r) { return 100 * r.jump_N / r.truth.peak_N; }
double onset_ms(const HapticResult& r) { return 1e3 * std::abs(r.truth.onset_s); }
double peak_ratio(const HapticResult& r) { return r.rendered_peak_N / r.truth.peak_N; }
std::string kind_of(const HapticResult& r) { return r.probe.substr(0, r.probe.find(' ')); }

nlohmann::json if_any(const std::vector<double>& x, double number) {
  return x.empty() ? nlohmann::json(nullptr) : nlohmann::json(number);
}

nlohmann::json json_of_largest(const std::vector<double>& x) { return if_any(x, largest(x)); }

nlohmann::json json_of_probes(const std::vector<HapticResult>& results, double hz) {
  nlohmann::json out = nlohmann::json::array();
  std::map<std::pair<std::string, int>, std::size_t> place;
  for (const HapticResult& r : results) {
    if (r.hz != hz) continue;
    const auto [it, fresh] = place.emplace(std::pair(r.probe, r.hand), out.size());
    if (fresh) out.push_back({{"name", r.probe}, {"hand", r.hand ? "right" : "left"}, {"peak_N", r.truth.peak_N}});
    nlohmann::json& probe = out[it->second];
    probe[r.rendering + "_pct"] = rms_pct(r);
    if (r.rendering == "held") probe["engine_peak_N"] = r.rendered_peak_N;
    if (r.rendering != "servo") continue;
    probe["onset_ms"] = 1e3 * r.truth.onset_s;
    probe["jump_pct"] = jump_pct(r);
  }
  return out;
}

}  // namespace

void print_table(std::ostream& out, const std::vector<HapticResult>& results) {
  fmt::print(out, "  {:<6}{:<18}{:<7}{:>9}{:>9}{:>9}{:>11}{:>9}\n", "Hz", "rendering", "hand", "peak mN", "rms %",
             "worst %", "onset ms", "jump %");
  for (const HapticResult& r : results)
    fmt::print(out, "  {:<6.0f}{:<18}{:<7}{:>9.1f}{:>9.2f}{:>9.1f}{:>11.0f}{:>9.1f}\n", r.hz, r.rendering,
               r.hand ? "right" : "left", 1e3 * r.truth.peak_N, rms_pct(r), 100 * r.truth.worst, 1e3 * r.truth.onset_s,
               jump_pct(r));
}

void print_percentiles(std::ostream& out, const std::vector<HapticResult>& results) {
  std::vector<std::string> kinds{""};
  for (const HapticResult& r : results)
    if (std::find(kinds.begin(), kinds.end(), kind_of(r)) == kinds.end()) kinds.push_back(kind_of(r));
  fmt::print(out, "  {:<6}{:<10}{:>7}{:>11}{:>9}{:>10}{:>9}{:>11}{:>9}{:>10}{:>8}{:>13}\n", "Hz", "kind", "hands",
             "servo p50", "p90 %", "held p50", "p90 %", "hind. p50", "p90 %", "onset ms", "jump %", "engine peak");
  for (const double hz : rates(results))
    for (const std::string& kind : kinds) {
      const auto of = [&](const char* rendering) -> Chosen {
        return [&, rendering](const HapticResult& r) {
          return r.hz == hz && r.rendering == rendering && (kind.empty() || kind_of(r) == kind);
        };
      };
      const auto servo = values(results, of("servo"), rms_pct), held = values(results, of("held"), rms_pct),
                 hindsight = values(results, of("hindsight"), rms_pct);
      if (servo.empty()) continue;
      fmt::print(out,
                 "  {:<6.0f}{:<10}{:>7}{:>11.1f}{:>9.1f}{:>10.1f}{:>9.1f}{:>11.1f}{:>9.1f}{:>10.0f}{:>8.1f}{:>13.2f}\n",
                 hz, kind.empty() ? "all" : kind, servo.size(), percentile(servo, 0.5), percentile(servo, 0.9),
                 percentile(held, 0.5), percentile(held, 0.9), percentile(hindsight, 0.5), percentile(hindsight, 0.9),
                 largest(values(results, of("servo"), onset_ms)), largest(values(results, of("servo"), jump_pct)),
                 largest(values(results, of("held"), peak_ratio)));
    }
}

std::string haptic_json(const std::vector<HapticResult>& results) {
  nlohmann::json out{{"rates", nlohmann::json::array()}};
  for (const double hz : rates(results)) {
    const auto of = [&](const std::string& rendering) -> Chosen {
      return [hz, rendering](const HapticResult& r) { return r.hz == hz && r.rendering == rendering; };
    };
    nlohmann::json rate{{"hz", hz}};
    for (const char* rendering : {"servo", "held", "hindsight"}) {
      const auto rms = values(results, of(rendering), rms_pct);
      rate[rendering] = {{"rms_pct_p50", if_any(rms, percentile(rms, 0.5))},
                         {"rms_pct_p90", if_any(rms, percentile(rms, 0.9))}};
    }
    rate["onset_ms_max"] = json_of_largest(values(results, of("servo"), onset_ms));
    rate["jump_pct_max"] = json_of_largest(values(results, of("servo"), jump_pct));
    rate["engine_peak_ratio_max"] = json_of_largest(values(results, of("held"), peak_ratio));
    rate["probes"] = json_of_probes(results, hz);
    out["rates"].push_back(std::move(rate));
  }
  return out.dump(2);
}

}  // namespace insula
