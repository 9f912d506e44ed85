// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/base/input_error.h"
#include "tools/case_builder/scenes.h"

namespace insula::case_builder {
namespace {

void copy_all(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::copy(from, to, fs::copy_options::recursive | fs::copy_options::overwrite_existing, error);
  if (error) throw InputError(to.string() + ": cannot be written: " + error.message());
}

/// Clips of the library that a former choice has brought. What an author has added stays.
void remove_unwanted_clips(const fs::path& library, const fs::path& copies, const std::vector<std::string>& wanted) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(library, ignored)) {
    const fs::path name = entry.path().filename();
    if (std::find(wanted.begin(), wanted.end(), name.string()) == wanted.end() && entry.is_directory())
      fs::remove_all(copies / name, ignored);
  }
}

}  // namespace

Assets link_assets(const CaseFolder& folder, const fs::path& project, const std::vector<std::string>& clips,
                   const Approach& approach) {
  const fs::path here = fs::weakly_canonical(folder.path), root = fs::weakly_canonical(project);
  const fs::path inside = here.lexically_relative(root);
  Assets out;
  if (!inside.empty() && *inside.begin() != "..") {
    out.meshes = (root / "meshes").lexically_relative(here).generic_string();
    out.parts = (root / "scenes/parts").lexically_relative(here).generic_string();
    out.lobes = (here / "lobes").lexically_relative(root / "scenes/parts").generic_string();
    return out;
  }
  // A scene may name files below the folder that holds "meshes" alone: the case brings all it needs.
  out = {"meshes", "scenes/parts", "../../lobes", true};
  std::vector<std::string> parts{
      "vessel_limits.xml",    "bleb.xml",           "metrics.xml",      "strand_metrics.xml",
      "bleeding_metrics.xml", approach.closed_part, approach.open_part, approach.limits_part};
  parts.insert(parts.end(), approach.more_parts.begin(), approach.more_parts.end());
  for (const std::string& part : parts) copy_all(root / "scenes/parts" / part, here / "scenes/parts" / part);
  for (const char* tool : {"suction", "dissector", "clip_applier", "retractor", "micro_doppler"})
    copy_all(root / "meshes/instruments" / tool, here / "meshes/instruments" / tool);
  for (const std::string& clip : clips) copy_all(root / "meshes/clips" / clip, here / "meshes/clips" / clip);
  remove_unwanted_clips(root / "meshes/clips", here / "meshes/clips", clips);
  for (const std::string& bone : approach.rigid_folders) copy_all(root / "meshes" / bone, here / "meshes" / bone);
  return out;
}

}  // namespace insula::case_builder
