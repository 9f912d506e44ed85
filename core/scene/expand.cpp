// SPDX-License-Identifier: GPL-3.0-or-later
// Includes and variables.
#include "core/scene/expand.h"

#include <algorithm>

#include "core/scene/edits.h"
#include "core/scene/variables.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t max_include_depth = 16;
constexpr std::size_t max_includes = 256;
constexpr std::size_t max_bytes = 64u << 20;

bool is_namespace_attribute(std::string_view name) {
  return name == "xmlns" || name.starts_with("xmlns:") || name.starts_with("xsi:");
}

bool is_prefix(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
}

class Expander {
 public:
  Expander(ExpandedScene& out, Diagnostics& diagnostics)
      : out_(out), diagnostics_(diagnostics), variables_(diagnostics, out.suggestions) {}

  void run(std::string_view text, const fs::path& path, const std::vector<SceneEdit>& edits) {
    std::error_code ec;
    fs::path canonical = fs::weakly_canonical(path, ec);
    if (ec) canonical = path;
    ScenePart& part = add_part({canonical, path.generic_string(), {""}});
    out_.root = parse(text, part);
    if (!out_.root) return;
    stack_.push_back(&part);
    auto& scope = variables_.new_scope(nullptr);
    Variables::Scope given;
    for (const SceneEdit& e : edits)
      if (e.component.empty()) variables_.define(scope, given, e.name, e.value, e.pos, e.pos, true);
    expand_root(*out_.root, part, scope, 0);
    variables_.refuse_unused(given);
    variables_.warn_unused();
  }

 private:
  ScenePart& add_part(ScenePart part) {
    out_.parts.push_back(std::make_unique<ScenePart>(std::move(part)));
    return *out_.parts.back();
  }

  std::unique_ptr<Element> parse(std::string_view text, const ScenePart& part) {
    out_.hash.add(text);
    bytes_ += text.size();
    DocumentLimits limits;
    limits.elements -= std::min(limits.elements, elements_);
    return parse_document(text, part.shown, diagnostics_, limits).root;
  }

  void expand_root(Element& root, ScenePart& part, Variables::Scope& scope, std::size_t depth) {
    std::erase_if(root.attributes, [](const Attribute& a) { return is_namespace_attribute(a.name); });
    Variables::Scope local;
    for (const auto& child : root.children)
      if (child->name == "variable") define(*child, scope, local, false);
    std::erase_if(root.children, [](const auto& child) { return child->name == "variable"; });
    expand(root, part, scope, depth);
  }

  void define(const Element& e, Variables::Scope& scope, Variables::Scope& local, bool replace) {
    check_attributes(e, {"name", "value"});
    const Attribute* name = e.find("name");
    const Attribute* value = e.find("value");
    for (const auto& child : e.children) diagnostics_.error(child->pos, "<variable> has no content");
    if (!name || !value)
      return diagnostics_.error(e.pos, std::string("<variable> needs parameter \"") + (name ? "value" : "name") + "\"");
    variables_.define(scope, local, name->value, value->value, name->value_pos, value->value_pos, replace);
  }

  void check_attributes(const Element& e, const std::vector<std::string>& known) {
    for (const auto& a : e.attributes) {
      if (std::find(known.begin(), known.end(), a.name) != known.end()) continue;
      const std::string near = out_.suggestions.afford(known.size()) ? nearest_name(a.name, known) : "";
      diagnostics_.error(a.name_pos, "<" + e.name + "> has no parameter " + in_quotes(a.name) +
                                         (near.empty() ? " (it has: " + joined(known) + ")" : did_you_mean(near)));
    }
  }

  void expand(Element& e, const ScenePart& part, const Variables::Scope& scope, std::size_t depth) {
    e.part = &part;
    ++elements_;
    std::erase_if(e.attributes,
                  [&](Attribute& a) { return !variables_.replace(a.value, scope, a.value_pos) && drop(e, a); });
    bool any = false;
    for (const auto& child : e.children) any = any || child->name == "include" || child->name == "variable";
    if (!any) {
      for (auto& child : e.children) expand(*child, part, scope, depth + 1);
      return;
    }
    std::vector<std::unique_ptr<Element>> children;
    for (auto& child : e.children) {
      if (child->name == "include") {
        include(*child, part, scope, depth, children);
      } else if (child->name == "variable") {
        diagnostics_.error(child->pos, "<variable> may not stand in <" + shown(e.name) +
                                           ">; it belongs directly in <scene>, <part> or <include>");
      } else {
        expand(*child, part, scope, depth + 1);
        children.push_back(std::move(child));
      }
    }
    e.children = std::move(children);
  }

  /// The value has an error that was reported. The loader must not report that it is missing.
  static bool drop(Element& e, Attribute& a) {
    e.broken_attributes.push_back(a.name);
    return true;
  }

  void include(Element& e, const ScenePart& part, const Variables::Scope& scope, std::size_t depth,
               std::vector<std::unique_ptr<Element>>& into) {
    check_attributes(e, {"file", "prefix"});
    auto& inner = variables_.new_scope(&scope);
    Variables::Scope local;
    for (const auto& child : e.children) {
      if (child->name == "variable") define_for_include(*child, scope, inner, local);
      else
        diagnostics_.error(child->pos, "<" + shown(child->name) + "> may not stand in <include>; only <variable> may");
    }
    for (auto& a : e.attributes)
      if (!variables_.replace(a.value, scope, a.value_pos)) return;
    const Attribute* file = e.find("file");
    if (!file) return diagnostics_.error(e.pos, "<include> needs parameter \"file\"");
    std::string prefix;
    if (const Attribute* p = e.find("prefix")) {
      if (!is_prefix(p->value) || p->value.size() > 64)
        return diagnostics_.error(p->value_pos,
                                  "prefix: " + in_quotes(p->value) + " may have only letters, digits and . _ -");
      prefix = p->value;
    }
    std::string error;
    const fs::path path = resolve_file(part.path.parent_path(), out_.root_folder, file->value, error, out_.suggestions);
    if (path.empty()) return diagnostics_.error(file->value_pos, "file: " + error);
    if (const auto it = std::find_if(stack_.begin(), stack_.end(), [&](const auto* p) { return p->path == path; });
        it != stack_.end()) {
      std::string chain;
      for (auto p = it; p != stack_.end(); ++p) chain += (*p)->shown + " -> ";
      return diagnostics_.error(file->value_pos, "include cycle: " + chain + (*it)->shown);
    }
    if (stack_.size() > max_include_depth)
      return diagnostics_.error(file->value_pos,
                                "files are included more than " + std::to_string(max_include_depth) + " deep");
    if (out_.parts.size() > max_includes)
      return diagnostics_.error(file->value_pos, "more than " + std::to_string(max_includes) + " inclusions");
    std::string text;
    if (error = read_text_file(path.string(), DocumentLimits{}.file_bytes, text); !error.empty())
      return diagnostics_.error(file->value_pos, "file: " + in_quotes(file->value) + ": " + error);
    if (bytes_ + text.size() > max_bytes)
      return diagnostics_.error(
          file->value_pos, "the included files are larger than " + std::to_string(max_bytes >> 20) + " MiB in all");
    ScenePart next{path, (fs::path(part.shown).parent_path() / file->value).lexically_normal().generic_string(), {}};
    for (const auto& p : part.prefixes) next.prefixes.push_back(p);
    if (!prefix.empty()) next.prefixes.insert(next.prefixes.begin(), part.prefixes.front() + prefix);
    splice(add_part(std::move(next)), text, inner, depth, into, file->value_pos);
  }

  /// The value of a variable inside <include> is read in the including file, so that width="$width" works.
  void define_for_include(const Element& e, const Variables::Scope& outer, Variables::Scope& inner,
                          Variables::Scope& local) {
    const std::size_t before = local.size();
    define(e, inner, local, true);
    if (local.size() == before) return;
    local.at(e.find("name")->value)->scope = &outer;
  }

  void splice(ScenePart& part, std::string_view text, Variables::Scope& scope, std::size_t depth,
              std::vector<std::unique_ptr<Element>>& into, const SourcePos& include_pos) {
    if (depth + 1 > DocumentLimits{}.depth)
      return diagnostics_.error(include_pos,
                                "elements are nested more than " + std::to_string(DocumentLimits{}.depth) + " deep");
    auto root = parse(text, part);
    if (!root) return;
    if (root->name != "part" && root->name != "scene")
      return diagnostics_.error(
          root->pos, "the root of an included file must be <part> or <scene>, not <" + shown(root->name) + ">");
    // An included <scene> brings its elements; its own attributes count only when it is loaded by itself.
    if (root->name == "part") {
      std::erase_if(root->attributes, [](const Attribute& a) { return is_namespace_attribute(a.name); });
      check_attributes(*root, {"title"});
    }
    stack_.push_back(&part);
    expand_root(*root, part, scope, depth);
    stack_.pop_back();
    for (auto& child : root->children) into.push_back(std::move(child));
  }

  ExpandedScene& out_;
  Diagnostics& diagnostics_;
  Variables variables_;
  std::vector<const ScenePart*> stack_;
  std::size_t elements_ = 0, bytes_ = 0;
};

}  // namespace

fs::path scene_root_folder(const fs::path& scene_file) {
  std::error_code ec;
  fs::path file = fs::weakly_canonical(scene_file, ec);
  if (ec) file = fs::absolute(scene_file, ec);
  const fs::path own = file.parent_path();
  for (fs::path folder = own; !folder.empty(); folder = folder.parent_path()) {
    if (fs::is_directory(folder / "meshes", ec)) return folder;
    if (folder == folder.parent_path()) break;
  }
  return own;
}

namespace {
/// The name in the path's folder that is nearest to the path's own, or empty.
std::string nearest_file(const fs::path& path, Suggestions& suggestions) {
  constexpr std::size_t max_names = 1000;
  if (!suggestions.afford(5 * max_names)) return {};  // reading a folder takes longer than comparing names
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(path.parent_path(), error), end; !error && it != end && names.size() < max_names;
       it.increment(error))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  return nearest_name(path.filename().string(), names);
}
}  // namespace

fs::path resolve_file(const fs::path& folder, const fs::path& root, const std::string& name, std::string& error,
                      Suggestions& suggestions) {
  if (name.empty()) {
    error = "the value is empty; it must name a file";
    return {};
  }
  if (name.find('\0') != std::string::npos || name.size() > 1024) {
    error = in_quotes(name) + " cannot be the name of a file";
    return {};
  }
  const fs::path wanted(name);
  if (wanted.is_absolute()) {
    error = in_quotes(name) + " is an absolute path; write it relative to the file that names it";
    return {};
  }
  std::error_code ec;
  const fs::path path = fs::weakly_canonical(folder / wanted, ec);
  if (ec) {
    error = in_quotes(name) + " cannot be found: " + ec.message();
    return {};
  }
  const fs::path inside = path.lexically_relative(root);
  if (inside.empty() || *inside.begin() == "..") {
    error = in_quotes(name) + " leaves the scene's root folder " + root.filename().string();
    return {};
  }
  const auto status = fs::status(path, ec);
  if (!fs::exists(status)) {
    error = in_quotes(name) + " does not exist";
    const std::string near = nearest_file(path, suggestions);
    if (!near.empty()) error += did_you_mean((wanted.parent_path() / near).generic_string());
    return {};
  }
  if (!fs::is_regular_file(status)) {
    error = in_quotes(name) + " is not a file";
    return {};
  }
  return path;
}

ExpandedScene expand_scene(std::string_view text, const fs::path& path, Diagnostics& diagnostics,
                           const std::vector<SceneEdit>& edits) {
  ExpandedScene out;
  out.root_folder = scene_root_folder(path);
  Expander(out, diagnostics).run(text, path, edits);
  return out;
}

ExpandedScene expand_scene(std::string_view text, const fs::path& path, Diagnostics& diagnostics) {
  return expand_scene(text, path, diagnostics, {});
}

}  // namespace insula
