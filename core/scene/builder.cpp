// SPDX-License-Identifier: GPL-3.0-or-later
// Converts elements to components: names, parents, parameters, ids.
#include "core/scene/builder.h"

#include <algorithm>

#include "core/scene/place_text.h"
#include "core/scene/read_params.h"

namespace insula {
namespace {

bool may_stand_in(const ComponentInfo& info, Kind parent) {
  return std::find(info.parents.begin(), info.parents.end(), parent) != info.parents.end();
}

bool may_stand_once(const ComponentInfo& info) {
  return info.kind == Kind::settings || info.kind == Kind::complications || info.kind == Kind::exercise;
}

/// A scene has one exercise, whatever its element is called, and one of each kind of settings.
std::string single_key(const ComponentInfo& info) { return info.kind == Kind::exercise ? "exercise" : info.element; }

}  // namespace

void SceneBuilder::report(Component& component, const SourcePos& pos, std::string text) {
  failed_.insert(&component);
  diagnostics_.error(pos, std::move(text));
}

std::unique_ptr<Scene> SceneBuilder::build(const std::filesystem::path& file) {
  const Element& root = *tree_.root;
  if (root.name != "scene") {
    diagnostics_.error(root.pos, root.name == "part"
                                     ? "this is a part, which scenes include; the root of a scene is <scene>"
                                     : "the root element must be <scene>, not <" + shown(root.name) + ">");
    return nullptr;
  }
  scene_ = std::make_unique<Scene>();
  for (ParamBase* p : scene_->params()) p->assign_fallback();
  scene_->element = "scene";
  scene_->kind = Kind::scene;
  scene_->pos = root.pos;
  scene_->order = order_++;
  scene_->file_ = file;
  scene_->root_folder_ = tree_.root_folder;
  part_of_[scene_.get()] = root.part;
  read_id(root, *scene_);
  read_params(root, *scene_);
  add_children(root, *scene_);
  for (Component* c : scene_->in_order_) {
    resolve_references(*c);
    find_files(*c);
  }
  scene_->content_hash_ = tree_.hash.value();
  prepare_all();
  join_materials();
  return std::move(scene_);
}

void SceneBuilder::add_children(const Element& element, Component& parent) {
  for (const auto& child : element.children) add(*child, parent);
}

void SceneBuilder::add(const Element& element, Component& parent) {
  const ComponentInfo* info = registry_.find(element.name);
  if (!info) return unknown_element(element, parent);
  if (!may_stand_in(*info, parent.kind)) return misplaced(element, *info, parent);
  if (second_of_its_kind(element, *info)) return lose_ids(element);
  auto owned = registry_.create(element.name);
  Component& component = *owned;
  component.pos = element.pos;
  component.order = order_++;
  component.parent = &parent;
  part_of_[&component] = element.part;
  if (may_stand_once(*info)) only_ones_[single_key(*info)] = &component;
  parent.children.push_back(std::move(owned));
  scene_->in_order_.push_back(&component);
  read_id(element, component);
  read_params(element, component);
  add_children(element, component);
}

bool SceneBuilder::second_of_its_kind(const Element& element, const ComponentInfo& info) {
  if (!may_stand_once(info)) return false;
  const auto first = only_ones_.find(single_key(info));
  if (first == only_ones_.end()) return false;
  const SourcePos& at = first->second->pos;
  diagnostics_.error(element.pos, "<" + element.name + "> may stand only once in a scene; the first is at " +
                                      (at.file == element.pos.file ? "" : at.file + " ") + "line " +
                                      std::to_string(at.line));
  return true;
}

void SceneBuilder::unknown_element(const Element& element, const Component& parent) {
  const auto all = registry_.all();
  if (!tree_.suggestions.afford(2 * all.size())) {
    diagnostics_.error(element.pos, "unknown element <" + shown(element.name) + ">");
    return lose_ids(element);
  }
  std::vector<std::string> here, anywhere;
  for (const auto* info : all) {
    anywhere.push_back(info->element);
    if (may_stand_in(*info, parent.kind)) here.push_back(info->element);
  }
  for (const char* name : {"include", "variable"}) here.push_back(name);
  std::string near = nearest_name(element.name, here);
  if (near.empty()) near = nearest_name(element.name, anywhere);
  std::string text = "unknown element <" + shown(element.name) + ">";
  if (!near.empty()) text += did_you_mean_element(near);
  else text += " in <" + parent.element + "> (it may hold: " + first_names(here) + ")";
  diagnostics_.error(element.pos, text);
  lose_ids(element);
}

void SceneBuilder::misplaced(const Element& element, const ComponentInfo& info, const Component& parent) {
  const auto in_brackets = [](const auto& names) { return " (" + first_names(names) + ")"; };
  const std::vector<std::string> places = place_texts(registry_, info, in_brackets);
  diagnostics_.error(element.pos,
                     "<" + element.name + "> may not stand in <" + parent.element + ">" +
                         (places.empty() ? "; it is the root of a scene" : "; it belongs " + joined(places, " or ")));
  lose_ids(element);
}

void SceneBuilder::lose_ids(const Element& element) {
  if (const Attribute* id = element.find("id")) lost_ids_.insert(element.part->prefixes.front() + id->value);
  for (const auto& child : element.children) lose_ids(*child);
}

void SceneBuilder::read_id(const Element& element, Component& component) {
  const int ordinal = ++ordinals_[component.element];
  component.id = component.element + "#" + std::to_string(ordinal);
  const Attribute* attribute = element.find("id");
  if (attribute && !is_id(attribute->value)) {
    report(component, attribute->value_pos,
           "id: " + in_quotes(attribute->value) + " may have only letters, digits and . _ -");
    lost_ids_.insert(element.part->prefixes.front() + attribute->value);
  } else if (attribute) {
    const std::string id = element.part->prefixes.front() + attribute->value;
    if (const Component* other = scene_->find(id)) {
      report(component, attribute->value_pos,
             "id " + in_quotes(id) + " is already used at " + other->pos.file + ":" + std::to_string(other->pos.line) +
                 ":" + std::to_string(other->pos.column));
    } else {
      component.id = id;
    }
  }
  scene_->by_id_.emplace(component.id, &component);
}

void SceneBuilder::read_params(const Element& element, Component& component) {
  insula::read_params(element, component, tree_.suggestions,
                      [&](const SourcePos& pos, std::string text) { report(component, pos, std::move(text)); });
  if (!element.broken_attributes.empty()) failed_.insert(&component);
}

}  // namespace insula
