// SPDX-License-Identifier: GPL-3.0-or-later
// A limit of a metric: "900 mm", "0.2 N", "12". Which units it may have depends on the metric, and is checked when the
// metric is known.
#pragma once
#include "core/params/param.h"

namespace insula {

struct MetricLimit {};
template <>
class Param<MetricLimit> : public ParamBase {
 public:
  using ParamBase::ParamBase;
  std::string type_name() const override { return "value in a unit of the metric"; }

 protected:
  /// The text stays as it is: text().
  std::string parse(std::string_view text) override;
};

}  // namespace insula
