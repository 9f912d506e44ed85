// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/reader.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/scene/read_params.h"

namespace insula {
namespace {

std::string in_brackets(const std::string& element) { return "<" + element + ">"; }

std::string listed(const std::vector<std::string>& elements) {
  std::vector<std::string> out;
  for (const std::string& e : elements) out.push_back(in_brackets(e));
  return joined(out, " or ");
}

}  // namespace

void CurriculumReader::report(const CurriculumElement& element, const SourcePos& pos, std::string text) {
  failed_.insert(&element);
  diagnostics_.error(pos, std::move(text));
}

std::unique_ptr<CurriculumRoot> CurriculumReader::read() {
  const Element& from = *tree_.root;
  const CurriculumElementInfo& info = curriculum_elements().front();
  if (from.name != info.name) {
    diagnostics_.error(from.pos, "the root of a curriculum is <curriculum>, not " + in_brackets(shown(from.name)));
    return nullptr;
  }
  auto root = std::make_unique<CurriculumRoot>();
  for (ParamBase* p : root->params()) p->assign_fallback();
  fill(from, info, *root);
  resolve_all(*root);
  return root;
}

void CurriculumReader::fill(const Element& from, const CurriculumElementInfo& info, CurriculumElement& into) {
  into.element = from.name;
  into.pos = from.pos;
  into.part = from.part;
  read_id(from, info, into);
  read_params(from, into, tree_.suggestions,
              [&](const SourcePos& pos, std::string text) { report(into, pos, std::move(text)); });
  if (!from.broken_attributes.empty()) failed_.insert(&into);
  for (const auto& child : from.children) add_child(*child, into);
}

void CurriculumReader::read_id(const Element& from, const CurriculumElementInfo& info, CurriculumElement& into) {
  const Attribute* attribute = from.find("id");
  if (!attribute) {
    if (info.needs_id) report(into, from.pos, in_brackets(from.name) + " needs an id, by which others name it");
    return;
  }
  const std::string id = from.part->prefixes.front() + attribute->value;
  if (!is_id(attribute->value)) {
    report(into, attribute->value_pos,
           "id: " + in_quotes(attribute->value) + " may have only letters, digits and . _ -");
    lost_ids_.insert(id);
  } else if (const auto other = by_id_.find(id); other != by_id_.end()) {
    const SourcePos& at = other->second->pos;
    report(into, attribute->value_pos,
           "id " + in_quotes(id) + " is already used at " + at.file + ":" + std::to_string(at.line) + ":" +
               std::to_string(at.column));
  } else {
    into.id = id;
    by_id_.emplace(id, &into);
  }
}

void CurriculumReader::add_child(const Element& from, CurriculumElement& parent) {
  const CurriculumElementInfo* info = find_curriculum_element(from.name);
  if (!info) return unknown(from, parent);
  if (std::find(info->parents.begin(), info->parents.end(), parent.element) == info->parents.end()) {
    report(
        parent, from.pos,
        in_brackets(from.name) + " may not stand in " + in_brackets(parent.element) +
            (info->parents.empty() ? "; it is the root of a curriculum" : "; it belongs in " + listed(info->parents)));
    return lose_ids(from);
  }
  const auto same = [&](const auto& c) { return c->element == from.name; };
  if (const auto first = std::find_if(parent.children.begin(), parent.children.end(), same);
      info->once && first != parent.children.end()) {
    report(parent, from.pos,
           in_brackets(from.name) + " may stand only once in " + in_brackets(parent.element) +
               "; the first is at line " + std::to_string((*first)->pos.line));
    return lose_ids(from);
  }
  parent.children.push_back(info->create());
  fill(from, *info, *parent.children.back());
}

void CurriculumReader::unknown(const Element& from, const CurriculumElement& parent) {
  lose_ids(from);
  std::string text = "unknown element " + in_brackets(shown(from.name));
  std::vector<std::string> here = children_of_curriculum_element(parent.element), anywhere;
  for (const char* name : {"include", "variable"}) here.push_back(name);
  for (const auto& info : curriculum_elements()) anywhere.push_back(info.name);
  if (tree_.suggestions.afford(here.size() + anywhere.size())) {
    std::string near = nearest_name(from.name, here);
    if (near.empty()) near = nearest_name(from.name, anywhere);
    if (!near.empty()) text += "; did you mean " + in_brackets(near) + "?";
    else text += " in " + in_brackets(parent.element) + " (it may hold: " + first_names(here) + ")";
  }
  report(parent, from.pos, text);
}

void CurriculumReader::lose_ids(const Element& from) {
  if (const Attribute* id = from.find("id")) lost_ids_.insert(from.part->prefixes.front() + id->value);
  for (const auto& child : from.children) lose_ids(*child);
}

void CurriculumReader::resolve_all(CurriculumElement& element) {
  for (ParamBase* p : element.params()) {
    if (auto* reference = dynamic_cast<RefParamBase*>(p)) resolve(element, *reference);
    if (auto* file = dynamic_cast<Param<File>*>(p); file && !file->empty()) find_file(element, *file);
  }
  for (const auto& child : element.children) resolve_all(*child);
}

void CurriculumReader::resolve(CurriculumElement& element, RefParamBase& reference) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < reference.ids().size(); ++i) {
    const std::string& id = reference.ids()[i];
    CurriculumElement* target = nullptr;
    bool lost = false;
    for (const std::string& prefix : element.part->prefixes) {
      const auto found = by_id_.find(prefix + id);
      if (found != by_id_.end() && !target) target = found->second;
      lost = lost || lost_ids_.contains(prefix + id);
    }
    if (!target && lost) failed_.insert(&element);
    else if (!target) report(element, reference.pos(), missing(reference, id));
    else if (!seen.insert(id).second)
      report(element, reference.pos(), reference.name() + ": " + in_quotes(id) + " is listed twice");
    else if (!reference.resolve(i, target).empty())
      report(element, reference.pos(),
             reference.name() + ": " + in_quotes(id) + " is " + with_article(target->element) + ", not " +
                 with_article(reference.ref_kind()));
  }
}

std::string CurriculumReader::missing(const RefParamBase& reference, const std::string& id) {
  const std::string kind(reference.ref_kind());
  std::string text = reference.name() + ": no " + kind + " has the id " + in_quotes(id);
  if (!tree_.suggestions.afford(by_id_.size())) return text;
  std::vector<std::string> fitting;
  for (const auto& [name, element] : by_id_)
    if (element->element == kind) fitting.push_back(name);
  if (const std::string near = nearest_name(id, fitting); !near.empty()) return text + did_you_mean(near);
  return fitting.empty() ? text : text + " (there are: " + first_names(fitting) + ")";
}

void CurriculumReader::find_file(CurriculumElement& element, Param<File>& file) {
  const std::filesystem::path own = element.part->path.parent_path();
  const std::string name = file().string();
  std::string error, shipped_error;
  auto path = resolve_file(own, tree_.root_folder, name, error, tree_.suggestions);
  if (path.empty() && !shipped_.empty()) {
    path =
        resolve_file(shipped_, scene_root_folder(shipped_ / "curriculum.xml"), name, shipped_error, tree_.suggestions);
    // The better message is that of the place which the author meant.
    const auto inside = (own / name).lexically_normal().lexically_relative(tree_.root_folder);
    if (inside.empty() || *inside.begin() == "..") error = shipped_error;
  }
  if (path.empty()) report(element, file.pos(), file.name() + ": " + error);
  file.set(path);
}

}  // namespace insula
