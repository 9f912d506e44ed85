// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/project_folder.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path out = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path).lexically_normal() : out;
}

}  // namespace

fs::path own_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

fs::path project_folder() {
  std::error_code error;
  const fs::path bin = own_program().parent_path();
  for (const fs::path& root : {fs::path("."), bin / "../../..", bin / "../share/insula"})
    if (fs::is_regular_file(root / "scenes/training/1_sylvian_fissure.xml", error)) return root.lexically_normal();
  return {};
}

std::string scene_name(const fs::path& scene) {
  const fs::path file = resolved(scene), root = project_folder();
  if (root.empty()) return file.generic_string();
  const fs::path below = file.lexically_relative(resolved(root));
  return below.empty() || *below.begin() == ".." ? file.generic_string() : below.generic_string();
}

fs::path scene_file(const std::string& name) {
  const fs::path file(name), root = project_folder();
  return file.is_absolute() || root.empty() ? file : root / file;
}

}  // namespace insula
