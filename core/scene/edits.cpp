// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters that are set from outside of a scene's files.
#include "core/scene/edits.h"

#include <algorithm>
#include <map>

#include "core/base/text.h"
#include "core/scene/expand.h"

namespace insula {
namespace {

/// The elements of a scene by the names under which an edit finds them.
class Names {
 public:
  explicit Names(Element& root) {
    add(root, "");
    ids_.emplace("scene", &root);
  }

  /// The element of that name. Null, with the error text, if there is none or more than one.
  Element* find(const std::string& name, std::string& error) const {
    if (const auto it = ids_.find(name); it != ids_.end()) return it->second;
    const auto children = children_.find(name);
    if (children == children_.end()) {
      error = "no component has the id " + in_quotes(name) + did_you_mean(nearest_name(name, all()));
      return nullptr;
    }
    if (children->second.size() == 1) return children->second.front();
    error = "there are " + std::to_string(children->second.size()) + " components " + in_quotes(name) +
            ": name one of them by its id";
    return nullptr;
  }

 private:
  void add(Element& e, const std::string& parent) {
    const int ordinal = ++ordinals_[e.name];
    std::string id = e.name + "#" + std::to_string(ordinal);
    if (const Attribute* own = e.find("id"); own && e.part) id = e.part->prefixes.front() + own->value;
    ids_.emplace(id, &e);
    children_[parent + "." + e.name].push_back(&e);
    for (const auto& child : e.children) add(*child, id);
  }

  std::vector<std::string> all() const {
    std::vector<std::string> out;
    for (const auto& [id, e] : ids_) out.push_back(id);
    for (const auto& [path, e] : children_)
      if (path.front() != '.') out.push_back(path);
    return out;
  }

  std::map<std::string, int> ordinals_;
  std::map<std::string, Element*> ids_;
  std::map<std::string, std::vector<Element*>> children_;  ///< by ID.ELEMENT
};

void set(Element& e, const SceneEdit& edit) {
  const Attribute given{edit.name, edit.value, edit.pos, edit.pos};
  const auto same = [&](const Attribute& a) { return a.name == edit.name; };
  const auto it = std::find_if(e.attributes.begin(), e.attributes.end(), same);
  if (it != e.attributes.end()) *it = given;
  else e.attributes.push_back(given);
}

}  // namespace

void apply_edits(ExpandedScene& tree, const std::vector<SceneEdit>& edits, Diagnostics& diagnostics) {
  if (!tree.root || edits.empty()) return;
  const Names names(*tree.root);
  for (const SceneEdit& edit : edits) {
    for (const std::string* text : {&edit.component, &edit.name, &edit.value}) tree.hash.add(*text + '\n');
    if (edit.component.empty()) continue;
    std::string error = edit.name == "id" ? "the id of a component cannot be set" : "";
    Element* e = error.empty() ? names.find(edit.component, error) : nullptr;
    if (e) set(*e, edit);
    else diagnostics.error(edit.pos, error);
  }
}

}  // namespace insula
