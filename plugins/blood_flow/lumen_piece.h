// SPDX-License-Identifier: GPL-3.0-or-later
// Where the blood of a vessel network is and how it moves there, for instruments that sense flow.
#pragma once
#include <string_view>
#include <vector>

#include "core/base/math.h"

namespace insula {

/// The blood in one cross-section of a lumen.
struct LumenEnd {
  Vec3 centre = Vec3::Zero();  ///< m, scene frame
  double radius = 0;           ///< of the circle of the same area, m
  double flow = 0;             ///< of this moment, from the piece's `a` to its `b`, m3/s
};

/// A piece of a lumen between two neighbouring cross-sections: a frustum of a cone. The pieces of a stretch follow each
/// other.
struct LumenPiece {
  std::string_view id;  ///< of the stretch; valid as long as the simulation
  bool first = false;   ///< of its stretch
  LumenEnd a, b;
  double exchange = 0;  ///< of a sac: blood that enters and leaves it again by mixing, m3/s; else 0
  bool sac = false;     ///< a dead end, in which the directions of the flow are not known
};

/// A component that has lumens with blood.
class LumenSource {
 public:
  virtual ~LumenSource() = default;
  virtual void append_lumens(std::vector<LumenPiece>& out) const = 0;  ///< on the wall as it is after the last step
  virtual std::size_t most_lumens() const = 0;  ///< number of pieces that append_lumens() adds at most
};

}  // namespace insula
