// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace insula {
namespace {

constexpr int resamples = 2000;
constexpr std::size_t least_persons = 10;
constexpr double shares[] = {0.05, 0.25, 0.75, 0.95};
using Values = std::map<std::string, std::vector<double>>;  // by group

double mean_of(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size()); }
double squares_about(const std::vector<double>& v, double centre) {
  double sum = 0;
  for (const double x : v) sum += (x - centre) * (x - centre);
  return sum;
}

GroupBand band_of(const std::string& group, std::vector<double> v) {
  std::sort(v.begin(), v.end());
  GroupBand out;
  out.group = group;
  out.sessions = v.size();
  out.mean = mean_of(v);
  if (v.size() > 1) out.deviation = std::sqrt(squares_about(v, out.mean) / double(v.size() - 1));
  out.median = quantile(v, 0.5);
  for (const double share : shares) out.quantiles[share] = quantile(v, share);
  // Percentile bootstrap (Efron and Tibshirani 1993) from a fixed seed.
  std::mt19937_64 random(20'250'101);
  std::vector<double> medians, sample(v.size());
  for (int k = 0; k < resamples; ++k) {
    for (double& x : sample) x = v[random() % v.size()];
    std::sort(sample.begin(), sample.end());
    medians.push_back(quantile(sample, 0.5));
  }
  std::sort(medians.begin(), medians.end());
  out.median_low = quantile(medians, 0.025);
  out.median_high = quantile(medians, 0.975);
  return out;
}

/// Hedges 1981: difference of the means over the pooled deviation, corrected for small samples.
double hedges_g(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() < 2 || b.size() < 2) return NAN;
  const double free = double(a.size() + b.size() - 2);
  const double pooled = std::sqrt((squares_about(a, mean_of(a)) + squares_about(b, mean_of(b))) / free);
  return pooled > 0 ? (mean_of(b) - mean_of(a)) / pooled * (1 - 3 / (4 * free - 1)) : NAN;
}

double eta_squared(const Values& values) {
  std::vector<double> all;
  for (const auto& [group, v] : values) all.insert(all.end(), v.begin(), v.end());
  const double centre = mean_of(all), total = squares_about(all, centre);
  double between = 0;
  for (const auto& [group, v] : values) between += double(v.size()) * std::pow(mean_of(v) - centre, 2);
  return total > 0 ? between / total : NAN;
}

double leave_one_out(const Values& values) {
  std::size_t right = 0, all = 0;
  for (const auto& [own, v] : values)
    for (std::size_t i = 0; i < v.size(); ++i) {
      ++all;
      double nearest = INFINITY;
      std::string chosen;
      for (const auto& [group, w] : values) {
        double sum = std::accumulate(w.begin(), w.end(), 0.0);
        std::size_t n = w.size();
        if (group == own) {
          sum -= v[i];
          --n;
        }
        if (n == 0) continue;
        const double away = std::abs(v[i] - sum / double(n));
        if (away >= nearest) continue;
        nearest = away;
        chosen = group;
      }
      right += chosen == own;
    }
  return double(right) / double(all);
}

}  // namespace

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * double(sorted.size() - 1);
  const auto low = std::size_t(at), high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - double(low)) * (sorted[high] - sorted[low]);
}

std::vector<MetricBand> bands(const std::vector<BandSession>& sessions, const PassMark& pass) {
  std::map<std::pair<std::string, std::string>, std::pair<BandSession::Value, Values>> found;
  for (const BandSession& s : sessions)
    for (const auto& [key, value] : s.metrics) {
      auto& [declared, values] = found[key];
      declared = value;
      values[s.group].push_back(value.value);
    }
  std::vector<MetricBand> out;
  for (const auto& [key, entry] : found) {
    const auto& [declared, values] = entry;
    MetricBand band{key.first, key.second, declared.unit, declared.better, {}, NAN, NAN, NAN, NAN};
    std::size_t all = 0, largest = 0;
    for (const auto& [group, v] : values) {
      band.groups.push_back(band_of(group, v));
      all += v.size();
      largest = std::max(largest, v.size());
    }
    if (values.size() == 2) band.effect = hedges_g(values.begin()->second, values.rbegin()->second);
    if (values.size() > 2) band.effect = eta_squared(values);
    if (values.size() > 1) {
      band.leave_one_out = leave_one_out(values);
      band.chance = double(largest) / double(all);
    }
    if (const auto named = values.find(pass.group); named != values.end()) {
      std::vector<double> v = named->second;
      std::sort(v.begin(), v.end());
      band.pass_mark = pass.share < 0 ? mean_of(v) : quantile(v, pass.share);
    }
    out.push_back(std::move(band));
  }
  return out;
}

std::vector<std::string> band_warnings(const std::vector<BandSession>& sessions) {
  std::map<std::string, std::set<std::string>> persons;
  std::map<std::string, std::size_t> nameless;
  for (const BandSession& s : sessions) {
    if (s.person.empty()) ++nameless[s.group];
    else persons[s.group].insert(s.person);
    persons[s.group];
  }
  std::vector<std::string> out;
  for (const auto& [group, names] : persons) {
    const std::size_t n = names.size() + nameless[group];
    if (n < least_persons)
      out.push_back(fmt::format("group \"{}\" has {} {}; bands of fewer than {} say little", group, n,
                                nameless[group] > 0 ? "sessions of persons that may differ" : "persons",
                                least_persons));
  }
  return out;
}

}  // namespace insula
