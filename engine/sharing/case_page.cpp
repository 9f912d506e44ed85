// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/sharing/case_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "core/base/input_error.h"
#include "engine/reports/svg_plot.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr const char* head = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Insula: cases</title>
<style>
body { font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 1200px; padding: 24px; background: #14181c;
  color: #e9edf0; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 20px; }
article { background: #1f252b; border-radius: 8px; overflow: hidden; display: flex; flex-direction: column; }
article img, article .none { width: 100%; aspect-ratio: 16 / 9; object-fit: cover; background: #2b333a; }
article div.text { padding: 12px 16px 16px; display: flex; flex-direction: column; gap: 8px; flex: 1; }
h2 { font-size: 18px; margin: 0; } p { margin: 0; } .facts { color: #b9c3cb; font-size: 14px; }
a { color: #8fd0ff; margin-top: auto; }
</style>
<h1>Cases for Insula</h1>
<p><b>For training only, never for the care of patients.</b> Add a case to an installation with
<code>insula cases add NAME.zip</code>. It then stands on the start page.</p>
<main>
)";

/// What the case builder measured, in words; empty without a report.
std::string measured(const nlohmann::json& report) {
  std::string out;
  const auto number = [&](const char* part, const char* name) -> std::optional<double> {
    if (!report.is_object() || !report.contains(part) || !report[part].is_object()) return std::nullopt;
    const auto it = report[part].find(name);
    return it != report[part].end() && it->is_number() ? std::optional<double>(it->get<double>()) : std::nullopt;
  };
  const auto tell = [&](const std::string& text) { out += (out.empty() ? "" : " · ") + text; };
  if (const auto neck = number("neck", "diameter_mm")) tell(fmt::format("neck {:.1f} mm", *neck));
  if (const auto grade = number("clipping", "grade"))
    tell(fmt::format("scripted hands: grade {:.0f}, remnant {:.0f} %", *grade,
                     number("clipping", "remnant_pct").value_or(0)));
  if (const auto ms = number("step_ms", "p50")) tell(fmt::format("{:.1f} ms a step", *ms));
  return out;
}

std::string card(const ListedCase& c, bool picture) {
  std::string facts = c.site().empty() ? "" : escaped(c.site());
  if (c.difficulty() > 0) facts += fmt::format("{}difficulty {} of 5", facts.empty() ? "" : " · ", c.difficulty());
  std::string exercises;
  for (const CatalogueEntry& e : c.exercises) exercises += "<li>" + escaped(e.title) + "</li>";
  return fmt::format(
      "<article>{}<div class=\"text\"><h2>{}</h2><p class=\"facts\">{}</p><p>{}</p><ul>{}</ul><p class=\"facts\">{}</p>"
      "<a href=\"{}.zip\" download>{}.zip</a></div></article>\n",
      picture ? fmt::format("<img src=\"{}.jpg\" alt=\"\">", c.name) : "<div class=\"none\"></div>", escaped(c.title()),
      facts, escaped(c.exercises.front().text), exercises, measured(c.report), c.name, c.name);
}

}  // namespace

PackedCase pack_listed(const ListedCase& c, const fs::path& project, const fs::path& archive) {
  std::vector<fs::path> scenes, more;
  for (const CatalogueEntry& e : c.exercises) {
    scenes.push_back(project / e.scene);  // an absolute path stays as it is
    if (!e.picture.empty()) more.emplace_back(e.picture);
  }
  if (!c.report.is_null())
    for (const char* report : {"report.html", "report.json"})
      if (fs::is_regular_file(c.folder / report)) more.push_back(c.folder / report);
  return pack_case(c.name, scenes, more, archive);
}

void write_case_page(const std::vector<ListedCase>& cases, const fs::path& project, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  std::string page = head;
  for (const ListedCase& c : cases) {
    pack_listed(c, project, folder / (c.name + ".zip"));
    const auto pictured = std::find_if(c.exercises.begin(), c.exercises.end(),
                                       [](const CatalogueEntry& e) { return !e.picture.empty(); });
    const bool picture = pictured != c.exercises.end();
    if (picture)
      fs::copy_file(pictured->picture, folder / (c.name + ".jpg"), fs::copy_options::overwrite_existing, error);
    if (error) throw InputError((folder / c.name).string() + ".jpg: cannot be written: " + error.message());
    page += card(c, picture);
  }
  std::ofstream out(folder / "index.html", std::ios::binary);
  if (!(out << page << "</main>\n</html>\n").flush())
    throw InputError((folder / "index.html").string() + ": cannot be written");
}

}  // namespace insula
