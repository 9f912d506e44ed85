// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/first_diagnostics.h"

#include <fmt/format.h>

#include <algorithm>

namespace insula {
namespace {

constexpr std::size_t max_shown = 100;

std::string counted(std::size_t n, const char* what) { return fmt::format("{} more {}{}", n, what, n == 1 ? "" : "s"); }

}  // namespace

Diagnostics first_diagnostics(Diagnostics all) {
  all.sort_by_position();
  if (all.all().size() <= max_shown) return all;
  const std::size_t errors = std::size_t(all.errors()), warnings = all.all().size() - errors;
  const std::size_t errors_shown = std::min(errors, max_shown),
                    warnings_shown = std::min(warnings, max_shown - errors_shown);
  Diagnostics out;
  std::size_t errors_left = errors_shown, warnings_left = warnings_shown;
  for (const Diagnostic& d : all.all()) {
    std::size_t& left = d.severity == Severity::error ? errors_left : warnings_left;
    if (left == 0) continue;
    --left;
    d.severity == Severity::error ? out.error(d.pos, d.text) : out.warning(d.pos, d.text);
  }
  std::string rest;
  if (errors > errors_shown) rest = counted(errors - errors_shown, "error");
  if (warnings > warnings_shown) rest += (rest.empty() ? "" : " and ") + counted(warnings - warnings_shown, "warning");
  const SourcePos whole_file{all.all().front().pos.file, 0, 0};
  all.ok() ? out.warning(whole_file, "and " + rest) : out.error(whole_file, "and " + rest);
  return out;
}

}  // namespace insula
