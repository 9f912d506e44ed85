// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/authoring/param_table.h"

#include <fmt/format.h>

#include "engine/authoring/describe.h"

namespace insula {

std::string cell(std::string_view text) {
  std::string out;
  for (char c : text) {
    if (c == '|') out += '\\';
    if (c == '<') out += "&lt;";
    else out += c;
  }
  return out.empty() ? "-" : out;
}

std::string param_table(const ParamSet& params) {
  std::string out =
      "| parameter | type | default | allowed | what it is |\n|---|---|---|---|---|\n| `id` | text | - | letters, "
      "digits, . _ - | name by which others refer to it |\n";
  for (const ParamBase* p : params.params()) {
    std::string type = p->type_name();
    if (const auto units = units_text(*p); !units.empty()) type += " in " + units;
    const std::string_view given = p->spec().fallback.value_or("");
    const std::string fallback = p->required() ? "**required**" : given.empty() ? "-" : fmt::format("`{}`", given);
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", p->name(), cell(type), fallback, cell(allowed_text(*p)),
                       cell(p->spec().doc));
  }
  return out;
}

}  // namespace insula
