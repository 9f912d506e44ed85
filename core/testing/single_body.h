// SPDX-License-Identifier: GPL-3.0-or-later
// One deformable body outside of a scene, prepared and stepped by itself: for closed forms of statics and time
// integration.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "core/mechanics/deformable_body.h"
#include "core/params/param.h"

namespace insula::test {

/// Holds the nodes whose rest position satisfies `where`.
class HoldWhere final : public Support {
 public:
  std::function<bool(const Vec3&)> where;
  void fix(PrepareContext&, const std::vector<Vec3>& rest, std::vector<char>& fixed) override {
    for (std::size_t i = 0; i < rest.size(); ++i) fixed[i] = fixed[i] || where(rest[i]);
  }
};

/// Sets a parameter with a unit, SI.
inline void set_quantity(Component& component, const char* name, double value) {
  dynamic_cast<QuantityParam&>(*component.find_param(name)).set(value);
}

/// Prepares and connects a body that has its mesh and force models. Nodes for which `fixed` is true do not move.
/// Returns the reported messages; empty when all is well.
inline std::string finish(DeformableBody& body, std::function<bool(const Vec3&)> fixed = nullptr) {
  if (fixed) {
    auto support = std::make_unique<HoldWhere>();
    support->where = std::move(fixed);
    support->parent = &body;
    body.children.push_back(std::move(support));
  }
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, 0.01};
  body.prepare(context);
  if (diagnostics.ok()) body.connect(context);
  return diagnostics.format();
}

/// A step without rows.
inline void step(DeformableBody& body, double h, const Vec3& gravity = Vec3::Zero()) {
  StepContext context;
  context.h = h;
  context.gravity = gravity;
  body.rows.clear();
  body.free_motion(context);
  body.apply(context, body.rows, nullptr);
}

/// Newton steps of the static problem: implicit Euler with a step so long that inertia vanishes. A load that follows
/// the body may be updated before each step.
inline void settle(DeformableBody& body, int steps, const std::function<void()>& load = nullptr) {
  for (int i = 0; i < steps; ++i) {
    if (load) load();
    body.v().setZero();
    step(body, 1e6);
  }
}

}  // namespace insula::test
