// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_scene_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>

#include "core/base/case_name.h"
#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/replace_file.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

constexpr const char* copy_manifest = "insula_case.json";
constexpr const char* kept_folder = ".kept";
constexpr const char* draft_file = "draft.xml";
constexpr std::size_t most_versions = 100;
constexpr const char* not_written = "the scene cannot be written: is the disk full?";

/// The numbers of the versions in a folder, the newest first.
std::vector<int> version_numbers(const fs::path& folder) {
  std::vector<int> out;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string stem = it->path().stem().string();
    int number = 0;
    if (std::from_chars(stem.data(), stem.data() + stem.size(), number).ptr == stem.data() + stem.size() && number > 0)
      out.push_back(number);
  }
  std::sort(out.rbegin(), out.rend());
  return out;
}

fs::path version_file(const fs::path& folder, int number) { return folder / (std::to_string(number) + ".xml"); }

nlohmann::json versions_json(const fs::path& folder) {
  auto out = nlohmann::json::array();
  for (const int number : version_numbers(folder)) {
    std::error_code error;
    const auto time = fs::last_write_time(version_file(folder, number), error);
    if (error) continue;
    const auto clock = std::chrono::file_clock::to_sys(time).time_since_epoch();
    out.push_back(
        {{"number", number}, {"time_ms", std::chrono::duration_cast<std::chrono::milliseconds>(clock).count()}});
  }
  return out;
}

void keep_version(const fs::path& folder, const std::string& text) {
  const std::vector<int> numbers = version_numbers(folder);
  if (!replace_file(version_file(folder, numbers.empty() ? 1 : numbers.front() + 1), text))
    throw InputError(not_written);
  std::error_code ignored;
  for (std::size_t k = most_versions - 1; k < numbers.size(); ++k)
    fs::remove(version_file(folder, numbers[k]), ignored);
}

/// Every file below `from` again below `to`, but what was kept of earlier texts.
void link_files(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (fs::recursive_directory_iterator it(from), end; it != end; ++it) {
    if (it->path().filename() == kept_folder) {
      it.disable_recursion_pending();
      continue;
    }
    const fs::path target = to / it->path().lexically_relative(from);
    std::error_code error;
    if (it->is_directory()) fs::create_directories(target);
    else fs::create_hard_link(it->path(), target, error);
    if (error) fs::copy_file(it->path(), target);
  }
}

}  // namespace

std::vector<std::string> StudioSceneFiles::names() const {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator it(root_, error), end; !error && it != end; it.increment(error))
    if (const std::string name = it->path().filename().string(); has(name)) out.push_back(name);
  std::sort(out.begin(), out.end());
  return out;
}

bool StudioSceneFiles::has(const std::string& name) const {
  std::error_code error;
  return is_case_name(name) && fs::is_regular_file(folder(name) / copy_manifest, error);
}

std::vector<std::string> StudioSceneFiles::listed(const std::string& name, bool xml) const {
  std::vector<std::string> out;
  if (!has(name)) return out;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder(name), error), end; !error && it != end; it.increment(error)) {
    if (it->path().filename() == kept_folder) it.disable_recursion_pending();
    else if ((it->path().extension() == ".xml") == xml && it->path().filename() != copy_manifest &&
             !it->is_symlink(error) && it->is_regular_file(error))
      out.push_back(it->path().lexically_relative(folder(name)).generic_string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> StudioSceneFiles::files(const std::string& name) const { return listed(name, true); }
std::vector<std::string> StudioSceneFiles::meshes(const std::string& name) const { return listed(name, false); }

std::vector<std::string> StudioSceneFiles::scenes(const std::string& name) const {
  std::vector<std::string> out;
  const nlohmann::json manifest = read_json(folder(name) / copy_manifest);
  if (!manifest.is_object() || !manifest.contains("scenes")) return out;
  for (const auto& scene : manifest["scenes"])
    if (scene.is_string() && holds(name, scene.get<std::string>())) out.push_back(scene.get<std::string>());
  return out;
}

bool StudioSceneFiles::holds(const std::string& name, const std::string& file) const {
  const std::vector<std::string> all = files(name);
  return std::find(all.begin(), all.end(), file) != all.end();
}

fs::path StudioSceneFiles::kept(const std::string& name, const std::string& file) const {
  return folder(name) / kept_folder / file;
}

std::optional<StudioSceneFiles::Text> StudioSceneFiles::read(const std::string& name, const std::string& file) const {
  if (!holds(name, file)) return std::nullopt;
  Text out{read_file_bytes(folder(name) / file), std::nullopt, versions_json(kept(name, file))};
  std::error_code error;
  if (const fs::path draft = kept(name, file) / draft_file; fs::is_regular_file(draft, error))
    out.draft = read_file_bytes(draft);
  return out;
}

std::string StudioSceneFiles::Text::revision() const {
  Fnv1a hash;
  hash.add(text);
  hash.add(draft ? "draft" : "");
  if (draft) hash.add(*draft);
  return fmt::format("{:016x}", hash.value());
}

std::optional<std::string> StudioSceneFiles::version(const std::string& name, const std::string& file,
                                                     int number) const {
  std::error_code error;
  const fs::path path = version_file(kept(name, file), number);
  if (!holds(name, file) || !fs::is_regular_file(path, error)) return std::nullopt;
  return read_file_bytes(path);
}

bool StudioSceneFiles::write(const std::string& name, const std::string& file, const std::string& text) const {
  if (!holds(name, file)) return false;
  const fs::path path = folder(name) / file, versions = kept(name, file);
  std::error_code ignored;
  fs::create_directories(versions, ignored);
  if (const std::string before = read_file_bytes(path); before != text) {
    keep_version(versions, before);
    if (!replace_file(path, text)) throw InputError(not_written);
  }
  fs::remove(versions / draft_file, ignored);
  return true;
}

bool StudioSceneFiles::keep_draft(const std::string& name, const std::string& file, const std::string& text) const {
  if (!holds(name, file)) return false;
  std::error_code ignored;
  fs::create_directories(kept(name, file), ignored);
  return replace_file(kept(name, file) / draft_file, text);
}

std::optional<fs::path> StudioSceneFiles::for_check(const std::string& name, const std::string& file,
                                                    const std::string& text) const {
  if (!holds(name, file)) return std::nullopt;
  Fnv1a hash;
  hash.add(file);
  const fs::path out = root_ / ".check" / name / fmt::format("{:016x}", hash.value());
  try {
    fs::remove_all(out);
    link_files(folder(name), out);
  } catch (const fs::filesystem_error& e) {
    throw InputError(std::string("the scene cannot be checked: ") + e.what());
  }
  if (!replace_file(out / file, text)) throw InputError("the scene cannot be checked: is the disk full?");
  return out;
}

void StudioSceneFiles::remove(const std::string& name) const {
  std::error_code ignored;
  if (!is_case_name(name)) return;
  fs::remove_all(folder(name), ignored);
  fs::remove_all(root_ / ".check" / name, ignored);
}

}  // namespace insula::gateway
