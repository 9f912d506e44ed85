// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/authoring/declarations_json.h"

#include "core/params/list.h"
#include "engine/authoring/describe.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;

Json numbers_of(const ParamBase& p) {
  if (dynamic_cast<const QuantityParam*>(&p) || dynamic_cast<const Param<int>*>(&p)) return 1;
  if (dynamic_cast<const VectorParam*>(&p)) return 3;
  if (dynamic_cast<const QuantityListParam*>(&p) || dynamic_cast<const Param<List<int>>*>(&p)) return 0;
  return nullptr;
}

Json parameter(const ParamBase& p) {
  Json out{{"name", p.name()}, {"type", p.type_name()}, {"doc", p.spec().doc}, {"required", p.required()}};
  if (!p.required() && !p.spec().fallback->empty()) out["default"] = *p.spec().fallback;
  if (!p.spec().min.empty()) out["min"] = p.spec().min;
  if (!p.spec().max.empty()) out["max"] = p.spec().max;
  if (!p.spec().choices.empty()) out["choices"] = p.spec().choices;
  if (dynamic_cast<const Param<bool>*>(&p)) out["choices"] = {"true", "false"};
  if (dynamic_cast<const Param<LengthUnit>*>(&p))
    for (const Unit& unit : Length::units()) out["choices"].push_back(unit.symbol);
  for (const Unit& unit : p.units())
    if (unit.listed) out["units"].push_back({{"symbol", unit.symbol}, {"to_si", unit.to_si}});
  if (const Json numbers = numbers_of(p); !numbers.is_null()) out["numbers"] = numbers;
  if (dynamic_cast<const Param<int>*>(&p) || dynamic_cast<const Param<List<int>>*>(&p)) out["whole"] = true;
  if (!p.ref_kind().empty()) out["reference"] = p.ref_kind();
  if (p.is_list()) out["list"] = true;
  return out;
}

Json element(const Registry& registry, const ComponentInfo& info) {
  Json children = Json::array(), parameters = Json::array();
  if (info.kind == Kind::scene) children = {"variable"};
  for (const ComponentInfo* child : children_of_kind(registry, info.kind)) children.push_back(child->element);
  if (info.kind == Kind::scene || !children.empty()) children.push_back("include");
  parameters.push_back(
      {{"name", "id"}, {"type", "text"}, {"doc", "name by which others refer to it"}, {"required", false}});
  const auto component = registry.create(info.element);
  for (const ParamBase* p : component->params()) parameters.push_back(parameter(*p));
  return {{"name", info.element},  {"kind", kind_name(info.kind)}, {"doc", info.doc},
          {"plugin", info.plugin}, {"children", children},         {"parameters", parameters}};
}

Json text_parameter(const char* name, const char* type, const char* doc, bool required) {
  return {{"name", name}, {"type", type}, {"doc", doc}, {"required", required}};
}

/// What the loader replaces (core/scene/expand.h).
void add_preprocessing(const Registry& registry, Json& elements) {
  Json anywhere{"variable", "include"};
  for (const ComponentInfo* info : registry.all())
    if (info->kind != Kind::scene) anywhere.push_back(info->element);
  elements.push_back({{"name", "part"},
                      {"doc", "a piece that scenes include"},
                      {"children", anywhere},
                      {"parameters", Json::array({text_parameter("title", "text", "what it is", false)})}});
  elements.push_back(
      {{"name", "include"},
       {"doc", "puts the children of another file's root here"},
       {"children", {"variable"}},
       {"parameters", Json::array({text_parameter("file", "file", "scene or part", true),
                                   text_parameter("prefix", "text", "is put before every id of the part", false)})}});
  elements.push_back({{"name", "variable"},
                      {"doc", "a value to be used as $name"},
                      {"children", Json::array()},
                      {"parameters", Json::array({text_parameter("name", "text", "letters, digits and _", true),
                                                  text_parameter("value", "text", "what it stands for", true)})}});
}

}  // namespace

Json declarations_json(const Registry& registry) {
  Json elements = Json::array();
  for (const ComponentInfo* info : registry.all()) elements.push_back(element(registry, *info));
  add_preprocessing(registry, elements);
  return {{"elements", elements}};
}

}  // namespace insula
