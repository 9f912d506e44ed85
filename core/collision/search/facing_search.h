// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the triangle of one surface that is nearest to a vertex of another and faces it. The vertex is searched for in
// every step. A triangle needs no test while its distance exceeds the nearest one by more than all motion since. The
// result depends only on positions. Of two triangles at the same distance, the lower number counts.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/collision/search/collision_mesh.h"

namespace insula {

/// What is known of a vertex from earlier steps. Distances must be reduced by all motion.
struct KnownNearest {
  int triangle = -1;  ///< the nearest in the last step
  int home = -1;      ///< the triangle whose neighbours are treated apart from all others
  double beside = 0;  ///< no triangle except the nearest is closer than this, m ...
  double beyond = 0;  ///< ... and no triangle without a corner of `home` is closer than this

  /// Records motion of up to `swept`, m. Unknown triangles are no nearer than `at_least`, m.
  void lessen(double swept, double at_least) {
    beside = std::min(beside - swept, at_least);
    beyond = std::min(beyond - swept, at_least);
  }
};

class FacingSearch {
 public:
  using Seen = std::vector<std::pair<int, double>>;  ///< triangles and their squared distances, m2

  /// The search ends at `reach`. Triangles that are farther than the nearest by up to `margin` are tested too. It is
  /// then known for some steps that no other triangle can become the nearest, m.
  void begin(const CollisionMesh& a, int vertex, const CollisionMesh& b, double reach, double margin);
  /// Tests the triangles of the last step. Returns whether that decides the search, which is possible if the nearest is
  /// no farther than `sure`. If not, call look() for all triangles that may be within limit2(), and then settle().
  bool follow(KnownNearest& known, double sure, Seen& seen);
  void look(int triangle, Seen& seen);
  void settle(KnownNearest& known, const Seen& seen) const;

  const Vec3& x() const { return x_; }
  const double& limit2() const { return limit2_; }  ///< m2
  int nearest() const { return best_; }             ///< -1: none within reach
  const Vec3& bary() const { return bary_; }
  const Vec3& point() const { return point_; }
  double clear() const { return std::sqrt(any2_); }  ///< lower bound of the distance of all triangles, m

 private:
  const CollisionMesh *a_ = nullptr, *b_ = nullptr;
  int vertex_ = -1, best_ = -1;
  Vec3 x_ = Vec3::Zero(), normal_ = Vec3::Zero(), bary_ = Vec3::Zero(), point_ = Vec3::Zero();
  double any2_ = 0, least2_ = 0, limit2_ = 0, margin_ = 0;
};

}  // namespace insula
