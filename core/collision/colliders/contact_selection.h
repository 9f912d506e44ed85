// SPDX-License-Identifier: GPL-3.0-or-later
// From many proximities to few contacts, with persistent contact keys from step to step.
//
// Selection is greedy by gap. A proximity is kept if every kept one is farther than `spacing` or has a normal that
// differs by more than 40 degrees. Contacts of the last step have a small advantage, so that the choice does not
// flicker. A tool's contact keeps its key and its tangent as long as one of the same pieces stays near in the tool's
// frame. A tissue contact is identified by its vertex. Keys are unique among all selections that share a counter; they
// serve the warm start.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/proximity.h"

namespace insula {

struct SelectionSettings {
  double spacing = 2e-3;      ///< m
  double advantage = 0.2e-3;  ///< m of gap that a contact of the last step may be farther and still win
  int max_contacts = 8;
  int max_per_piece = 4;
  bool both_ends = false;  ///< surface against itself: two contacts are alike if both ends are near, in either order
};

class ContactSelection {
 public:
  /// Reduces `all` (in any reproducible order) in place and fills in keys and tangents. `next_key` counts up for every
  /// new contact. Allocates only to grow.
  void select(std::vector<Proximity>& all, const SelectionSettings& settings, std::uint64_t& next_key);
  /// Continues from another selection's contacts, as if select() had returned them. Those that it knows keep their
  /// keys. Of each, piece, local, normal and tangent are used.
  void follow(std::span<const Proximity> chosen, double spacing, std::uint64_t& next_key);
  void reset() { last_.clear(); }
  /// Reserves memory for so many proximities before a selection and contacts after it.
  void reserve(std::size_t before, std::size_t after);

 private:
  struct Known {
    int piece, other_piece, vertex, side;
    Vec3 local, tangent;
    std::uint64_t key;
    bool taken;
  };
  struct Order {
    double rank;
    int index;
    bool known;
  };
  static bool same(const Known& k, const Proximity& x, double spacing2);
  void rank(const std::vector<Proximity>& all, const SelectionSettings& settings);
  void choose(const std::vector<Proximity>& all, const SelectionSettings& settings);
  void identify(double spacing2, std::uint64_t& next_key);

  std::vector<Known> last_, next_;
  std::vector<Order> order_;
  std::vector<Proximity> kept_;
};

/// A unit vector perpendicular to n, as near to `wish` as possible. If `wish` is zero or parallel to n, the choice is
/// fixed.
Vec3 tangent_to(const Vec3& n, const Vec3& wish);

}  // namespace insula
