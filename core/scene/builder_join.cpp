// SPDX-License-Identifier: GPL-3.0-or-later
// References and files of components, and their preparation.
#include <algorithm>
#include <exception>
#include <fstream>

#include "core/scene/builder.h"

namespace insula {

Component* SceneBuilder::lookup(const ScenePart& part, const std::string& id, bool& lost) const {
  for (const auto& prefix : part.prefixes) {
    if (Component* found = scene_->find(prefix + id)) return found;
    if (lost_ids_.contains(prefix + id)) {
      lost = true;
      return nullptr;
    }
  }
  return nullptr;
}

void SceneBuilder::resolve_references(Component& component) {
  for (ParamBase* p : component.params()) {
    auto* ref = dynamic_cast<RefParamBase*>(p);
    if (!ref) continue;
    std::set<const Component*> listed;
    for (std::size_t i = 0; i < ref->ids().size(); ++i) {
      const std::string& id = ref->ids()[i];
      bool lost = false;
      Component* target = lookup(*part_of_.at(&component), id, lost);
      if (lost) {
        failed_.insert(&component);
      } else if (!target) {
        failed_.insert(&component);
        unresolved(*ref, id);
      } else if (!listed.insert(target).second) {
        report(component, ref->pos(), ref->name() + ": " + in_quotes(id) + " is listed twice");
      } else if (const std::string error = ref->resolve(i, target); !error.empty()) {
        report(component, ref->pos(),
               ref->name() + ": " + in_quotes(id) + " is " + with_article(target->element) + ", not " +
                   with_article(ref->ref_kind()));
      }
    }
  }
}

void SceneBuilder::unresolved(const RefParamBase& ref, const std::string& id) {
  const std::string missing = ref.name() + ": no component has the id " + in_quotes(id);
  if (!tree_.suggestions.afford(2 * scene_->in_order_.size())) return diagnostics_.error(ref.pos(), missing);
  std::vector<std::string> fitting, all;
  for (const Component* c : scene_->in_order_) {
    if (c->id.find('#') != std::string::npos) continue;  // a generated id is no help
    all.push_back(c->id);
    if (kind_name(c->kind) == ref.ref_kind() || c->element == ref.ref_kind()) fitting.push_back(c->id);
  }
  std::string near = nearest_name(id, fitting);
  if (near.empty()) near = nearest_name(id, all);
  std::string text = missing;
  if (!near.empty()) text += did_you_mean(near);
  else if (!fitting.empty() && fitting.size() <= 12) text += " (there are: " + joined(fitting) + ")";
  diagnostics_.error(ref.pos(), text);
}

void SceneBuilder::find_files(Component& component) {
  for (ParamBase* p : component.params()) {
    auto* file = dynamic_cast<Param<File>*>(p);
    if (!file || file->empty()) continue;
    std::string error;
    const auto path = resolve_file(part_of_.at(&component)->path.parent_path(), tree_.root_folder, (*file)().string(),
                                   error, tree_.suggestions);
    if (path.empty()) {
      report(component, file->given() ? file->pos() : component.pos, file->name() + ": " + error);
      continue;
    }
    file->set(path);
    std::ifstream in(path, std::ios::binary);
    std::vector<char> piece(1u << 16);
    while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0)
      tree_.hash.add({piece.data(), static_cast<std::size_t>(in.gcount())});
  }
}

void SceneBuilder::prepare_all() {
  prepare(*scene_);
  // Bodies come first, since other components may use their meshes.
  for (Component* c : scene_->in_order_)
    if (c->kind == Kind::body) prepare_tree(*c);
  for (Component* c : scene_->in_order_)
    if (!prepared_.contains(c)) prepare(*c);
}

void SceneBuilder::prepare_tree(Component& component) {
  if (!prepared_.contains(&component)) prepare(component);
  for (const auto& child : component.children) prepare_tree(*child);
}

void SceneBuilder::prepare(Component& component) {
  prepared_.insert(&component);
  // Components that depend on a broken one would only report consequences.
  if (component.parent && component.parent != scene_.get() && failed_.contains(component.parent))
    failed_.insert(&component);
  for (ParamBase* p : component.params()) {
    auto* ref = dynamic_cast<RefParamBase*>(p);
    if (!ref || failed_.contains(&component)) continue;
    for (const auto& id : ref->ids()) {
      bool lost = false;
      const Component* target = lookup(*part_of_.at(&component), id, lost);
      if (target && failed_.contains(target)) failed_.insert(&component);
    }
  }
  if (failed_.contains(&component)) return;
  const int errors_before = diagnostics_.errors();
  PrepareContext context{diagnostics_, scene_->time_step()};
  try {
    component.prepare(context);
  } catch (const std::exception& e) {
    diagnostics_.error(component.pos, "<" + component.element + ">: " + e.what());
  } catch (...) {
    diagnostics_.error(component.pos, "<" + component.element + ">: unknown failure");
  }
  if (diagnostics_.errors() > errors_before) failed_.insert(&component);
}

}  // namespace insula
