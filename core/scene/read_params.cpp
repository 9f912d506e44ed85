// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes become the values of parameters.
#include "core/scene/read_params.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/params/param.h"

namespace insula {

bool is_id(std::string_view text) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.' || (static_cast<unsigned char>(c) & 0x80);  // letters of other languages
  };
  return !text.empty() && text.size() <= 128 && std::all_of(text.begin(), text.end(), good);
}

std::string first_names(const std::vector<std::string>& names) {
  constexpr std::size_t most = 12;
  if (names.size() <= most) return joined(names);
  return joined({names.begin(), names.begin() + most}) + ", ...";
}

void read_params(const Element& element, ParamSet& set, Suggestions& suggestions, const ReportAt& report) {
  std::vector<std::string> names, suggested = element.broken_attributes;
  for (const ParamBase* p : set.params()) names.push_back(p->name());
  for (const auto& a : element.attributes) {
    if (a.name == "id") continue;
    ParamBase* p = set.find_param(a.name);
    if (const ParamBase* renamed = p ? nullptr : set.find_renamed_param(a.name)) {
      report(a.name_pos, in_quotes(a.name) + " is now called " + in_quotes(renamed->name()));
      suggested.push_back(renamed->name());
      continue;
    }
    if (!p) {
      const std::string near = suggestions.afford(names.size()) ? nearest_name(a.name, names) : "";
      std::string text = "<" + element.name + "> has no parameter " + in_quotes(a.name);
      if (!near.empty()) text += did_you_mean(near);
      else if (names.empty()) text += "; it has none";
      else text += " (it has: " + first_names(names) + ")";
      report(a.name_pos, text);
      suggested.push_back(near);
      continue;
    }
    if (const std::string error = p->assign(a.value, a.value_pos); !error.empty())
      report(a.value_pos, p->name() + ": " + error);
  }
  for (const ParamBase* p : set.params()) {
    if (!p->required() || p->given()) continue;
    // A mistyped name has already been reported. A message that the right one is missing would repeat it.
    if (std::find(suggested.begin(), suggested.end(), p->name()) != suggested.end()) continue;
    report(element.pos, "<" + element.name + "> needs parameter \"" + p->name() + "\" (" + p->type_name() + ": " +
                            std::string(p->spec().doc) + ")");
  }
}

}  // namespace insula
