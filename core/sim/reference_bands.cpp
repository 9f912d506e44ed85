// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/sim/reference_bands.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/xml/document.h"

namespace insula {
namespace {

constexpr std::size_t most_bytes = 64u << 20;

ReferenceBand band_of(const nlohmann::json& metric, const nlohmann::json& group) {
  ReferenceBand band;
  band.unit = metric.at("unit");
  band.median = group.at("median");
  band.low = group.at("quantiles").at("0.25");
  band.high = group.at("quantiles").at("0.75");
  if (const auto& mark = metric.at("pass_mark"); mark.is_number()) band.pass_mark = mark.get<double>();
  if (!(band.low <= band.high)) throw InputError("the quartiles of a band are in the wrong order");
  return band;
}

}  // namespace

ReferenceBands::ReferenceBands(const std::filesystem::path& file, const std::string& group) : group_(group) {
  std::string text;
  if (const std::string error = read_text_file(file.string(), most_bytes, text); !error.empty())
    throw InputError(file.string() + ": " + error);
  try {
    const auto json = nlohmann::json::parse(text);
    title_ = json.at("title");
    std::vector<std::string> known;
    for (const auto& metric : json.at("metrics"))
      for (const auto& [name, values] : metric.at("groups").items())
        if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    if (group_.empty() && known.size() == 1) group_ = known.front();
    if (std::find(known.begin(), known.end(), group_) == known.end())
      throw InputError(file.string() +
                       (group_.empty() ? ": has bands of several groups; choose one with --band-group: "
                                       : ": has no group " + in_quotes(group_) + ", but ") +
                       joined(known));
    for (const auto& metric : json.at("metrics")) {
      const auto& groups = metric.at("groups");
      if (!groups.contains(group_)) continue;
      bands_[{metric.at("id"), metric.at("hand")}] = band_of(metric, groups.at(group_));
      sessions_ = std::max(sessions_, groups.at(group_).at("sessions").get<std::size_t>());
    }
  } catch (const nlohmann::json::exception&) {
    throw InputError(file.string() + ": has no bands; insula bands --json writes them");
  }
}

ReferenceBands bands_for(const std::filesystem::path& file, const std::string& group, const std::string& title) {
  ReferenceBands bands(file, group);
  if (bands.title() != title)
    throw InputError(file.string() + ": has bands of " + in_quotes(bands.title()) + ", not of " + in_quotes(title));
  return bands;
}

std::filesystem::path bands_beside(const std::filesystem::path& scene) {
  std::filesystem::path file = scene;
  file.replace_filename(scene.stem().string() + "_bands.json");
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) ? file : std::filesystem::path();
}

const ReferenceBand* ReferenceBands::find(const MetricValue& metric) const {
  const auto it = bands_.find({metric.id, std::string(hand_name(metric.hand))});
  return it == bands_.end() || it->second.unit != metric.unit ? nullptr : &it->second;
}

const ReferenceBand* ReferenceBands::of(const std::string& metric, const std::string& hand) const {
  const auto it = bands_.find({metric, hand});
  return it == bands_.end() ? nullptr : &it->second;
}

double band_width(const ReferenceBand& band) {
  // Sessions that are all alike have no width: a twentieth of the median then, or one unit about zero.
  const double least = band.median != 0 ? 0.05 * std::abs(band.median) : 1;
  return std::max(band.high - band.low, least);
}

double beyond_band(const MetricValue& metric, const ReferenceBand& band) {
  if (!metric.known) return 0;
  const double above = metric.better == Better::high ? 0 : metric.value - band.high;
  const double below = metric.better == Better::low ? 0 : band.low - metric.value;
  return std::max({above, below, 0.0}) / band_width(band);
}

std::vector<const MetricValue*> to_work_on(const std::vector<MetricValue>& metrics, const ReferenceBands& bands,
                                           std::size_t most) {
  std::vector<std::pair<double, const MetricValue*>> beyond;
  for (const MetricValue& m : metrics)
    if (const ReferenceBand* band = bands.find(m); band && m.better != Better::none)
      if (const double away = beyond_band(m, *band); away > 0) beyond.emplace_back(away, &m);
  std::stable_sort(beyond.begin(), beyond.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const MetricValue*> out;
  for (std::size_t i = 0; i < std::min(most, beyond.size()); ++i) out.push_back(beyond[i].second);
  return out;
}

}  // namespace insula
