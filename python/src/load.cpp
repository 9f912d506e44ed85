// SPDX-License-Identifier: GPL-3.0-or-later
// From a file or a text to a run.
#include <dlfcn.h>

#include <sstream>

#include "core/base/input_error.h"
#include "core/scene/loader.h"
#include "core/xml/document.h"
#include "engine/command_line/load_plugins.h"
#include "python/src/run.h"

namespace insula::python {
namespace {

/// A shared plugin takes the core from this module, whose symbols Python loads for itself alone.
void share_own_symbols() {
  static const bool shared = [] {
    Dl_info info{};
    return dladdr(reinterpret_cast<void*>(&share_own_symbols), &info) != 0 &&
           dlopen(info.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL) != nullptr;
  }();
  if (!shared) throw InputError("this module cannot share its symbols with plugins");
}

/// The elements of the program and of the plugins.
std::unique_ptr<Registry> registry_with(const std::vector<std::string>& plugins) {
  auto registry = std::make_unique<Registry>();
  if (!plugins.empty()) share_own_symbols();
  std::ostringstream wrong;
  if (load_plugins(*registry, {plugins.begin(), plugins.end()}, wrong) != 0) throw InputError(wrong.str());
  return registry;
}

}  // namespace

Loaded load_run(const std::string& text, const std::string& file, const LoadOptions& options) {
  auto registry = registry_with(options.plugins);
  LoadResult scene = load_scene_edited(text, file, *registry, options.edits, options.time_step_s);
  Loaded out;
  std::unique_ptr<Simulation> simulation;
  if (scene.scene)
    simulation = std::make_unique<Simulation>(std::move(scene.scene), scene.diagnostics, options.threads);
  out.problems = scene.diagnostics.all();
  if (simulation && scene.diagnostics.ok())
    out.run = std::make_unique<Run>(std::move(registry), std::move(simulation), out.problems);
  return out;
}

Checked check_scene(const std::string& file, const LoadOptions& options) {
  const auto registry = registry_with(options.plugins);
  const LoadResult scene = load_scene_edited("", file, *registry, options.edits, options.time_step_s);
  return {scene.diagnostics.all(), scene.scene ? scene.scene->content_hash() : 0};
}

}  // namespace insula::python
