// SPDX-License-Identifier: GPL-3.0-or-later
// Surface against surface.
#include "core/collision/colliders/tissue_collider.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/collision/search/vertex_groups.h"

namespace insula {

std::vector<int> sample_vertices(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles,
                                 double distance) {
  std::vector<char> used(rest.size(), 0);
  for (const auto& t : triangles)
    for (int v : t) used[std::size_t(v)] = 1;
  using Cell = std::array<long, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      return std::size_t(c[0]) * 73856093u ^ std::size_t(c[1]) * 19349663u ^ std::size_t(c[2]) * 83492791u;
    }
  };
  std::unordered_map<Cell, std::vector<int>, Hash> grid;  // only looked up, never iterated, so its order has no effect
  std::vector<int> samples;
  for (int v = 0; v < int(rest.size()); ++v) {
    if (!used[std::size_t(v)]) continue;
    const Vec3& p = rest[std::size_t(v)];
    const Cell c{long(std::floor(p[0] / distance)), long(std::floor(p[1] / distance)),
                 long(std::floor(p[2] / distance))};
    bool taken = false;
    constexpr long around[3] = {0, -1, 1};  // the most likely cell first
    for (long i : around)
      for (long j : around)
        for (long k : around) {
          if (taken) break;
          const auto at = grid.find({c[0] + i, c[1] + j, c[2] + k});
          if (at == grid.end()) continue;
          for (int o : at->second) taken = taken || (rest[std::size_t(o)] - p).squaredNorm() < distance * distance;
        }
    if (taken) continue;
    grid[c].push_back(v);
    samples.push_back(v);
  }
  return samples;
}

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double surroundings = 2e-3;  ///< farther triangles need not be followed by a group for some steps, m
constexpr double horizon =
    2e-3;  ///< groups search farther than needed by this, so that the result is valid for some steps, m
constexpr double near_horizon = 5e-4;  ///< the same for samples
constexpr double slow = 5e-5;          ///< samples that move less keep their nearest triangle for some steps, m

// Coordinates of four points: x of all, y, z.
std::array<Float4, 3> by_coordinate(const std::array<Float4, 4>& p) {
  const Float4 xy01 = __builtin_shufflevector(p[0], p[1], 0, 4, 1, 5),
               xy23 = __builtin_shufflevector(p[2], p[3], 0, 4, 1, 5);
  const Float4 z01 = __builtin_shufflevector(p[0], p[1], 2, 6, 3, 7),
               z23 = __builtin_shufflevector(p[2], p[3], 2, 6, 3, 7);
  return {__builtin_shufflevector(xy01, xy23, 0, 1, 4, 5), __builtin_shufflevector(xy01, xy23, 2, 3, 6, 7),
          __builtin_shufflevector(z01, z23, 0, 1, 4, 5)};
}

}  // namespace

TissueCollider::TissueCollider(std::vector<int> samples, std::span<const Vec3> rest, int triangles)
    : samples_(std::move(samples)) {
  leaves_.reserve(std::size_t(triangles));
  packs_.reserve(std::size_t(triangles) / BoxPack::size + 1);
  corners_.reserve(std::size_t(triangles));
  cornered_.reserve(std::size_t(triangles));
  corners_at_.assign(std::size_t(triangles), -1);
  seen_.reserve(3 * std::size_t(triangles) + 1);
  order_by_position(samples_.data(), samples_.data() + samples_.size(), rest, std::ptrdiff_t(group));
  reset();
}

void TissueCollider::reset() {
  behind_.assign(samples_.size(), 1);
  known_.assign(samples_.size(), {});
  clear_.assign(samples_.size(), 0.0);
  groups_.assign((samples_.size() + group - 1) / group, {});
}

// Single-precision data of leaves are relative to the middle of the surface, so they are at most a few cm.
void TissueCollider::begin_gathering(const AabbTree& tree) {
  gathering_ = true;
  for (int place : cornered_) corners_at_[std::size_t(place)] = -1;
  cornered_.clear();
  corners_.clear();
  const Aabb all = tree.bounds();
  centre_ = 0.5 * (all.low + all.high);
}

// Collects the leaves that any sample of a group may need, with their boxes side by side.
void TissueCollider::gather_leaves(const AabbTree& tree, const Aabb& all) {
  if (!gathering_) begin_gathering(tree);
  leaves_.clear();
  packs_.clear();
  tree.leaves(all, [&](const OuterBox& box, std::span<const int> triangles) {
    const std::size_t lane = leaves_.size() % BoxPack::size;
    if (lane == 0) packs_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      packs_.back().low[k][lane] = box.low[k];
      packs_.back().high[k][lane] = box.high[k];
    }
    leaves_.push_back(triangles);
  });
  for (std::size_t lane = leaves_.size() % BoxPack::size; lane != 0; lane = (lane + 1) % BoxPack::size)
    for (auto& row : packs_.back().low) row[lane] = 1e15f;  // no sample is near it
}

const FourTriangles& TissueCollider::corners_of(const CollisionMesh& b, std::size_t leaf) {
  const std::span<const int> triangles = leaves_[leaf];
  const int place = b.tree().place_of(triangles);
  int& at = corners_at_[std::size_t(place)];
  if (at >= 0) return corners_[std::size_t(at)];
  at = int(corners_.size());
  cornered_.push_back(place);
  FourTriangles& c = corners_.emplace_back();
  std::array<const int*, 4> corner;
  for (std::size_t lane = 0; lane < 4; ++lane)
    corner[lane] = b.triangle_at(place + int(std::min(lane, triangles.size() - 1))).data();
  std::array<Float4, 3>* const to[3] = {&c.a, &c.b, &c.c};
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<Float4, 4> x;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const Vec3 p = b.vertex(corner[lane][k]) - centre_;
      x[lane] = rounded(p);
    }
    *to[k] = by_coordinate(x);
  }
  return c;
}

// look(triangle) for every triangle that may be nearer to x than sqrt(limit2), which `look` lowers.
template <class Look>
void TissueCollider::test_leaves(const CollisionMesh& b, const Vec3& x, const double& limit2, Look&& look) {
  const SearchKernels& kernels = search_kernels();
  const std::array<float, 3> at{float(x[0]), float(x[1]), float(x[2])};
  const float rounded = float(x.cwiseAbs().maxCoeff()) * 1.2e-7f;
  const Vec3 off = x - centre_;
  const float px = float(off[0]), py = float(off[1]), pz = float(off[2]);
  for (std::size_t k = 0; k < packs_.size(); ++k)
    for (std::uint32_t near = kernels.boxes_near(packs_[k], at, rounded, float(limit2) * 1.000001f); near != 0;
         near &= near - 1) {
      const std::size_t leaf = std::size_t(BoxPack::size) * k + std::size_t(std::countr_zero(near));
      const Float4 distance2 = corners_of(b, leaf).distance2(px, py, pz);
      for (std::size_t i = 0; i < leaves_[leaf].size(); ++i)
        if (FourTriangles::may_be_within(distance2[i], limit2)) look(leaves_[leaf][i]);
    }
}

// Updates the bounds of samples after motion. Unknown triangles are no nearer than `at_least`.
void TissueCollider::lessen(std::size_t first, std::size_t last, double swept, double at_least) {
  for (std::size_t i = first; i < last; ++i) {
    clear_[i] = std::min(clear_[i] - swept, at_least);
    known_[i].lessen(swept, at_least);
  }
}

// Finds the regions of b near the group. Returns the new lower bound of the distance to all other regions, which was
// `elsewhere`.
double TissueCollider::find_near_regions(Group& g, const CollisionMesh& a, const CollisionMesh& b, std::size_t first,
                                         std::size_t last, double may_come, double elsewhere) {
  Aabb here;
  for (std::size_t i = first; i < last; ++i) here.add(a.vertex(samples_[i]));
  double new_bound = g.around = may_come + surroundings;
  g.near = b.regions_near(here, g.around, g.near, new_bound);
  g.travelled = b.travelled();
  return std::max(elsewhere, new_bound);
}

// Updates the known bounds of a group by the motion since the last step. Returns this motion, m.
double TissueCollider::follow(const Step& step, Group& g, std::size_t first, std::size_t last) {
  const CollisionMesh &a = step.a, &b = step.b;
  if (g.own == 0)
    for (std::size_t i = first; i < last; ++i) g.own |= a.region_of(samples_[i]);
  const double own = a.moved(g.own), went = own + b.moved(g.near);
  g.around -= own;
  const double elsewhere = g.around - (b.travelled() - g.travelled),
               anyone = step.open_range + a.may_move(g.own) + b.farthest_free();
  g.clear -= went;
  g.went += went;
  if (!step.followed || elsewhere <= anyone) {
    const double bound = find_near_regions(g, a, b, first, last, anyone, elsewhere),
                 at_least = step.followed ? bound : 0.0;
    lessen(first, last, g.went, at_least);
    g.clear = std::min(g.clear, at_least);
    g.went = 0;
  }
  return went;
}

// Whether the samples of a group must be searched. A group needs no search if nothing can have come near since the last
// one.
bool TissueCollider::needs_search(const Step& step, Group& g, std::size_t first, std::size_t last, double may_come) {
  if (!g.deep && g.clear > may_come) return false;
  lessen(first, last, g.went, unlimited);
  g.went = 0;
  const bool had_any = std::any_of(known_.begin() + std::ptrdiff_t(first), known_.begin() + std::ptrdiff_t(last),
                                   [](const KnownNearest& k) { return k.triangle >= 0; });
  if (g.deep || had_any) return true;
  Aabb here;
  for (std::size_t i = first; i < last; ++i) here.add(step.a.vertex(samples_[i]));
  here.inflate(may_come + horizon);
  if (step.b.tree().any_overlapping(here)) return true;
  std::fill(clear_.begin() + std::ptrdiff_t(first), clear_.begin() + std::ptrdiff_t(last), may_come + horizon);
  g.clear = may_come + horizon;
  return false;
}

// Begins the searches of a group's samples. Deep samples search as far as they are pushed out. Samples with the same
// nearest triangle as in the last step are done. The leaves near all others are gathered once.
void TissueCollider::begin_searches(const Step& step, std::size_t first, std::size_t last, double may_come,
                                    double margin) {
  const double open_reach = may_come + near_horizon,
               deep_reach = std::max(may_come, step.settings.max_depth) + near_horizon;
  Aabb all;
  bool any_open = false;
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t k = i - first;
    searched_[k] = behind_[i] || clear_[i] <= may_come;
    if (!searched_[k]) continue;
    FacingSearch& search = search_[k];
    search.begin(step.a, samples_[i], step.b, behind_[i] ? deep_reach : open_reach, margin);
    settled_[k] = search.follow(known_[i], behind_[i] ? -1.0 : step.farthest, seen_);
    if (settled_[k]) continue;
    Aabb here;
    here.add(search.x());
    here.inflate(std::sqrt(search.limit2()));
    all.add(here);
    any_open = true;
  }
  if (any_open) gather_leaves(step.b.tree(), all);
}

// Computes the contact of a sample with the nearest triangle of its search. False if it has none.
bool TissueCollider::contact_of(const Step& step, std::size_t sample, const FacingSearch& search, Proximity& c) {
  const CollisionMesh& b = step.b;
  const int best = search.nearest(), v = samples_[sample];
  if (best < 0) return false;
  const Vec3 x = search.x(), u = step.a.free(v), best_bary = search.bary(), best_point = search.point();
  const TriangleFeature f = feature_of(best_bary);
  const Vec3 outward = b.pseudo_normal(best, f);
  const Vec3 d = x - best_point;
  const double distance = d.norm();
  const bool outside = d.dot(outward) >= 0;
  // Behind the triangle that faces it, but perhaps outside of a fold: the nearest of all triangles decides.
  if (!outside && (distance > step.settings.max_depth || !b.nearest(x, 0, distance).behind)) return false;
  c.vertex = v;
  c.triangle = best;
  c.bary = best_bary;
  c.point = best_point;
  if (distance > 1e-6) {
    // The sample is beside a border, or beyond a triangle that faces away.
    if (!b.locally_closest(best, f, d / distance, 0, 0.05)) return false;
    c.normal = (outside ? d : Vec3(-d)) / distance;
  } else {
    c.normal = outward;
  }
  c.gap = (outside ? distance : -distance) - step.settings.offset;
  const double approach = c.normal.dot(u - b.free_at(best, best_bary));
  if (c.gap > step.settings.alarm && c.gap + approach > step.settings.alarm) return false;
  behind_[sample] = !outside;
  c.start_gap = std::max(c.gap, -step.settings.max_correction);
  return true;
}

// Completes the searches of a group's samples and appends their contacts.
void TissueCollider::end_searches(const Step& step, std::size_t first, std::size_t last, std::vector<Proximity>& out) {
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t k = i - first;
    if (!searched_[k]) continue;
    FacingSearch& search = search_[k];
    if (!settled_[k]) {
      seen_.clear();
      test_leaves(step.b, search.x(), search.limit2(), [&](int t) { search.look(t, seen_); });
      search.settle(known_[i], seen_);
    }
    behind_[i] = 0;
    clear_[i] = search.clear();
    Proximity c;
    if (contact_of(step, i, search, c)) out.push_back(c);
  }
}

void TissueCollider::detect(const CollisionMesh& a, const CollisionMesh& b, const TissueContactSettings& settings,
                            std::vector<Proximity>& out) {
  if (b.tree().empty()) return;
  // Unknown motion in between may have brought any triangle near.
  const bool followed = a.updates() - updates_[0] <= 1 && b.updates() - updates_[1] <= 1;
  updates_ = {a.updates(), b.updates()};
  gathering_ = false;
  const double open_range = settings.alarm + settings.offset;
  const Step step{a, b, settings, followed, open_range, open_range + a.farthest_free() + b.farthest_free()};
  for (std::size_t first = 0; first < samples_.size(); first += group) {
    const std::size_t last = std::min(first + group, samples_.size());
    Group& g = groups_[first / group];
    const double went = follow(step, g, first, last);
    if (g.near == 0 && !g.deep) continue;
    const double may_come = open_range + a.may_move(g.own) + b.may_move(g.near);
    if (!needs_search(step, g, first, last, may_come)) continue;
    begin_searches(step, first, last, may_come, went < slow ? 4 * slow : 0);
    end_searches(step, first, last, out);
    g.deep = std::any_of(behind_.begin() + std::ptrdiff_t(first), behind_.begin() + std::ptrdiff_t(last),
                         [](char x) { return x != 0; });
    g.clear = *std::min_element(clear_.begin() + std::ptrdiff_t(first), clear_.begin() + std::ptrdiff_t(last));
  }
}

}  // namespace insula
