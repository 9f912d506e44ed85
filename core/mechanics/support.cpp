// SPDX-License-Identifier: GPL-3.0-or-later
// Which nodes a support holds: those that it selects and that satisfy its conditions.
#include <fmt/format.h>

#include <algorithm>

#include "core/mechanics/force_model.h"

namespace insula {

void Support::hold(PrepareContext& context, const std::vector<Vec3>& rest, std::vector<char>& fixed) {
  const auto conditions = children_of<Condition>();
  if (conditions.empty()) return fix(context, rest, fixed);
  std::vector<char> chosen(rest.size(), 0);
  const int errors_before = context.diagnostics.errors();
  const auto count = [&] { return std::count(chosen.begin(), chosen.end(), 1); };
  fix(context, rest, chosen);
  const auto own = count();
  for (Condition* c : conditions) c->restrict(context, rest, chosen);
  if (own > 0 && count() == 0 && context.diagnostics.errors() == errors_before)
    error(context, fmt::format("holds no node: it selects {}, and none of them satisfies all of its conditions", own));
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (chosen[i]) fixed[i] = 1;
}

}  // namespace insula
