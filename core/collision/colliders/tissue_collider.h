// SPDX-License-Identifier: GPL-3.0-or-later
// Surface against surface: sample vertices of a against the triangles of b.
//
// The samples are an even choice of a's vertices, fixed at the start. A contact is then identified by its vertex, which
// stays the same while the surfaces slide. Each sample searches the triangles of b that face it and that are within the
// alarm distance, now or in the step's free motion. The nearest one is taken. A vertex behind that triangle is an
// overlap and has a negative gap. The geometry is that of the start of the step, since tissue moves by less than its
// own details in a step. A bump narrower than the samples' distance s can enter the other surface by about s^2 / (8 R),
// with R its radius of curvature.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/proximity.h"
#include "core/collision/search/collision_mesh.h"
#include "core/collision/search/facing_search.h"
#include "core/collision/search/search_kernels.h"
#include "core/collision/shapes/four_triangles.h"

namespace insula {

struct TissueContactSettings {
  double alarm = 0.5e-3;           ///< m
  double max_correction = 0.5e-3;  ///< largest correction of an overlap in a step, m
  double max_depth = 5e-3;         ///< vertices farther behind the surface are not pushed out, m
  double offset = 0;               ///< half the thicknesses of both walls, for middle surfaces of walls, m
};

/// A subset of the vertices of the surface. No two are closer than `distance`, and every used vertex is that close to
/// one. In order of vertex number. Deterministic.
std::vector<int> sample_vertices(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles,
                                 double distance);

class TissueCollider {
 public:
  /// Samples in an order of neighbourhoods, by the rest shape. `triangles`: the number of triangles of b.
  TissueCollider(std::vector<int> samples, std::span<const Vec3> rest, int triangles);
  /// Appends one contact for each sample that has one, in the order of samples(). Remembers the samples behind the
  /// surface, since their search reaches deeper. Does not allocate while `out` has capacity.
  void detect(const CollisionMesh& a, const CollisionMesh& b, const TissueContactSettings& settings,
              std::vector<Proximity>& out);
  const std::vector<int>& samples() const { return samples_; }
  void reset();

 private:
  static constexpr std::size_t group = 16;  ///< samples that are excluded together
  std::vector<int> samples_;
  std::vector<char> behind_;
  std::vector<double> clear_;  ///< of the samples: lower bound of the distance to b, m
  struct Group {
    double clear = 0;  ///< smallest of its samples' clear_, m
    double went = 0;   ///< reduction of the samples' clear_ that is still due, m
    std::uint64_t own = 0,
                  near = 0;  ///< regions of its samples, and of all of b that is not farther away than `around`
    double around = 0;       ///< m, reduced by the samples' own motion since ...
    double travelled = 0;    ///< ... b had travelled this far
    bool deep = true;        ///< has a sample behind the surface
  };
  /// Data of a step that all groups use.
  struct Step {
    const CollisionMesh &a, &b;
    const TissueContactSettings& settings;
    bool followed;      ///< all motion of both surfaces is known
    double open_range;  ///< largest distance of contacts without motion, m
    double farthest;    ///< the same plus the free motion of both surfaces, m
  };
  double follow(const Step& step, Group& g, std::size_t first, std::size_t last);
  bool needs_search(const Step& step, Group& g, std::size_t first, std::size_t last, double may_come);
  void begin_searches(const Step& step, std::size_t first, std::size_t last, double may_come, double margin);
  void end_searches(const Step& step, std::size_t first, std::size_t last, std::vector<Proximity>& out);
  bool contact_of(const Step& step, std::size_t sample, const FacingSearch& search, Proximity& c);
  double find_near_regions(Group& g, const CollisionMesh& a, const CollisionMesh& b, std::size_t first,
                           std::size_t last, double may_come, double elsewhere);
  void lessen(std::size_t first, std::size_t last, double swept, double at_least);
  std::vector<Group> groups_;
  std::array<long, 2> updates_{};  ///< of the meshes at the last detection
  void begin_gathering(const AabbTree& tree);
  void gather_leaves(const AabbTree& tree, const Aabb& all);
  template <class Look>
  void test_leaves(const CollisionMesh& b, const Vec3& x, const double& limit2, Look&& look);
  const FourTriangles& corners_of(const CollisionMesh& b, std::size_t leaf);
  std::vector<std::span<const int>> leaves_;  ///< triangles of the leaves near a group ...
  std::vector<BoxPack> packs_;                ///< ... and their boxes
  std::vector<FourTriangles> corners_;  ///< corners of all leaves that a sample wanted in this step, about centre_
  std::vector<int> cornered_;  ///< the leaves that these corners belong to, by the position of their first triangle in
                               ///< the tree's order
  std::vector<int> corners_at_;  ///< of the leaf that begins at this position: index of corners_, -1: not computed yet
  bool gathering_ = false;       ///< whether any leaf was gathered in this step
  Vec3 centre_ = Vec3::Zero();
  std::vector<KnownNearest> known_;  ///< of the samples: reduces tests, does not change the result
  std::array<FacingSearch, group> search_;
  std::array<bool, group> searched_{}, settled_{};  ///< of the samples of a group
  FacingSearch::Seen seen_;
};

}  // namespace insula
