// SPDX-License-Identifier: GPL-3.0-or-later
// Selection of contacts and their keys.
#include "core/collision/colliders/contact_selection.h"

#include <algorithm>
#include <cmath>

namespace insula {

Vec3 tangent_to(const Vec3& n, const Vec3& wish) {
  Vec3 t = wish - n.dot(wish) * n;
  if (t.squaredNorm() < 1e-4) {
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    t = Vec3::Unit(least);
    t -= n.dot(t) * n;
  }
  t.normalize();
  t -= n.dot(t) * n;  // perpendicular to the last significant bit
  return t.normalized();
}

namespace {
Vec3 other_end(const Proximity& x) { return x.point + x.gap * x.normal; }

// Whether a kept contact k makes x redundant: the two are alike and near one another.
bool makes_redundant(const Proximity& k, const Proximity& x, double apart2, bool both_ends) {
  constexpr double cos40 = 0.766;
  const double cosine = k.normal.dot(x.normal);
  // Tissue finds the same contact from both sides, with opposite normals.
  bool alike = x.vertex >= 0 && k.side != x.side ? cosine < -cos40 : cosine > cos40;
  if (both_ends && alike) {
    alike = k.side == x.side && (other_end(k) - other_end(x)).squaredNorm() < apart2;
  } else if (both_ends && cosine < -cos40 && k.side == x.side) {
    if ((k.point - other_end(x)).squaredNorm() < apart2 && (other_end(k) - x.point).squaredNorm() < apart2) return true;
  }
  return alike && (k.point - x.point).squaredNorm() < apart2;
}

}  // namespace

void ContactSelection::reserve(std::size_t before, std::size_t after) {
  order_.reserve(before);
  kept_.reserve(after);
  last_.reserve(after);
  next_.reserve(after);
}

bool ContactSelection::same(const Known& k, const Proximity& x, double spacing2) {
  if (x.vertex >= 0) return k.vertex == x.vertex && k.side == x.side;
  return k.piece == x.piece && k.other_piece == x.other_piece && (k.local - x.local).squaredNorm() < spacing2;
}

// Sorts by gap. Contacts of the last step get an advantage.
void ContactSelection::rank(const std::vector<Proximity>& all, const SelectionSettings& settings) {
  const double spacing2 = settings.spacing * settings.spacing;
  order_.clear();
  for (int i = 0; i < int(all.size()); ++i) {
    const Proximity& x = all[std::size_t(i)];
    double rank = x.gap;
    bool known = false;
    for (const Known& k : last_)
      if (same(k, x, spacing2)) {
        known = true;
        rank -= settings.advantage * (x.vertex >= 0 ? 1 : 1 - std::sqrt((k.local - x.local).squaredNorm() / spacing2));
        break;
      }
    order_.push_back({rank, i, known});
  }
  std::sort(order_.begin(), order_.end(),
            [](const Order& a, const Order& b) { return a.rank != b.rank ? a.rank < b.rank : a.index < b.index; });
}

// Copies proximities to kept_, the best ones first.
void ContactSelection::choose(const std::vector<Proximity>& all, const SelectionSettings& settings) {
  const double spacing2 = settings.spacing * settings.spacing;
  kept_.clear();
  for (const Order& o : order_) {
    if (int(kept_.size()) >= settings.max_contacts) break;
    const Proximity& x = all[std::size_t(o.index)];
    bool keep = true;
    // A wall's contacts do not move, and those at the limit of the spacing must not flicker.
    const double apart2 = settings.both_ends && o.known ? 0.81 * spacing2 : spacing2;
    int of_piece = 0;
    for (const Proximity& k : kept_) {
      if (k.piece == x.piece && x.piece >= 0) ++of_piece;
      if (makes_redundant(k, x, apart2, settings.both_ends)) {
        keep = false;
        break;
      }
    }
    if (keep && (x.piece < 0 || of_piece < settings.max_per_piece)) kept_.push_back(x);
  }
}

// Sets keys and tangents of the kept contacts. A contact that continues has those of the last step.
void ContactSelection::identify(double spacing2, std::uint64_t& next_key) {
  next_.clear();
  for (Proximity& x : kept_) {
    Known* match = nullptr;
    double least = 1e300;
    for (Known& k : last_) {
      if (k.taken || !same(k, x, spacing2)) continue;
      const double d = x.vertex >= 0 ? 0 : (k.local - x.local).squaredNorm();
      if (d < least) {
        least = d;
        match = &k;
      }
    }
    if (match) match->taken = true;
    x.key = match ? match->key : next_key++;
    x.tangent = tangent_to(x.normal, match ? match->tangent : Vec3(Vec3::Zero()));
    next_.push_back({x.piece, x.other_piece, x.vertex, x.side, x.local, x.tangent, x.key, false});
  }
  last_.swap(next_);
}

void ContactSelection::follow(std::span<const Proximity> chosen, double spacing, std::uint64_t& next_key) {
  for (Known& k : last_) k.taken = false;
  kept_.assign(chosen.begin(), chosen.end());
  identify(spacing * spacing, next_key);
}

void ContactSelection::select(std::vector<Proximity>& all, const SelectionSettings& settings, std::uint64_t& next_key) {
  for (Known& k : last_) k.taken = false;
  rank(all, settings);
  choose(all, settings);
  identify(settings.spacing * settings.spacing, next_key);
  all.assign(kept_.begin(), kept_.end());
}

}  // namespace insula
