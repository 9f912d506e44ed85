// SPDX-License-Identifier: GPL-3.0-or-later
// The kind of an element determines its contracts.
#include <gtest/gtest.h>

#include "core/testing/contracts.h"
#include "core/testing/example.h"

namespace insula::test {

void check_element(const std::filesystem::path& scene, const std::string& element) {
  const ComponentInfo* info = builtin().find(element);
  ASSERT_TRUE(info) << "there is no element <" << element << ">";
  switch (info->kind) {
    case Kind::force_model: return check_force_model(scene, element);
    case Kind::body: return check_rigid_body(scene, element);
    case Kind::support: return check_support(scene, element);
    case Kind::condition: return check_condition(scene, element);
    case Kind::constraint: return check_rows(scene, element, true);
    case Kind::metric: return check_metric(scene, element);
    case Kind::instrument: check_instrument(scene, element); return check_rows(scene, element, false);
    case Kind::exercise_rule: return check_exercise_rule(scene, element);
    default: FAIL() << "no contract for a " << kind_name(info->kind) << "; write one in core/testing";
  }
}

}  // namespace insula::test
