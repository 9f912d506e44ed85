// SPDX-License-Identifier: GPL-3.0-or-later
// Second phase of loading. The expanded tree becomes components, ids are resolved, files are found, and everything is
// prepared.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "core/scene/expand.h"
#include "core/scene/scene.h"

namespace insula {

class SceneBuilder {
 public:
  SceneBuilder(const Registry& registry, ExpandedScene& tree, Diagnostics& diagnostics)
      : registry_(registry), tree_(tree), diagnostics_(diagnostics) {}

  std::unique_ptr<Scene> build(const std::filesystem::path& file);

 private:
  void add_children(const Element& element, Component& parent);
  void add(const Element& element, Component& parent);
  bool second_of_its_kind(const Element& element, const ComponentInfo& info);
  void read_params(const Element& element, Component& component);
  void read_id(const Element& element, Component& component);
  void unknown_element(const Element& element, const Component& parent);
  void misplaced(const Element& element, const ComponentInfo& info, const Component& parent);
  void lose_ids(const Element& element);

  void resolve_references(Component& component);
  void unresolved(const RefParamBase& ref, const std::string& id);
  /// The component with this id in that part of the scene, with the prefixes of its includes.
  Component* lookup(const ScenePart& part, const std::string& id, bool& lost) const;
  void find_files(Component& component);

  /// Collects the materials and checks every reference to one.
  void join_materials();

  void prepare_all();
  void prepare(Component& component);
  void prepare_tree(Component& component);

  void report(Component& component, const SourcePos& pos, std::string text);

  const Registry& registry_;
  ExpandedScene& tree_;
  Diagnostics& diagnostics_;
  std::unique_ptr<Scene> scene_;
  std::map<const Component*, const ScenePart*> part_of_;
  std::set<const Component*> failed_, prepared_;
  std::map<std::string, int> ordinals_;
  std::map<std::string, const Component*, std::less<>> only_ones_;  ///< of elements that are allowed once in a scene
  std::set<std::string> lost_ids_;  ///< of elements that could not be built; a reference to them is not another error
  int order_ = 0;
};

}  // namespace insula
