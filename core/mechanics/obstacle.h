// SPDX-License-Identifier: GPL-3.0-or-later
// A body that never moves: bone, the floor of the fissure. It has surfaces and no degrees of freedom.
#pragma once
#include "core/mechanics/body.h"

namespace insula {

class Obstacle final : public Body {
 public:
  void prepare(PrepareContext& context) override;
  int blocks() const override { return 0; }
  Vec3 position(const MaterialPoint& p) const override { return p.local; }
  Vec3 expected_displacement(const MaterialPoint&) const override { return Vec3::Zero(); }
  void add_row(BodyRows&, const MaterialPoint&, const Vec3&) const override {}
  void free_motion(const StepContext&) override {}
  void add_compliance(const BodyRows&, double*, int) override {}
  void add_free_motion(const BodyRows&, double*) const override {}
  void apply(const StepContext&, const BodyRows&, const double*) override {}
  void reset() override {}
  double energy() const override { return 0; }
  void append_state(std::vector<double>&) const override {}
};

}  // namespace insula
