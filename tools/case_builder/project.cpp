// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/project.h"

#include "core/base/input_error.h"

namespace insula::case_builder {

namespace fs = std::filesystem;

fs::path find_project(const fs::path& near) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& start : {fs::weakly_canonical(near, error), program, fs::path(INSULA_SOURCE_DIR)})
    for (fs::path folder = start; !folder.empty(); folder = folder.parent_path()) {
      if (fs::exists(folder / "scenes/parts/retracted_fissure.xml", error) &&
          fs::exists(folder / "meshes/lobes/frontal.msh", error) &&
          fs::exists(folder / "meshes/clips/catalogue.json", error))
        return folder;
      if (folder == folder.parent_path()) break;
    }
  throw InputError("the project's folder with scenes/parts and meshes is nowhere: run from inside of it");
}

}  // namespace insula::case_builder
