// SPDX-License-Identifier: GPL-3.0-or-later
// A thin-walled surface against itself: sampled vertices against triangles that face them, across the lumen (inner
// sides) or outside. The triangles are the wall's middle surface. The gap is their distance less one wall thickness.
//
// The rest shape, where nothing has crossed, tells which side a pair belongs to. It is inner if the straight line
// between the two leaves the vertex inward, ends at the triangle from inside, and is no longer than a few lumens. It is
// outer if the line runs outside at both ends. A vertex on the wrong side of its partner has therefore crossed. It has
// a negative gap and is brought back, and no history is needed for the inner side. Pairs that are near at rest are
// neighbours and never touch.
//
// A sample with nothing near is tested again only when motion may have brought something near. The motion of its region
// of the mesh and of its possible partners' regions decides that. A sample with something near keeps a list of its
// possible partners until motion may have added to them.
//
// The geometry is that of the start of the step. Where a tool presses on the wall, opposite() finds the point behind
// that point. A thin wall yields between its supports, so each contact of a tool needs a support of its own.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/workers.h"
#include "core/collision/proximity.h"
#include "core/collision/search/collision_mesh.h"

namespace insula {

struct SelfContactSettings {
  double thickness = 0.3e-3;       ///< middle surfaces stay this far apart, m
  double alarm = 0.5e-3;           ///< of the gap, m
  double max_correction = 0.3e-3;  ///< largest correction of an overlap in a step, m
  double max_depth = 4e-3;         ///< crossings deeper than this are ignored, m
  bool inner = true, outer = false;
  bool normal_under_relaxation = false;  ///< whether normals of pressing contacts change slowly, for walls that yield
};

/// The point across the lumen behind a point of the wall.
struct Opposite {
  int triangle = -1;  ///< -1: none
  Vec3 bary = Vec3::Zero();
  double distance = 0;  ///< m
};

class SelfCollider {
 public:
  static constexpr int inner = 0, outer = 1;  ///< Proximity::side

  /// `thickness`: pairs nearer than twice this at rest are neighbours. Samples are `spacing` apart.
  SelfCollider(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles, double spacing,
               double thickness);
  /// Appends at most one contact a sample and side, in an order that depends on the arguments alone, for any number of
  /// threads. Does not allocate while `out` has capacity.
  void detect(const CollisionMesh& mesh, const SelfContactSettings& settings, std::vector<Proximity>& out,
              Workers& workers);
  /// Point of the wall that is met first from a point of it along the unit vector `along`, which leads into the lumen.
  /// The search ends at the distance `far`, m.
  Opposite opposite(const CollisionMesh& mesh, int triangle, const Vec3& bary, const Vec3& along, double far) const;
  const std::vector<int>& samples() const { return samples_; }
  void reset();

 private:
  static constexpr std::size_t piece = 64;  ///< samples that one task looks at

  struct Partner {
    double was;  ///< distance when the list was made, m
    int triangle;
  };

  int kind(std::size_t sample, int triangle) const;  ///< inner, outer or -1
  double lumen(const CollisionMesh& rest, int vertex) const;
  bool may_be_near(const CollisionMesh& mesh, std::size_t sample, int side, double range);
  void list_partners(const CollisionMesh& mesh, std::size_t sample, int side, double far);
  struct Search;  // search for the nearest partner of a sample
  void test_partners(Search& search, int side, double reach, double far);
  int contact_with(const Search& nearest, const SelfContactSettings& settings, int side, int before,
                   Proximity& c) const;
  void under_relax_normal(Proximity& c, std::size_t sample, bool may_slow);
  void near(const CollisionMesh& mesh, const SelfContactSettings& settings, std::size_t sample, int side,
            std::vector<Proximity>& out);

  std::vector<int> samples_;
  std::vector<Vec3> position_, normal_;            ///< of the samples at rest
  std::vector<double> reach_;                      ///< of the samples: longest distance to an inner partner at rest, m
  std::vector<Vec3> face_position_, face_normal_;  ///< of the triangles at rest
  std::vector<std::array<Vec3, 3>> corners_;       ///< of the triangles at rest
  std::vector<double> extent2_;                    ///< of the triangles at rest: farthest corner from the middle, m2
  std::vector<std::uint64_t> own_,
      partners_[2];            ///< of the samples: the mesh's regions of itself, of its possible partners of a side
  std::vector<Vec3> outward_;  ///< of the samples now; computed when first wanted
  std::vector<char> outward_known_;
  std::vector<char>
      close_[2];  ///< 1: had a contact of this side in the last step, 2: had crossed; its search reaches farther
  std::vector<Vec3> direction_[2];  ///< of the samples: normal of the last contact of this side
  /// Oscillation of the normal of a sample that presses.
  struct Swing {
    Vec3 turn = Vec3::Zero();  ///< rotation vector that was last wanted, rad
    int count = 0;             ///< how often of late a rotation undid the one before
    /// The fraction of the wanted rotation that the normal takes in this step. It is reduced once the normal has swung
    /// for long, until the pressing ends.
    double share(const Vec3& wanted);
  };
  std::vector<Swing> swing_[2];
  std::vector<double> clear_[2];  ///< of the samples: lower bound of the distance to partners of this side, m
  std::vector<std::vector<Partner>> lists_[2];  ///< of the samples: possible partners, nearest first ...
  std::vector<double> covered_[2];  ///< ... valid while the motion is at most this, m; negative: must be made again
  long updates_ = 0;                ///< of the mesh at the last detection
  std::vector<std::vector<Proximity>> found_;  ///< of the tasks
  double neighbour_ = 0;                       ///< m
};

}  // namespace insula
