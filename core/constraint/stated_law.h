// SPDX-License-Identifier: GPL-3.0-or-later
// The law that a component states for its rows, independent of the code that builds them. The contract tests build the
// rows on many states and compare (core/testing/law_contract.cpp). No step reads it.
#pragma once

namespace insula {

struct StatedLaw {
  enum class Kind {
    potential,   ///< the rows' force is minus the gradient of a potential
    unilateral,  ///< the rows keep things apart: they only push, and nothing acts across a large gap
  };
  Kind kind = Kind::potential;
  double energy = 0;  ///< J, of a potential at the bodies' present positions

  /// Energy in J at the bodies' present positions, up to a constant: 0 where the constraint is slack, infinite where a
  /// rigid one is violated. Examples: k/2 stretch^2 for a spring, F |displacement| for a hold that slips at the force
  /// F, -F . displacement for a given load.
  static StatedLaw potential(double energy) { return {Kind::potential, energy}; }
  static StatedLaw unilateral() { return {Kind::unilateral, 0}; }
};

/// Implemented by every component that adds rows with a law of its own. Blocks with friction need none.
class StatesLaw {
 public:
  virtual ~StatesLaw() = default;
  virtual StatedLaw law() const = 0;
};

}  // namespace insula
