// SPDX-License-Identifier: GPL-3.0-or-later
// A body that never moves: bone, the floor of the fissure. It has surfaces and no degrees of freedom.
#pragma once
#include "core/mechanics/body.h"

namespace insula {

class Obstacle final : public Body {
 public:
  Obstacle() : Body(0) {}
  void prepare(PrepareContext& context) override;
  Vec3 position(const MaterialPoint& p) const override { return p.local; }
  Vec3 expected_displacement(const MaterialPoint&) const override { return Vec3::Zero(); }
  void add_row(BodyRows&, const MaterialPoint&, const Vec3&) const override {}
};

}  // namespace insula
