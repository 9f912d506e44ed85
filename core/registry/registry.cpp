// SPDX-License-Identifier: GPL-3.0-or-later
// The list of elements and the check of their declarations.
#include "core/registry/registry.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/text.h"
#include "core/registry/abi.h"

namespace insula {
namespace {

std::vector<Kind> usual_parents(Kind kind) {
  switch (kind) {
    case Kind::scene: return {};
    case Kind::settings:
    case Kind::body:
    case Kind::constraint:
    case Kind::instrument:
    case Kind::exercise:
    case Kind::material:
    case Kind::complications: return {Kind::scene};
    case Kind::surface:
    case Kind::force_model:
    case Kind::support: return {Kind::body};
    case Kind::exercise_rule:
    case Kind::metric:
    case Kind::motion: return {Kind::exercise};
    case Kind::complication: return {Kind::complications};
    case Kind::condition: return {Kind::support};
  }
  return {};
}

bool is_xml_name(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (name.empty() || !letter(name.front())) return false;
  return std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

}  // namespace

void Registry::add_info(ComponentInfo info) {
  if (!is_xml_name(info.element)) throw std::logic_error("\"" + info.element + "\" cannot be an element name");
  for (const char* taken : {"include", "variable", "part"})
    if (info.element == taken) throw std::logic_error("<" + info.element + "> is an element of the scene language");
  if (const auto* other = find(info.element))
    throw std::logic_error("<" + info.element + "> of plugin " + info.plugin + " is already registered by " +
                           other->plugin);
  if (info.parents.empty()) info.parents = usual_parents(info.kind);
  // A wrong declaration is an error of the programmer. It is found here instead of when an author first uses the
  // element.
  try {
    const auto probe = info.create();
    for (ParamBase* p : probe->params()) {
      if (!is_xml_name(p->spec().name)) throw std::logic_error("\"" + p->name() + "\" cannot be a parameter name");
      p->assign_fallback();
    }
  } catch (const std::exception& e) {
    throw std::logic_error("<" + info.element + ">: " + e.what());
  }
  const std::string element = info.element;
  infos_.emplace(element, std::move(info));
}

void Registry::add_material(Material material) {
  for (const Material& other : materials_)
    if (other.name == material.name)
      throw std::logic_error("the material \"" + material.name + "\" is already registered");
  materials_.push_back(std::move(material));
}

const ComponentInfo* Registry::find(std::string_view element) const {
  const auto it = infos_.find(element);
  return it == infos_.end() ? nullptr : &it->second;
}

std::vector<const ComponentInfo*> Registry::all() const {
  std::vector<const ComponentInfo*> out;
  for (const auto& [name, info] : infos_) out.push_back(&info);
  std::stable_sort(out.begin(), out.end(), [](const auto* a, const auto* b) { return a->kind < b->kind; });
  return out;
}

std::unique_ptr<Component> Registry::create(std::string_view element) const {
  const auto* info = find(element);
  if (!info) return nullptr;
  auto component = info->create();
  component->element = info->element;
  component->kind = info->kind;
  for (ParamBase* p : component->params()) p->assign_fallback();
  return component;
}

const char* abi_string() { return INSULA_ABI_STRING; }

}  // namespace insula
