// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene file to checked components: the order of the steps, and the handling of unexpected exceptions.
#include "core/scene/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "core/scene/builder.h"
#include "core/scene/expand.h"
#include "core/xml/document.h"

namespace insula {
namespace {

constexpr std::size_t max_shown = 100;

std::string counted(std::size_t n, const char* what) { return fmt::format("{} more {}{}", n, what, n == 1 ? "" : "s"); }

/// Keeps the first hundred messages in order of position, and the number of others. Errors have priority over warnings.
Diagnostics tidy(Diagnostics all) {
  all.sort_by_position();
  if (all.all().size() <= max_shown) return all;
  const std::size_t errors = std::size_t(all.errors()), warnings = all.all().size() - errors;
  const std::size_t errors_shown = std::min(errors, max_shown),
                    warnings_shown = std::min(warnings, max_shown - errors_shown);
  Diagnostics out;
  std::size_t errors_left = errors_shown, warnings_left = warnings_shown;
  for (const Diagnostic& d : all.all()) {
    std::size_t& left = d.severity == Severity::error ? errors_left : warnings_left;
    if (left == 0) continue;
    --left;
    d.severity == Severity::error ? out.error(d.pos, d.text) : out.warning(d.pos, d.text);
  }
  std::string rest;
  if (errors > errors_shown) rest = counted(errors - errors_shown, "error");
  if (warnings > warnings_shown) rest += (rest.empty() ? "" : " and ") + counted(warnings - warnings_shown, "warning");
  const SourcePos whole_file{all.all().front().pos.file, 0, 0};
  all.ok() ? out.warning(whole_file, "and " + rest) : out.error(whole_file, "and " + rest);
  return out;
}

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
                         double time_step_s, const std::filesystem::path& rules) {
  LoadResult result;
  Diagnostics found;
  try {
    auto tree = expand_scene(text, virtual_path, found);
    if (tree.root && !rules.empty()) {
      std::string other;
      if (const std::string error = read_text_file(rules.string(), DocumentLimits{}.file_bytes, other); !error.empty())
        found.error({rules.generic_string(), 0, 0}, error);
      else if (auto from = expand_scene(other, rules, found); from.root) take_exercise(tree, from, rules, found);
    }
    if (tree.root && time_step_s > 0) set_time_step(*tree.root, time_step_s);
    if (tree.root) result.scene = SceneBuilder(registry, tree, found).build(virtual_path);
  } catch (const std::exception& e) {
    found.error({virtual_path.generic_string(), 0, 0}, std::string("cannot be loaded: ") + e.what());
  } catch (...) {
    found.error({virtual_path.generic_string(), 0, 0}, "cannot be loaded");
  }
  result.diagnostics = tidy(std::move(found));
  if (!result.diagnostics.ok()) result.scene.reset();
  return result;
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
  LoadResult result;
  try {
    std::string text;
    if (const std::string error = read_text_file(file.string(), DocumentLimits{}.file_bytes, text); !error.empty()) {
      result.diagnostics.error({file.generic_string(), 0, 0}, error);
      return result;
    }
    return load_expanded(text, file, registry, time_step_s, rules);
  } catch (const std::exception& e) {
    result.diagnostics.error({file.generic_string(), 0, 0}, std::string("cannot be read: ") + e.what());
    return result;
  }
}

}  // namespace insula
