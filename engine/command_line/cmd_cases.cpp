// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/base/removed_at_end.h"
#include "core/base/text.h"
#include "core/sim/simulation.h"
#include "engine/command_line/cases.h"
#include "engine/live/project_folder.h"
#include "engine/sharing/case_page.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

/// Runs what may refuse its input.
template <class Work>
int refusing(const CommandContext& context, Work work) {
  try {
    return work();
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
  } catch (const fs::filesystem_error& e) {
    fmt::print(context.err, "error: {}\n", e.what());
  }
  return 2;
}

/// Throws InputError if one of the scenes does not load. Its errors are printed.
void check_scenes(const CommandContext& context, const std::vector<fs::path>& scenes) {
  for (const fs::path& scene : scenes) {
    const auto loaded = load_simulation(scene, context.registry);
    if (loaded.simulation) continue;
    fmt::print(context.err, "{}", loaded.diagnostics.format());
    throw InputError(scene.string() + ": does not load");
  }
}

/// What is to be added, as an archive: the given one, or one of the given folder, which goes at the end.
class Packed {
 public:
  Packed(const fs::path& given, const fs::path& beside)
      : archive_(given),
        name_(given.stem().string()),
        made_(fs::is_directory(given) ? beside / ("." + given.filename().string() + ".zip") : fs::path()) {
    if (made_.path().empty()) return;
    const ListedCase c = built_case(given);
    fs::create_directories(beside);
    archive_ = made_.path();
    name_ = c.name;
    pack_listed(c, project_folder(), archive_);
  }
  const fs::path& archive() const { return archive_; }
  const std::string& name() const { return name_; }

 private:
  fs::path archive_;
  std::string name_;
  RemovedAtEnd made_;
};

/// A case of the same name, out of the way. It comes back if there is none of its name at the end.
class Replaced {
 public:
  /// place: empty: nothing is replaced.
  explicit Replaced(const fs::path& place)
      : place_(place), kept_(place.parent_path() / ("." + place.filename().string() + ".before")) {
    if (place_.empty()) return;
    if (fs::exists(place_)) {
      fs::remove_all(kept_);
      fs::rename(place_, kept_);
    }
  }
  ~Replaced() {
    std::error_code ignored;
    if (place_.empty()) return;
    if (fs::exists(place_, ignored)) fs::remove_all(kept_, ignored);
    else fs::rename(kept_, place_, ignored);
  }
  Replaced(const Replaced&) = delete;
  Replaced& operator=(const Replaced&) = delete;

 private:
  fs::path place_, kept_;
};

std::vector<fs::path> scenes_of(const ListedCase& c) {
  std::vector<fs::path> out;
  for (const CatalogueEntry& e : c.exercises) out.push_back(project_folder() / e.scene);
  return out;
}

std::string exercise_ids(const ListedCase& c) {
  std::vector<std::string> ids;
  for (const CatalogueEntry& e : c.exercises) ids.push_back(exercise_id(e));
  return joined(ids);
}

}  // namespace

int cmd_cases(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const std::vector<ListedCase> cases = list_cases(project_folder(), o.data);
    if (o.json) {
      fmt::print(context.out, "{}\n",
                 cases_json(cases).dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
      return 0;
    }
    for (const ListedCase& c : cases)
      fmt::print(context.out, "{:<28} {:<26} {}  {} exercise{}{}: {}\n", c.name, c.site().empty() ? "-" : c.site(),
                 c.difficulty() > 0 ? std::to_string(c.difficulty()) : "-", c.exercises.size(),
                 c.exercises.size() == 1 ? "" : "s", c.added ? ", added" : "", exercise_ids(c));
    return 0;
  });
}

int cmd_cases_pack(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const std::vector<ListedCase> cases = list_cases(project_folder(), o.data);
    const auto it = std::find_if(cases.begin(), cases.end(), [&](const ListedCase& c) { return c.name == o.name; });
    if (it == cases.end()) throw InputError("there is no case \"" + o.name + "\"; insula cases lists them");
    const fs::path archive = o.file.empty() ? fs::path(o.name + ".zip") : o.file;
    check_scenes(context, scenes_of(*it));
    const PackedCase packed = pack_listed(*it, project_folder(), archive);
    fmt::print(context.out, "{}: {} scenes, {} files, {:.1f} MB unpacked\n", archive.string(), packed.scenes.size(),
               packed.files, 1e-6 * double(packed.bytes));
    return 0;
  });
}

int cmd_cases_add(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const fs::path folder = added_cases_folder(o.data);
    const Packed given(o.file, folder);
    const Replaced before(o.replace ? folder / given.name() : fs::path());
    const PackedCase packed = unpack_case(given.archive(), folder);
    std::vector<fs::path> scenes;
    for (const std::string& scene : packed.scenes) scenes.push_back(folder / packed.name / scene);
    try {
      check_scenes(context, scenes);
    } catch (const InputError&) {
      fs::remove_all(folder / packed.name);
      throw;
    }
    fmt::print(context.out, "{} is added: {} exercises, on the start page under cases\n", packed.name,
               packed.scenes.size());
    return 0;
  });
}

int cmd_cases_copy(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const fs::path to = fs::absolute(o.to).lexically_normal(), beside = to.parent_path();
    const std::string name = to.filename().string();
    fs::create_directories(beside);
    const RemovedAtEnd archive(beside / ("." + name + ".zip"));
    if (fs::is_directory(o.file)) {
      ListedCase built = built_case(o.file);
      built.name = name;
      pack_listed(built, project_folder(), archive.path());
    } else {
      pack_case(name, {o.file}, {}, archive.path());
    }
    const PackedCase copied = unpack_case(archive.path(), beside);
    fmt::print(context.out, "{}: {} scenes, {} files\n", to.string(), copied.scenes.size(), copied.files);
    return 0;
  });
}

int cmd_cases_new(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const fs::path to = fs::absolute(o.to).lexically_normal();
    const std::string name = to.filename().string(), scene = name + ".xml";
    if (!is_case_name(name))
      throw InputError("the name of a scene has letters, digits, _ and - only, 64 at most: \"" + name + "\" has not");
    if (fs::exists(to)) throw InputError(to.string() + " exists already");
    const fs::path meshes = fs::path("meshes") / "examples";
    fs::create_directories(to / meshes);
    for (const auto& file : fs::directory_iterator(project_folder() / meshes))
      if (const std::string kind = file.path().extension().string(); kind == ".msh" || kind == ".obj")
        fs::copy_file(file.path(), to / meshes / file.path().filename());
    const nlohmann::ordered_json manifest = {
        {"format", 1}, {"name", name}, {"scenes", {scene}}, {"files", nlohmann::ordered_json::object()}};
    std::ofstream(to / scene) << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<scene title=\"" << name
                              << "\">\n</scene>\n";
    std::ofstream list(to / case_manifest);
    list << manifest.dump(1) << "\n";
    if (!list.flush()) throw InputError(to.string() + ": cannot be written");
    fmt::print(context.out, "{}: a scene without components\n", (to / scene).string());
    return 0;
  });
}

int cmd_cases_remove(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const fs::path folder = added_cases_folder(o.data) / o.name;
    if (!is_case_name(o.name) || !fs::is_directory(folder))
      throw InputError("no case \"" + o.name + "\" was added; insula cases lists them");
    fs::remove_all(folder);
    fmt::print(context.out, "{} is removed\n", o.name);
    return 0;
  });
}

int cmd_cases_page(const CommandContext& context, const CasesOptions& o) {
  return refusing(context, [&] {
    const std::vector<ListedCase> cases = list_cases(project_folder(), o.data);
    for (const ListedCase& c : cases) check_scenes(context, scenes_of(c));
    write_case_page(cases, project_folder(), o.file);
    fmt::print(context.out, "{}: {} cases\n", (o.file / "index.html").string(), cases.size());
    return 0;
  });
}

}  // namespace insula
