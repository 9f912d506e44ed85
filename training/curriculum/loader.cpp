// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/loader.h"

#include <algorithm>
#include <exception>
#include <string>

#include "core/scene/first_diagnostics.h"
#include "core/xml/document.h"
#include "training/curriculum/checker.h"
#include "training/curriculum/reader.h"

namespace insula {
namespace {

std::string first_name(std::string_view text, std::size_t at) {
  const std::size_t end = text.find_first_of(" \t\r\n/>", at);
  return std::string(text.substr(at, std::min(end, text.size()) - at).substr(0, 64));
}

}  // namespace

CurriculumResult load_curriculum_text(std::string_view text, const std::filesystem::path& virtual_path,
                                      CurriculumSources& sources) {
  CurriculumResult result;
  Diagnostics found;
  try {
    auto tree = expand_scene(text, virtual_path, found);
    CurriculumReader reader(tree, sources.shipped_folder(), found);
    if (const auto root = tree.root ? reader.read() : nullptr) {
      result.curriculum = CurriculumChecker(reader, sources, tree.suggestions, found).check(*root);
      result.curriculum->content_hash = tree.hash.value();
    }
  } catch (const std::exception& e) {
    found.error({virtual_path.generic_string(), 0, 0}, std::string("cannot be loaded: ") + e.what());
  }
  result.diagnostics = first_diagnostics(std::move(found));
  if (!result.diagnostics.ok()) result.curriculum.reset();
  return result;
}

CurriculumResult load_curriculum(const std::filesystem::path& file, CurriculumSources& sources) {
  std::string text;
  if (const std::string error = read_text_file(file.string(), DocumentLimits{}.file_bytes, text); !error.empty()) {
    CurriculumResult result;
    result.diagnostics.error({file.generic_string(), 0, 0}, error);
    return result;
  }
  return load_curriculum_text(text, file, sources);
}

bool is_curriculum_file(const std::filesystem::path& file) {
  std::string text;
  if (!read_text_file(file.string(), DocumentLimits{}.file_bytes, text).empty()) return false;
  // The first start tag decides, also where something is wrong behind it.
  std::size_t at = 0;
  while ((at = text.find('<', at)) != std::string::npos && at + 1 < text.size()) {
    if (text[at + 1] == '?') at = text.find("?>", at);
    else if (text.compare(at, 4, "<!--") == 0) at = text.find("-->", at);
    else return nearest_name(first_name(text, at + 1), {"curriculum", "scene", "part"}) == "curriculum";
    if (at == std::string::npos) break;
  }
  return false;
}

}  // namespace insula
