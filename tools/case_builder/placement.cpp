// SPDX-License-Identifier: GPL-3.0-or-later
// The search for the place: what overlaps costs, and so does leaving the shipped place and directions.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/solid.h"

namespace insula::case_builder {
namespace {

constexpr double reach = 12;  // mm, around the neck's position: the region in which rotations are tested
constexpr double past_neck = 1.5, room_of_tips = 0.8;  // mm: of the tips past the flattened neck, and before the floor
constexpr double behind_costs = 0.1;
constexpr int coarse_spins = 24;
constexpr std::size_t most_placements = 4;  // of each lean
constexpr double leans[] = {0, 0.5, 0.9};   // rad, of the sac away from the line of sight
constexpr double least_apart = 0.7;         // rad, of the turns of two placements
constexpr double limit = 4;                 // mm, beyond which distances do not matter

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// An orthonormal frame with its third axis along `a`, its first towards `b`.
Mat3 frame(const Vec3& a, const Vec3& b) {
  Vec3 x = b - b.dot(a) * a;
  x = x.norm() > 0.1 ? x.normalized() : Vec3(a.unitOrthogonal());
  Mat3 m;
  m << x, a.cross(x), a;
  return m;
}

struct Turn {
  double spin = 0, tilt_a = 0, tilt_b = 0;
  Vec3 shift = Vec3::Zero();
};

/// The approach's direction of the sac, leaned away from the line of sight.
Vec3 leaned(const Approach& a, double lean) {
  const Vec3 axis = a.to_surgeon.cross(a.sac_points);
  return turn(lean, axis.norm() > 0.1 ? axis.normalized() : Vec3(a.sac_points.unitOrthogonal())) * a.sac_points;
}

/// Rotation of the frame of the neck's normal and the parent's direction at the neck onto that of the shipped case.
Mat3 base_rotation(const artery::Vessel& v, const Approach& a, const Vec3& sac_points) {
  const auto& parent = v.centrelines.front().curve;
  std::size_t near = 0;
  for (std::size_t k = 0; k < parent.size(); ++k)
    if ((parent.points[k] - v.neck->centre).norm() < (parent.points[near] - v.neck->centre).norm()) near = k;
  const std::size_t back = near > parent.size() / 3 ? near - parent.size() / 3 : 0;
  const Vec3 arrives =
      near > back ? Vec3((parent.points[near] - parent.points[back]).normalized()) : parent.tangent(near);
  return frame(sac_points, a.parent_arrives) * frame(v.neck->normal, arrives).transpose();
}

/// Cost of a placement of the vessel in the fissure.
class PlacementCost {
 public:
  const double wanted_spin;  ///< rad
  PlacementCost(const artery::Vessel& v, const Fissure& fissure, const Options& o)
      : wanted_spin(o.spin * std::numbers::pi / 180),
        approach_(fissure.approach),
        normal_(v.neck->normal),
        behind_neck_(0.25 * std::numbers::pi * v.neck->diameter + past_neck),
        o_(o) {
    const Vec3 low = approach_.neck - Vec3::Constant(reach + 4), high = approach_.neck + Vec3::Constant(reach + 4);
    const auto add = [&](const TriMesh& mesh, double weight) {
      obstacles_.push_back({DistanceGrid(Solid(mesh), low, high, 0.8, limit), weight});
    };
    for (const Lobe& lobe : fissure.lobes) add(lobe.surface, 1);
    add(fissure.floor, 6);
    if (!fissure.retractors.triangles.empty()) add(fissure.retractors, 6);
    const auto& all = v.wall.mesh.vertices;
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / 350))
      samples_.push_back(all[i] - v.neck->centre);
    lean(v, 0);
  }
  /// Turns the sac of all placements away from the line of sight, rad.
  void lean(const artery::Vessel& v, double angle) {
    axis_ = leaned(approach_, angle);
    base_ = base_rotation(v, approach_, axis_);
  }
  Mat3 rotation(const Turn& t) const {
    const Vec3 u = axis_.unitOrthogonal(), w = axis_.cross(u);
    return turn(t.tilt_a, u) * turn(t.tilt_b, w) * turn(t.spin, axis_) * base_;
  }
  double operator()(const Turn& t) const {
    const Mat3 r = rotation(t);
    double sum = 0;
    for (const Vec3& s : samples_) {
      const Vec3 p = r * s + approach_.neck + t.shift;
      for (const Obstacle& ob : obstacles_)
        if (const double in = o_.gap + wall_half - ob.grid.at(p); in > 0) sum += ob.weight * in * in;
    }
    // Blades across the neck need room for their tips before the floor, which does not give way.
    const Vec3 normal = r * normal_, &view = approach_.to_surgeon,
               back = -(view - view.dot(normal) * normal).normalized();
    double behind = 0;
    for (const double share : {0.6, 0.8, 1.0}) {
      const Vec3 p = approach_.neck + t.shift + share * behind_neck_ * back;
      behind += std::pow(std::max(0.0, room_of_tips - obstacles_[floor].grid.at(p)), 2);
    }
    sum += behind_costs * double(samples_.size()) * behind;
    const double away = std::remainder(t.spin - wanted_spin, 2 * std::numbers::pi);
    return sum / double(samples_.size()) + 0.25 * (t.tilt_a * t.tilt_a + t.tilt_b * t.tilt_b) +
           0.01 * t.shift.squaredNorm() + (o_.keep_spin ? 50 : 0.01) * away * away;
  }

 private:
  struct Obstacle {
    DistanceGrid grid;
    double weight;
  };
  static constexpr std::size_t floor = 2;  // of the obstacles
  const Approach& approach_;
  Vec3 axis_;  ///< where the sac points
  Mat3 base_;
  Vec3 normal_;         ///< of the neck, in the vessel's frame
  double behind_neck_;  ///< from its middle to the tips of blades that close it, mm
  const Options& o_;
  std::vector<Obstacle> obstacles_;
  std::vector<Vec3> samples_;  ///< vertices of the wall relative to the neck's centre, mm
};

struct BestTurn {
  Turn turn;
  double cost = 1e300;
};

/// The best tilt and shift of a regular set for each of some turns about the sac's axis, the best first.
std::vector<BestTurn> coarse_search(const PlacementCost& cost, bool keep_spin, Progress& progress) {
  std::vector<BestTurn> all;
  const int spins = keep_spin ? 1 : coarse_spins;
  for (int i = 0; i < spins; ++i) {
    progress.share(double(i) / spins);
    BestTurn best;
    for (const double a : {-0.35, 0.0, 0.35})
      for (const double b : {-0.35, 0.0, 0.35})
        for (const double x : {-1.5, 1.0})
          for (const double y : {-1.5, 1.0})
            for (const double z : {-1.5, 1.0}) {
              const Turn t{cost.wanted_spin + 2 * std::numbers::pi * i / coarse_spins, a, b, Vec3(x, y, z)};
              if (const double c = cost(t); c < best.cost) best = {t, c};
            }
    all.push_back(best);
  }
  std::stable_sort(all.begin(), all.end(), [](const BestTurn& a, const BestTurn& b) { return a.cost < b.cost; });
  return all;
}

/// Of those, the best that are turned well apart.
std::vector<BestTurn> apart(const std::vector<BestTurn>& all) {
  std::vector<BestTurn> out;
  for (const BestTurn& t : all) {
    const bool near_another = std::any_of(out.begin(), out.end(), [&](const BestTurn& o) {
      return std::abs(std::remainder(o.turn.spin - t.turn.spin, 2 * std::numbers::pi)) < least_apart;
    });
    if (!near_another && out.size() < most_placements) out.push_back(t);
  }
  return out;
}

/// Descends from `best` with smaller and smaller steps along each coordinate.
void refine(const PlacementCost& cost, BestTurn& best) {
  for (double step = 1; step > 0.04; step *= 0.5)
    for (bool moved = true; moved;) {
      moved = false;
      for (int k = 0; k < 12; ++k) {
        Turn t = best.turn;
        const double d = (k % 2 ? -1 : 1) * step;
        if (k / 2 == 0) t.spin += 0.15 * d;
        else if (k / 2 == 1) t.tilt_a += 0.15 * d;
        else if (k / 2 == 2) t.tilt_b += 0.15 * d;
        else t.shift[k / 2 - 3] += 0.7 * d;
        if (t.shift.norm() > 4 || std::hypot(t.tilt_a, t.tilt_b) > 0.7) continue;
        if (const double c = cost(t); c < best.cost - 1e-12) best = {t, c}, moved = true;
      }
    }
}

}  // namespace

std::vector<Placement> find_placements(const artery::Vessel& v, const Fissure& fissure, const Options& o,
                                       Progress& progress) {
  if (o.pose) return {placement_of(*o.pose)};
  if (o.in_place) return {Placement()};
  if (!v.neck) throw InputError("a vessel without a neck has no place");
  progress.step("distances in the fissure");
  PlacementCost cost(v, fissure, o);
  progress.step("looking for the place");
  // The best of each lean first, then the second of each.
  std::vector<std::vector<Placement>> ranks(most_placements);
  for (const double lean : leans) {
    if (o.keep_spin && lean != 0) continue;
    cost.lean(v, lean);
    std::vector<BestTurn> starts = apart(coarse_search(cost, o.keep_spin, progress));
    for (BestTurn& t : starts) refine(cost, t);
    std::stable_sort(starts.begin(), starts.end(),
                     [](const BestTurn& a, const BestTurn& b) { return a.cost < b.cost; });
    for (std::size_t k = 0; k < starts.size(); ++k) {
      Placement& p = ranks[k].emplace_back();
      p.rotation = cost.rotation(starts[k].turn);
      p.shift = fissure.approach.neck + starts[k].turn.shift - p.rotation * v.neck->centre;
    }
  }
  std::vector<Placement> out;
  for (const std::vector<Placement>& rank : ranks) out.insert(out.end(), rank.begin(), rank.end());
  return out;
}

artery::Vessel placed(artery::Vessel v, const Placement& p) {
  for (Vec3& x : v.wall.mesh.vertices) x = p.apply(x);
  for (Vec3& x : v.picture.vertices) x = p.apply(x);
  for (artery::CapPlane& cap : v.wall.caps) cap.centre = p.apply(cap.centre), cap.normal = p.rotation * cap.normal;
  for (artery::NamedCurve& c : v.centrelines)
    for (Vec3& x : c.curve.points) x = p.apply(x);
  if (v.neck) v.neck->centre = p.apply(v.neck->centre), v.neck->normal = p.rotation * v.neck->normal;
  if (v.bleb) v.bleb->first = p.apply(v.bleb->first);
  return v;
}

}  // namespace insula::case_builder
