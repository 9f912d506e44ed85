// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/rules.h"

#include <algorithm>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "core/scene/expand.h"
#include "core/xml/document.h"
#include "engine/reports/svg_plot.h"
#include "tools/case_builder/assignment.h"
#include "tools/case_builder/declarations.h"

namespace insula::case_builder {
namespace {

[[noreturn]] void refuse(const RuleChange& c, const std::string& why) {
  throw InputError("--rule " + c.text() + ": " + why);
}

/// Where an element with that id stands in a text that has no '>' in its values: '<' to one past '>'.
struct Tag {
  std::size_t begin = std::string::npos, end = 0;
};
Tag tag_of(const std::string& text, const std::string& id) {
  const std::size_t at = text.find(" id=\"" + id + "\"");
  if (at == std::string::npos) return {};
  return {text.rfind('<', at), text.find('>', at) + 1};
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

/// The children of a part's root, with its own variables in place.
std::string inside_of(const fs::path& part) {
  std::string text = read_file_bytes(part);
  Diagnostics none;
  const Document document = parse_document(text, part.string(), none);
  if (!document.root) return {};
  for (const auto& child : document.root->children)
    if (child->name == "variable") replace_all(text, "$" + child->find("name")->value, child->find("value")->value);
  const std::size_t begin = text.find("<part>") + 6, end = text.rfind("</part>");
  if (begin > end || end == std::string::npos) return {};
  text = text.substr(begin, end - begin);
  for (std::size_t at; (at = text.find("  <variable ")) != std::string::npos;)
    text.erase(at, text.find("/>", at) + 3 - at);
  return text.substr(text.find_first_not_of('\n'));
}

/// Writes the part out that holds the rule, if there is one.
bool write_out_part(std::string& text, const std::string& id, const fs::path& folder) {
  constexpr std::string_view opens = "<include file=\"", closes = "\"/>\n";
  for (std::size_t at = 0; (at = text.find(opens, at)) != std::string::npos; ++at) {
    const std::size_t name = at + opens.size(), end = text.find('"', name);
    if (text.compare(end, closes.size(), closes) != 0) continue;
    const fs::path part = folder / text.substr(name, end - name);
    std::error_code error;
    if (!fs::is_regular_file(part, error) || tag_of(read_file_bytes(part), id).begin == std::string::npos) continue;
    const std::size_t line = text.rfind('\n', at) + 1;
    text.replace(line, end + closes.size() - line, inside_of(part));
    return true;
  }
  return false;
}

bool is_rule(const ComponentInfo& info) { return info.kind == Kind::exercise_rule || info.kind == Kind::complication; }

/// Fibres, and the membranes between them.
bool is_of_strands(const ComponentInfo& info) {
  return info.element == "strand_springs" || info.element == "arachnoid_membrane";
}

/// Throws unless the element declares the parameter and allows the value.
void check(const RuleChange& c, const std::string& element) {
  const ComponentInfo* info = builtin_registry().find(element);
  if (!info || (!is_rule(*info) && !is_of_strands(*info)))
    refuse(c, "<" + element + "> is no goal, fault, clock or complication, and no strands");
  if (c.off) return;
  const auto rule = info->create();
  ParamBase* parameter = rule->find_param(c.parameter);
  if (!parameter || c.parameter == "id") {
    std::string all;
    for (const ParamBase* p : rule->params())
      if (p->name() != "id") all += (all.empty() ? "" : ", ") + p->name();
    refuse(c, "<" + element + "> has no parameter \"" + c.parameter + "\"; it has " + all);
  }
  if (const std::string why = parameter->assign(c.value, {}); !why.empty()) refuse(c, why);
}

void erase(std::string& text, const Tag& tag) {
  const std::size_t line = text.rfind('\n', tag.begin) + 1;
  text.erase(line, tag.end + 1 - line);
}

/// With the membranes between strands. What else names it cannot do without.
void leave_out(std::string& text, const RuleChange& c, const Tag& tag) {
  erase(text, tag);
  for (std::size_t at; (at = text.find(" strands=\"" + c.rule + "\"")) != std::string::npos;)
    erase(text, {text.rfind('<', at), text.find('>', at) + 1});
  if (text.find("\"" + c.rule + ".") != std::string::npos) refuse(c, "another part of the exercise needs it");
}

void change(std::string& text, const RuleChange& c, const fs::path& folder) {
  Tag tag = tag_of(text, c.rule);
  if (tag.begin == std::string::npos && write_out_part(text, c.rule, folder)) tag = tag_of(text, c.rule);
  if (tag.begin == std::string::npos) refuse(c, "the exercise has no rule of that id");
  check(c, text.substr(tag.begin + 1, text.find_first_of(" \n", tag.begin) - tag.begin - 1));
  if (c.off) return leave_out(text, c, tag);
  const std::string value = escaped(c.value), name = " " + c.parameter + "=\"";
  const std::size_t at = text.find(name, tag.begin);
  if (at < tag.end) {
    const std::size_t begin = at + name.size();
    text.replace(begin, text.find('"', begin) - begin, value);
  } else {
    text.insert(tag.end - 2, name + value + "\"");
  }
}

using Wanted = bool (*)(const ComponentInfo&);

void gather(const Element& parent, Wanted wanted, Json& out) {
  for (const auto& e : parent.children) {
    gather(*e, wanted, out);
    const Attribute* id = e->find("id");
    const ComponentInfo* info = builtin_registry().find(e->name);
    if (!id || !info || !wanted(*info)) continue;
    Json values = Json::object();
    for (const Attribute& a : e->attributes)
      if (a.name != "id") values[a.name] = a.value;
    const Attribute* text = e->find("text");
    out.push_back({{"id", id->value}, {"element", e->name}, {"text", text ? text->value : ""}, {"values", values}});
  }
}

}  // namespace

std::string RuleChange::text() const {
  const std::string at = std::to_string(exercise) + "." + rule;
  return off ? at + "=off" : at + "." + parameter + "=" + value;
}

RuleChange read_rule_change(const std::string& text) {
  RuleChange out;
  const auto name = [](const std::string& s) {
    return !s.empty() && std::all_of(s.begin(), s.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
  };
  const auto given = read_assignment(text);
  const std::string at = given ? given->name : "";
  const std::size_t first = at.find('.'), last = at.rfind('.');
  if (first == 1 && at[0] >= '1' && at[0] <= '4' && at.size() < 200) {
    out.exercise = at[0] - '0', out.value = given->value;
    out.off = last == first && out.value == "off";
    out.rule = last == first ? at.substr(2) : at.substr(2, last - 2);
    if (last != first) out.parameter = at.substr(last + 1);
    if (name(out.rule) && (out.off || name(out.parameter))) return out;
  }
  throw InputError("\"" + text +
                   "\" is no change of a rule; write EXERCISE.ID.PARAMETER=VALUE, such as 3.clip.max_grade=1, or "
                   "EXERCISE.ID=off");
}

std::vector<RuleChange> rule_changes(const Options& options) {
  std::vector<RuleChange> out;
  for (const std::string& text : options.rules) out.push_back(read_rule_change(text));
  return out;
}

std::string with_rules(std::string exercise, int number, const std::vector<RuleChange>& changes,
                       const fs::path& folder) {
  // A rule that is left out may have other changes, which are kept for the day it comes back.
  for (const bool off : {false, true})
    for (const RuleChange& c : changes)
      if (c.exercise == number && c.off == off) change(exercise, c, folder);
  return exercise;
}

namespace {
Json listed(const std::string& exercise, const fs::path& file, Wanted wanted) {
  Diagnostics none;
  const ExpandedScene scene = expand_scene(exercise, file, none);
  Json out = Json::array();
  if (scene.root) gather(*scene.root, wanted, out);
  return out;
}
}  // namespace

Json rules_of(const std::string& exercise, const fs::path& file) { return listed(exercise, file, is_rule); }

Json strands_of(const std::string& exercise, const fs::path& file) { return listed(exercise, file, is_of_strands); }

}  // namespace insula::case_builder
