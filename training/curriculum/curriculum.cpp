// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/curriculum.h"

#include "core/scene/expand.h"

namespace insula {

std::string scene_key(const std::filesystem::path& scene_file) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(scene_file, error);
  const std::filesystem::path& file = error ? scene_file : whole;
  const std::filesystem::path inside = file.lexically_relative(scene_root_folder(file));
  return (inside.empty() || *inside.begin() == ".." ? file.filename() : inside).generic_string();
}

const Task* find_task(const Curriculum& curriculum, const std::string& id) {
  for (const Module& module : curriculum.modules)
    for (const Task& task : module.tasks)
      if (task.id == id) return &task;
  return nullptr;
}

}  // namespace insula
