// SPDX-License-Identifier: GPL-3.0-or-later
// What may touch, numbered: each link of each rigid body, then each surface. Frames name both sides of a contact by
// these numbers, and a bundle says what stands behind a number (docs/scene-bundle.md).
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

class ContactSides {
 public:
  explicit ContactSides(const Simulation& simulation);
  /// Number of the side; -1: the scene has no such part.
  std::int16_t number(const Body& owner, const ContactPart& part) const;

 private:
  std::vector<const RigidBody*> rigid_;
  std::vector<int> first_;  ///< number of the first link of each
  const std::vector<Surface*>& surfaces_;
  int links_ = 0;
};

/// The sides in the order of their numbers: number, owner, kind (the owner's element), role, part, link, material.
/// role: "instrument", "implant", "deformable" or "fixed".
nlohmann::ordered_json contact_sides_json(const Simulation& simulation);

}  // namespace insula
