// SPDX-License-Identifier: GPL-3.0-or-later
// Loading, and what a scene says of itself.
#include "core/base/input_error.h"
#include "core/sim/settings.h"
#include "engine/sharing/scene_names.h"
#include "python/src/bind.h"

namespace insula::python {
namespace {

/// Component (empty: a variable), parameter, value; file, line and column where it was written.
using EditTuple = std::tuple<std::string, std::string, std::string, std::string, int, int>;

std::vector<SceneEdit> edits_of(const std::vector<EditTuple>& tuples) {
  std::vector<SceneEdit> out;
  for (const auto& [component, name, value, file, line, column] : tuples)
    out.push_back({component, name, value, {file, line, column}});
  return out;
}

void bind_scene_names(nb::module_& m) {
  m.def(
      "shipped_scenes",
      [](const std::string& folder) {
        std::vector<std::pair<std::string, std::string>> out;
        for (const NamedScene& s : shipped_scenes(folder)) out.emplace_back(s.name, s.file.string());
        return out;
      },
      "folder"_a, "Name and file of each scene in a folder's scenes/. insula.scenes() calls it.");
  m.def(
      "scene_called",
      [](const std::string& given, const std::string& folder) {
        try {
          return scene_called(given, [&] { return shipped_scenes(folder); }).string();
        } catch (const InputError& e) {
          PyErr_SetString(PyExc_FileNotFoundError, e.what());
          throw nb::python_error();
        }
      },
      "given"_a, "folder"_a, "The file of a scene, given itself or by its name. Raises FileNotFoundError.");
}

}  // namespace

void bind_load(nb::module_& m, RunClass& run) {
  bind_scene_names(m);
  m.def(
      "load",
      [](const std::string& text, const std::string& file, const std::vector<std::string>& plugins, int threads,
         double time_step, const std::vector<EditTuple>& edits) {
        if (threads < 0) throw std::invalid_argument("threads: at least 0");
        Loaded loaded;
        {
          nb::gil_scoped_release free;
          loaded = load_run(text, file, {plugins, threads, time_step, edits_of(edits)});
        }
        return std::pair(std::move(loaded.run), std::move(loaded.problems));
      },
      "text"_a, "file"_a, "plugins"_a, "threads"_a, "time_step"_a, "edits"_a = std::vector<EditTuple>(),
      "Loads a scene. Returns the simulation, None after an error, and all problems. insula.load() calls it.");
  m.def(
      "check",
      [](const std::string& file, const std::vector<std::string>& plugins, double time_step,
         const std::vector<EditTuple>& edits) {
        Checked checked;
        {
          nb::gil_scoped_release free;
          checked = check_scene(file, {plugins, 1, time_step, edits_of(edits)});
        }
        return std::pair(std::move(checked.problems), checked.hash);
      },
      "file"_a, "plugins"_a, "time_step"_a, "edits"_a,
      "Checks a scene without preparing a first step. Returns all problems, and the hash of its files.");
  run.def_prop_ro(
         "title", [](const Run& r) { return r.simulation().scene().title(); }, "Title of the scene.")
      .def_prop_ro(
          "file", [](const Run& r) { return r.simulation().scene().file().string(); }, "File of the scene.")
      .def_prop_ro(
          "warnings", [](const Run& r) { return r.warnings(); }, "What the loader warned of.")
      .def_prop_ro(
          "scene_hash", [](const Run& r) { return r.simulation().scene().content_hash(); },
          "Hash of the scene's files and of what was set in them.")
      .def_prop_ro(
          "time_step", [](const Run& r) { return r.simulation().h(); }, "Length of a step, s.")
      .def_prop_ro(
          "settle_time",
          [](const Run& r) {
            const auto settings = r.simulation().scene().all<SettleSettings>();
            return settings.empty() ? 0.0 : settings.front()->time();
          },
          "Simulated time before the first step, in which the scene comes to rest, s. 0: none.")
      .def("__repr__", [](const Run& r) {
        return "<insula.Simulation \"" + r.simulation().scene().title() + "\" at " +
               std::to_string(r.simulation().time()) + " s>";
      });
}

}  // namespace insula::python
