// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene file to checked components: the order of the steps, and the handling of unexpected exceptions.
#include "core/scene/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "core/scene/builder.h"
#include "core/scene/edits.h"
#include "core/scene/expand.h"
#include "core/scene/first_diagnostics.h"
#include "core/xml/document.h"

namespace insula {
namespace {

void set_time_step(Element& root, double step_s) {
  std::erase_if(root.attributes, [](const Attribute& a) { return a.name == "time_step"; });
  root.attributes.push_back({"time_step", fmt::format("{:.9g} s", step_s), root.pos, root.pos});
}

/// Puts the exercise of `from` in place of that of `into`.
void take_exercise(ExpandedScene& into, ExpandedScene& from, const std::filesystem::path& rules, Diagnostics& found) {
  const auto is_exercise = [](const std::unique_ptr<Element>& e) { return e->name == "exercise"; };
  auto& theirs = from.root->children;
  const auto exercise = std::find_if(theirs.begin(), theirs.end(), is_exercise);
  if (exercise == theirs.end()) return found.error({rules.generic_string(), 0, 0}, "has no <exercise>");
  std::erase_if((*exercise)->children, [](const std::unique_ptr<Element>& e) { return e->name == "motion"; });
  std::erase_if(into.root->children, is_exercise);
  into.root->children.push_back(std::move(*exercise));
  for (auto& part : from.parts) into.parts.push_back(std::move(part));
}

/// rules: scene with the exercise; empty: its own.
LoadResult load_expanded(std::string_view text, const std::filesystem::path& virtual_path, const Registry& registry,
                         double time_step_s, const std::filesystem::path& rules,
                         const std::vector<SceneEdit>& edits = {}) {
  LoadResult result;
  Diagnostics found;
  try {
    auto tree = expand_scene(text, virtual_path, found, edits);
    if (tree.root && !rules.empty()) {
      std::string other;
      if (const std::string error = read_text_file(rules.string(), DocumentLimits{}.file_bytes, other); !error.empty())
        found.error({rules.generic_string(), 0, 0}, error);
      else if (auto from = expand_scene(other, rules, found); from.root) take_exercise(tree, from, rules, found);
    }
    apply_edits(tree, edits, found);
    if (tree.root && time_step_s > 0) set_time_step(*tree.root, time_step_s);
    if (tree.root) result.scene = SceneBuilder(registry, tree, found).build(virtual_path);
  } catch (const std::exception& e) {
    found.error({virtual_path.generic_string(), 0, 0}, std::string("cannot be loaded: ") + e.what());
  } catch (...) {
    found.error({virtual_path.generic_string(), 0, 0}, "cannot be loaded");
  }
  result.diagnostics = first_diagnostics(std::move(found));
  if (!result.diagnostics.ok()) result.scene.reset();
  return result;
}

/// False, with the error, if the file cannot be read.
bool read_scene(const std::filesystem::path& file, std::string& text, LoadResult& result) {
  std::string error;
  try {
    error = read_text_file(file.string(), DocumentLimits{}.file_bytes, text);
  } catch (const std::exception& e) {
    error = std::string("cannot be read: ") + e.what();
  }
  if (!error.empty()) result.diagnostics.error({file.generic_string(), 0, 0}, error);
  return error.empty();
}

}  // namespace

LoadResult load_scene_text(std::string_view text, const std::filesystem::path& virtual_path, const Registry& registry,
                           double time_step_s) {
  return load_expanded(text, virtual_path, registry, time_step_s, {});
}

LoadResult load_scene(const std::filesystem::path& file, const Registry& registry, double time_step_s) {
  return load_scene_with_exercise_of({}, file, registry, time_step_s);
}

LoadResult load_scene_with_exercise_of(const std::filesystem::path& rules, const std::filesystem::path& file,
                                       const Registry& registry, double time_step_s) {
  return load_scene_edited_with_exercise_of(rules, file, registry, {}, time_step_s);
}

LoadResult load_scene_edited_with_exercise_of(const std::filesystem::path& rules, const std::filesystem::path& file,
                                              const Registry& registry, const std::vector<SceneEdit>& edits,
                                              double time_step_s) {
  LoadResult result;
  std::string text;
  if (!read_scene(file, text, result)) return result;
  return load_expanded(text, file, registry, time_step_s, rules, edits);
}

LoadResult load_scene_edited(std::string_view text, const std::filesystem::path& file, const Registry& registry,
                             const std::vector<SceneEdit>& edits, double time_step_s) {
  LoadResult result;
  std::string read;
  if (text.empty() && !read_scene(file, read, result)) return result;
  return load_expanded(text.empty() ? read : text, file, registry, time_step_s, {}, edits);
}

}  // namespace insula
