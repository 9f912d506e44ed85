// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of the narrowest section near the border of what bulges.
#include <algorithm>
#include <cmath>
#include <optional>

#include "import_parts.h"
#include "neck_planes.h"

namespace insula::artery {
namespace {

/// A plane near the border of what bulges: a shift along the first normal, and its tilt.
struct TiltedPlane {
  double up, tilt_a, tilt_b;
  double cost = 1e300;
};
bool cheaper(const TiltedPlane& x, const TiltedPlane& y) { return x.cost < y.cost; }

/// Planes near the border of what bulges, and how good a neck each one is.
class NeckSearch {
 public:
  /// `of_vessels`: the largest share of a dome's vertices that may lie on a vessel; `widest`: the largest tilt, rad.
  NeckSearch(const Vessel& v, const std::vector<double>& radii, double of_vessels, double widest)
      : v_(v), radii_(radii), of_vessels_(of_vessels), widest_(widest), next_(neighbours(v.wall.mesh)) {
    first_ = {v.neck->centre, v.neck->normal};
    for (const Vec3& p : v.centrelines.back().curve.points) top_ = std::max(top_, height(p, first_));
    u_ = first_.normal.unitOrthogonal(), w_ = first_.normal.cross(u_);
  }
  NeckPlane plane_of(const TiltedPlane& s) const {
    const Vec3 n = (first_.normal + std::tan(s.tilt_a) * u_ + std::tan(s.tilt_b) * w_).normalized();
    return NeckPlane{first_.centre + s.up * first_.normal, n};
  }
  /// The best plane of a grid at each height where one parts a dome, the cheapest first.
  std::vector<TiltedPlane> starts() const {
    std::vector<TiltedPlane> out;
    const double step = 0.5 * widest_;
    for (double up = lowest; up < highest + 0.05; up += 0.05) {  // the plane of what bulges may still touch a branch
      TiltedPlane best{};
      for (int a = -2; a <= 2; ++a)
        for (int b = -2; b <= 2; ++b)
          if (const TiltedPlane s = judged({up * top_, a * step, b * step}); cheaper(s, best)) best = s;
      if (best.cost < 1e299) out.push_back(best);
    }
    std::sort(out.begin(), out.end(), cheaper);
    return out;
  }
  /// Pattern search.
  TiltedPlane improved(TiltedPlane best) const {
    for (const double step : {1.0, 0.5, 0.25})
      for (bool moved = true; moved;) {
        moved = false;
        for (const TiltedPlane d : {TiltedPlane{0.1 * top_ * step, 0, 0},
                                    {-0.1 * top_ * step, 0, 0},
                                    {0, 0.12 * step, 0},
                                    {0, -0.12 * step, 0},
                                    {0, 0, 0.12 * step},
                                    {0, 0, -0.12 * step}}) {
          const TiltedPlane s{best.up + d.up, best.tilt_a + d.tilt_a, best.tilt_b + d.tilt_b};
          if (s.up < lowest * top_ || s.up > highest * top_ || std::hypot(s.tilt_a, s.tilt_b) > 1.5 * widest_) continue;
          if (const TiltedPlane to = judged(s); cheaper(to, best)) best = to, moved = true;
        }
      }
    return best;
  }

 private:
  static constexpr double lowest = -0.15, highest = 0.45;  ///< of the dome's height

  TiltedPlane judged(TiltedPlane s) const {
    const TriMesh& m = v_.wall.mesh;
    Loop loop;
    const std::vector<int> dome = dome_beyond(m, next_, plane_of(s), loop);
    s.cost = 1e300;
    if (dome.size() < min_sac_vertices || holds_a_cap(v_.wall, dome)) return s;
    const auto of_vessels =
        std::count_if(dome.begin(), dome.end(), [&](int i) { return radii_[std::size_t(i)] < of_a_vessel; });
    if (double(of_vessels) > of_vessels_ * double(dome.size())) return s;
    s.cost = loop.area * (1 + 0.5 * std::abs(s.up) / top_);  // every dome is narrower at its top: going there costs
    return s;
  }

  const Vessel& v_;
  const std::vector<double>& radii_;
  double of_vessels_, widest_;
  std::vector<std::vector<int>> next_;
  NeckPlane first_;
  double top_ = 0;
  Vec3 u_, w_;
};

}  // namespace

std::optional<NeckPlane> narrowest_neck(const Vessel& v, const std::vector<double>& radii) {
  struct Freedom {
    double of_vessels, widest;
  };
  // A branch that leaves at the neck's edge, or runs beside the dome, needs more of it.
  for (const auto& [of_vessels, widest] : {Freedom{0.02, 0.4}, {0.1, 0.8}}) {
    const NeckSearch search(v, radii, of_vessels, widest);
    std::vector<TiltedPlane> all = search.starts();
    if (all.empty()) continue;
    all.resize(std::min<std::size_t>(all.size(), 4));
    for (TiltedPlane& s : all) s = search.improved(s);
    return search.plane_of(*std::min_element(all.begin(), all.end(), cheaper));
  }
  return std::nullopt;
}

}  // namespace insula::artery
