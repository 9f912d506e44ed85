// SPDX-License-Identifier: GPL-3.0-or-later
// Variables of scene files.
#include "core/scene/variables.h"

#include <algorithm>

#include "core/base/text.h"

namespace insula {
namespace {
constexpr int max_depth = 32;
constexpr std::size_t max_variables = 1000;
constexpr std::size_t max_value_bytes = 64u << 10;

bool is_name_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
}  // namespace

bool Variables::is_name(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), is_name_char) &&
         !(text.front() >= '0' && text.front() <= '9');
}

Variables::Scope& Variables::new_scope(const Scope* outer) {
  return outer ? scopes_.emplace_back(*outer) : scopes_.emplace_back();
}

void Variables::define(Scope& scope, Scope& local, const std::string& name, const std::string& value,
                       const SourcePos& pos, const SourcePos& value_pos, bool replace) {
  if (!is_name(name))
    return diagnostics_.error(pos, in_quotes(name) + " cannot be the name of a variable (use letters, digits and _)");
  if (const auto it = local.find(name); it != local.end())
    return diagnostics_.error(
        pos, "variable " + in_quotes(name) + " is already defined at line " + std::to_string(it->second->pos.line));
  if (definitions_.size() >= max_variables)
    return diagnostics_.error(pos, "more than " + std::to_string(max_variables) + " variables");
  Definition& d = definitions_.emplace_back();
  d.name = name;
  d.value = value;
  d.pos = pos;
  d.value_pos = value_pos;
  d.scope = &scope;
  local[name] = &d;
  if (replace || !scope.contains(name)) scope[name] = &d;
  else d.used = true;  // a default that the including file replaces
}

bool Variables::expand(Definition& d, const SourcePos& pos) {
  d.used = true;
  if (d.state == Definition::State::done) return true;
  if (d.state == Definition::State::expanding) {
    diagnostics_.error(d.value_pos, "variable " + in_quotes(d.name) + " refers to itself");
    return false;
  }
  if (depth_ >= max_depth) {
    diagnostics_.error(pos, "variables refer to each other more than " + std::to_string(max_depth) + " deep");
    return false;
  }
  d.state = Definition::State::expanding;
  ++depth_;
  const bool ok = replace(d.value, *d.scope, d.value_pos);
  --depth_;
  d.state = Definition::State::done;  // a failure is reported once; the text then stays as it is
  return ok;
}

bool Variables::replace(std::string& text, const Scope& scope, const SourcePos& pos) {
  if (text.find('$') == std::string::npos) return true;
  std::string out;
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t dollar = text.find('$', i);
    out.append(text, i, dollar == std::string::npos ? std::string::npos : dollar - i);
    if (dollar == std::string::npos) break;
    i = dollar + 1;
    if (i < text.size() && text[i] == '$') {
      out += '$';
      ++i;
      continue;
    }
    const bool braces = i < text.size() && text[i] == '{';
    if (braces) ++i;
    const std::size_t begin = i;
    while (i < text.size() && is_name_char(text[i])) ++i;
    const std::string name = text.substr(begin, i - begin);
    if (braces && (i >= text.size() || text[i] != '}')) {
      diagnostics_.error(pos, "\"${\" is not closed by \"}\"");
      return false;
    }
    if (braces) ++i;
    if (name.empty()) {
      diagnostics_.error(pos, "\"$\" needs the name of a variable; write \"$$\" for a dollar sign");
      return false;
    }
    const auto it = scope.find(name);
    if (it == scope.end()) {
      std::vector<std::string> names;
      if (suggestions_.afford(scope.size()))
        for (const auto& [known, unused] : scope) names.push_back(known);
      const std::string near = nearest_name(name, names);
      diagnostics_.error(pos,
                         "unknown variable " + in_quotes("$" + name) + did_you_mean(near.empty() ? near : "$" + near));
      return false;
    }
    if (!expand(*it->second, pos)) return false;
    out += it->second->value;
    if (out.size() > max_value_bytes || it->second->value.size() > budget_) {
      diagnostics_.error(pos, "the value is too long after its variables are replaced");
      return false;
    }
    budget_ -= it->second->value.size();
  }
  text = std::move(out);
  return true;
}

void Variables::refuse_unused(const Scope& given) {
  for (const auto& [name, d] : given) {
    if (d->used) continue;
    d->used = true;
    std::vector<std::string> names;
    for (const Definition& other : definitions_)
      if (!given.contains(other.name)) names.push_back(other.name);
    diagnostics_.error(d->pos,
                       "the scene uses no variable " + in_quotes(name) + did_you_mean(nearest_name(name, names)));
  }
}

void Variables::warn_unused() {
  for (const auto& d : definitions_)
    if (!d.used) diagnostics_.warning(d.pos, "variable " + in_quotes(d.name) + " is not used");
}

}  // namespace insula
