// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/sharing/scene_names.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/diagnostic.h"
#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "engine/sharing/case_list.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

/// "3_clipping" is clipping.
std::string without_number(const std::string& stem) {
  const std::size_t digits = stem.find_first_not_of("0123456789");
  return digits != std::string::npos && digits > 0 && stem[digits] == '_' ? stem.substr(digits + 1) : stem;
}

/// Of a scene in a case's folder.
std::string name_in_case(const std::string& of_case, const fs::path& file) {
  const std::string stem = without_number(file.stem().string());
  return stem == "case" ? of_case : of_case + "/" + stem;
}

bool is_scene(const fs::path& file) {
  return file.extension() == ".xml" && read_file_bytes(file).find("<scene") != std::string::npos;
}

}  // namespace

std::vector<NamedScene> shipped_scenes(const fs::path& project) {
  std::vector<NamedScene> out;
  for (const char* group : {"training", "skills", "cases"}) {
    const fs::path folder = project / "scenes" / group;
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
      if (it->is_regular_file(error) && is_scene(it->path())) files.push_back(it->path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      const bool alone = file.parent_path() == folder;
      out.push_back(
          {alone ? without_number(file.stem().string()) : name_in_case(file.parent_path().filename().string(), file),
           file});
    }
  }
  return out;
}

std::vector<NamedScene> added_scenes(const fs::path& data) {
  std::vector<NamedScene> out;
  for (const CatalogueEntry& e : added_exercises(data))
    out.push_back({name_in_case(fs::path(e.of_case).filename().string(), e.scene), e.scene});
  return out;
}

fs::path scene_called(const std::string& given, const std::function<std::vector<NamedScene>()>& scenes) {
  const fs::path file(given);
  std::error_code error;
  if (fs::is_regular_file(file, error) || file.has_extension() || file.is_absolute()) return file;
  std::vector<std::string> names;
  for (const NamedScene& s : scenes()) {
    const bool as_its_file = s.name == without_number(given) && s.file.stem() == given;
    if (s.name == given || as_its_file) return s.file.lexically_normal();
    names.push_back(s.name);
  }
  const std::string near = nearest_name(given, names);
  const std::string hint = near.empty() ? fmt::format("; there are {}", fmt::join(names, ", ")) : did_you_mean(near);
  throw InputError("no scene " + in_quotes(given) + hint);
}

}  // namespace insula
