// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/limit_param.h"

#include "core/base/text.h"
#include "core/params/number.h"

namespace insula {

std::string Param<MetricLimit>::parse(std::string_view text) {
  if (text.empty()) return "the value is empty";
  return number_length(text) > 0 ? "" : in_quotes(text) + " is not a number";
}

}  // namespace insula
