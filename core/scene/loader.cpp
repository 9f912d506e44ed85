// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene file to checked components: the order of the steps, and the last line of defence.
#include "core/scene/loader.h"

#include <fmt/format.h>

#include <exception>

#include "core/scene/builder.h"
#include "core/xml/document.h"
#include "core/scene/expand.h"

namespace insula {
namespace {

constexpr int max_errors = 200;

/// In order of position; beyond a screenful or ten nobody reads on.
Diagnostics tidy(Diagnostics all) {
  all.sort_by_position();
  if (static_cast<int>(all.all().size()) <= max_errors) return all;
  Diagnostics out;
  for (const auto& d : all.all()) {
    if (static_cast<int>(out.all().size()) == max_errors) break;
    d.severity == Severity::error ? out.error(d.pos, d.text) : out.warning(d.pos, d.text);
  }
  // The number of errors must not become zero by cutting warnings off the front of them.
  const auto left = all.all().size() - out.all().size();
  const SourcePos whole_file{all.all().front().pos.file, 0, 0};
  const std::string text = "and " + std::to_string(left) + " more messages";
  all.ok() ? out.warning(whole_file, text) : out.error(whole_file, text);
  return out;
}

void set_time_step(Element& root, double step_s) {
  std::erase_if(root.attributes, [](const Attribute& a) { return a.name == "time_step"; });
  root.attributes.push_back({"time_step", fmt::format("{:.9g} s", step_s), root.pos, root.pos});
}

}  // namespace

LoadResult load_scene_text(std::string_view text, const std::filesystem::path& virtual_path, const Registry& registry, double time_step_s) {
  LoadResult result;
  Diagnostics found;
  try {
    auto tree = expand_scene(text, virtual_path, found);
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

LoadResult load_scene(const std::filesystem::path& file, const Registry& registry, double time_step_s) {
  LoadResult result;
  try {
    std::string text;
    if (const std::string error = read_text_file(file.string(), DocumentLimits{}.file_bytes, text); !error.empty()) {
      result.diagnostics.error({file.generic_string(), 0, 0}, error);
      return result;
    }
    return load_scene_text(text, file, registry, time_step_s);
  } catch (const std::exception& e) {
    result.diagnostics.error({file.generic_string(), 0, 0}, std::string("cannot be read: ") + e.what());
    return result;
  }
}

}  // namespace insula
