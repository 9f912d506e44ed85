// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/catalogue.h"

#include <algorithm>

#include "core/xml/document.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_scene_bytes = 1u << 20;
constexpr std::size_t most_scenes = 2000;
constexpr const char* groups[] = {"skills", "training", "cases"};

std::string value_of(const Element& element, std::string_view name) {
  const Attribute* a = element.find(name);
  return a ? a->value : std::string();
}

/// A scene is not checked here, so it may have anything there.
int difficulty_of(const std::string& text) {
  return text.size() == 1 && text[0] >= '1' && text[0] <= '5' ? text[0] - '0' : 0;
}

/// The folder in scenes/cases in which a scene lies, at any depth; empty: none.
std::string case_folder(const fs::path& scene) {
  const fs::path inside = scene.lexically_relative("scenes/cases");
  return inside.has_parent_path() ? inside.begin()->string() : std::string();
}

}  // namespace

std::optional<CatalogueEntry> catalogue_entry(const fs::path& file) {
  std::string text;
  if (!read_text_file(file.string(), most_scene_bytes, text).empty()) return std::nullopt;
  Diagnostics ignored;
  const Document document = parse_document(text, file.string(), ignored);
  if (!document.root || document.root->name != "scene") return std::nullopt;
  for (const auto& child : document.root->children) {
    if (child->name != "exercise") continue;
    CatalogueEntry out;
    out.id = value_of(*child, "id");
    out.name = value_of(*child, "title");
    out.title = value_of(*document.root, "title");
    if (out.title.empty()) out.title = out.name;
    out.text = value_of(*child, "text");
    out.site = value_of(*child, "site");
    out.difficulty = difficulty_of(value_of(*child, "difficulty"));
    std::error_code error;
    const fs::path picture = fs::absolute(fs::path(file).replace_extension(".jpg"));
    if (fs::is_regular_file(picture, error)) out.picture = picture.string();
    return out;
  }
  return std::nullopt;
}

std::vector<CatalogueEntry> catalogue(const fs::path& folder) {
  std::vector<CatalogueEntry> out;
  for (const char* group : groups) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder / "scenes" / group, error), end; !error && it != end;
         it.increment(error))
      if (it->path().extension() == ".xml" && files.size() < most_scenes) files.push_back(it->path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      auto entry = catalogue_entry(file);
      if (!entry) continue;
      entry->scene = file.lexically_relative(folder).generic_string();
      entry->group = group;
      if (entry->group == "cases") entry->of_case = case_folder(entry->scene);
      out.push_back(std::move(*entry));
    }
  }
  return out;
}

nlohmann::ordered_json catalogue_json(const std::vector<CatalogueEntry>& entries) {
  auto out = nlohmann::ordered_json::array();
  for (const CatalogueEntry& e : entries)
    out.push_back({{"scene", e.scene},
                   {"group", e.group},
                   {"case", e.of_case},
                   {"id", e.id},
                   {"name", e.name},
                   {"title", e.title},
                   {"text", e.text},
                   {"site", e.site},
                   {"difficulty", e.difficulty},
                   {"picture", e.picture}});
  return out;
}

}  // namespace insula
