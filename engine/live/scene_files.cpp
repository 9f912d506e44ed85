// SPDX-License-Identifier: GPL-3.0-or-later
// Files are found by their form in the expanded tree, so that a scene with errors can be watched too.
#include "engine/live/scene_files.h"

#include <algorithm>
#include <set>

#include "core/scene/expand.h"
#include "core/xml/document.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

constexpr std::size_t max_of_a_folder = 200;

/// "meshes/a.msh", "../x.csv": no blanks, an extension with a letter.
bool looks_like_a_file(const std::string& value) {
  if (value.empty() || value.size() > 512 || value.find_first_of(" \t\n$\\:") != std::string::npos) return false;
  const std::string extension = fs::path(value).extension().string();
  return extension.size() >= 2 && extension.size() <= 6 &&
         std::any_of(extension.begin(), extension.end(), [](unsigned char c) { return std::isalpha(c); });
}

class Finder {
 public:
  explicit Finder(std::set<fs::path>& out) : out_(out) {}

  void value(const fs::path& folder, const std::string& text) {
    if (!looks_like_a_file(text)) return;
    std::error_code ec;
    const fs::path file = fs::weakly_canonical(folder / text, ec);
    if (ec || !fs::is_directory(file.parent_path(), ec)) return;
    out_.insert(file);
    if (file.extension() != ".urdf" && file.extension() != ".json") return;
    std::size_t count = 0;
    for (fs::directory_iterator it(file.parent_path(), ec), end; !ec && it != end && count < max_of_a_folder;
         it.increment(ec))
      if (std::error_code ignored; it->is_regular_file(ignored)) {
        out_.insert(it->path());
        ++count;
      }
  }
  void element(const Element& e) {
    if (e.part)
      for (const Attribute& a : e.attributes) value(e.part->path.parent_path(), a.value);
    for (const auto& child : e.children) element(*child);
  }

 private:
  std::set<fs::path>& out_;
};

}  // namespace

std::vector<fs::path> scene_files(const fs::path& scene) {
  std::set<fs::path> out;
  std::error_code ec;
  const fs::path main = fs::weakly_canonical(fs::absolute(scene, ec), ec);
  out.insert(main);
  std::string text;
  if (read_text_file(main.string(), DocumentLimits{}.file_bytes, text).empty()) {
    Diagnostics unused;
    Finder finder(out);
    // The text as written gives the names of missing files in includes. The expanded tree gives all others.
    if (const Document document = parse_document(text, main.string(), unused); document.root)
      for (const auto& child : document.root->children)
        if (const Attribute* file = child->name == "include" ? child->find("file") : nullptr)
          finder.value(main.parent_path(), file->value);
    const ExpandedScene tree = expand_scene(text, main, unused);
    for (const auto& part : tree.parts) out.insert(part->path);
    if (tree.root) finder.element(*tree.root);
  }
  return {out.begin(), out.end()};
}

}  // namespace insula
