// SPDX-License-Identifier: GPL-3.0-or-later
// insula bands: reference bands of the metrics from a folder of sessions.
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "engine/command_line/sessions.h"
#include "engine/session/bands.h"
#include "engine/session/session_format.h"
#include "engine/session/session_reader.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Found {
  std::vector<BandSession> sessions;
  std::vector<std::string> titles;                            ///< of the sessions, each once
  std::size_t scripted = 0;                                   ///< sessions whose hands followed a motion
  std::vector<std::pair<std::string, std::string>> left_out;  ///< file, why
};

std::vector<fs::path> session_files(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is no folder");
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == session::extension) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

void take(const fs::path& file, const BandsOptions& options, Found& found) {
  const auto leave_out = [&](const std::string& why) { found.left_out.emplace_back(file.string(), why); };
  try {
    SessionReader session(file);
    const std::string title = session.about("title");
    if (!options.title.empty() && title != options.title) return leave_out("of exercise " + in_quotes(title));
    const auto passes = session.passes();
    const auto last = std::find_if(passes.rbegin(), passes.rend(), [](const auto& p) { return p.last_of_pass; });
    if (last == passes.rend()) return leave_out("has no metrics of a whole pass through an exercise");
    BandSession s;
    s.group = options.group == "mode" ? last->mode : session.field(options.group);
    if (s.group.empty()) return leave_out("has no field " + in_quotes(options.group));
    s.person = session.field("person");
    for (const auto& v : last->values) s.metrics[{v.id, v.hand}] = {v.unit, v.better, v.value};
    found.scripted += last->mode == "demonstration" || last->mode == "headless";
    if (std::find(found.titles.begin(), found.titles.end(), title) == found.titles.end()) found.titles.push_back(title);
    found.sessions.push_back(std::move(s));
  } catch (const InputError& e) {
    leave_out(e.what());
  }
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(); }

Json group_json(const GroupBand& g) {
  Json out = {{"sessions", g.sessions}, {"median", g.median},       {"median_interval", {g.median_low, g.median_high}},
              {"mean", g.mean},         {"deviation", g.deviation}, {"quantiles", Json::object()}};
  for (const auto& [share, value] : g.quantiles) out["quantiles"][fmt::format("{:g}", share)] = value;
  return out;
}

Json bands_json(const BandsOptions& options, const Found& found, const std::vector<MetricBand>& all,
                const std::vector<std::string>& warnings) {
  Json out = {{"group_by", options.group}, {"sessions", found.sessions.size()}, {"warnings", warnings}};
  out["title"] = found.titles.front();
  out["left_out"] = Json::array();
  for (const auto& [file, why] : found.left_out) out["left_out"].push_back({{"file", file}, {"why", why}});
  out["metrics"] = Json::array();
  for (const MetricBand& m : all) {
    Json groups = Json::object();
    for (const GroupBand& g : m.groups) groups[g.group] = group_json(g);
    const char* effect = m.groups.size() == 2 ? "hedges_g" : "eta_squared";
    out["metrics"].push_back({{"id", m.id},
                              {"hand", m.hand},
                              {"unit", m.unit},
                              {"better", m.better},
                              {"groups", groups},
                              {"pass_mark", number(m.pass_mark)},
                              {effect, number(m.effect)},
                              {"leave_one_out", number(m.leave_one_out)},
                              {"chance", number(m.chance)}});
  }
  return out;
}

/// The metrics that tell the groups apart best come first.
void print(std::ostream& out, const Found& found, std::vector<MetricBand> all) {
  const auto strength = [](const MetricBand& m) { return std::isfinite(m.effect) ? std::abs(m.effect) : -1; };
  std::stable_sort(all.begin(), all.end(),
                   [&](const MetricBand& a, const MetricBand& b) { return strength(a) > strength(b); });
  fmt::print(out, "{}: {} sessions\n", found.titles.front(), found.sessions.size());
  for (const MetricBand& m : all) {
    fmt::print(out, "{} ({})", m.id, m.hand);
    if (std::isfinite(m.effect))
      fmt::print(out, ", {} {:.2f}, told apart {:.0f} % (chance {:.0f} %)",
                 m.groups.size() == 2 ? "Hedges' g" : "eta squared", m.effect, 100 * m.leave_one_out, 100 * m.chance);
    if (std::isfinite(m.pass_mark)) fmt::print(out, ", pass mark {:.4g} {}", m.pass_mark, m.unit);
    fmt::print(out, "\n");
    for (const GroupBand& g : m.groups)
      fmt::print(out, "  {:<20} n {:<4} median {:.4g} [{:.4g}, {:.4g}], quartiles {:.4g} to {:.4g} {}\n", g.group,
                 g.sessions, g.median, g.median_low, g.median_high, g.quantiles.at(0.25), g.quantiles.at(0.75), m.unit);
  }
}

PassMark pass_mark(const BandsOptions& options, const Found& found) {
  if (options.pass_group.empty()) return {};
  const bool known = std::any_of(found.sessions.begin(), found.sessions.end(),
                                 [&](const BandSession& s) { return s.group == options.pass_group; });
  if (!known) throw InputError("no session is in the group " + in_quotes(options.pass_group));
  return {options.pass_group, options.pass_share};
}

}  // namespace

int cmd_bands(const CommandContext& context, const BandsOptions& options) {
  try {
    Found found;
    for (const fs::path& file : session_files(options.folder)) take(file, options, found);
    for (const auto& [file, why] : found.left_out) fmt::print(context.err, "left out: {}: {}\n", file, why);
    if (found.sessions.empty()) throw InputError(options.folder.string() + ": has no session that could be used");
    if (found.titles.size() > 1)
      throw InputError("the sessions are of several exercises; choose one with --title: " +
                       joined({found.titles.begin(), found.titles.end()}));
    std::vector<std::string> warnings = band_warnings(found.sessions);
    if (found.scripted > 0)
      warnings.push_back(fmt::format("{} of {} sessions are those of scripted hands, not of persons", found.scripted,
                                     found.sessions.size()));
    for (const std::string& w : warnings) fmt::print(context.err, "warning: {}\n", w);
    const std::vector<MetricBand> all = bands(found.sessions, pass_mark(options, found));
    if (options.json)
      fmt::print(context.out, "{}\n",
                 bands_json(options, found, all, warnings).dump(2, ' ', false, Json::error_handler_t::replace));
    else print(context.out, found, all);
    return 0;
  } catch (const std::exception& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
}

}  // namespace insula
