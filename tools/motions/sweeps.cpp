// SPDX-License-Identifier: GPL-3.0-or-later
// Search over shaft directions, depths and senses, scored by room, by what else is cut, and by the length of the path.
#include "tools/motions/sweeps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/collision/shapes/closest.h"

namespace insula {

SweepPlanner::SweepPlanner(const ToolModel& tool, const Field& field, double reach, double cut_length)
    : edges_(tool.blade_edges), field_(field), reach_(reach), cut_length_(cut_length) {
  constexpr double blade = 0.2e-3;
  for (const auto& e : edges_) {
    const int n = std::max(1, int(std::ceil((e[1] - e[0]).norm() / 0.6e-3)));
    for (int i = 0; i < n; ++i) balls_.push_back({e[0] + double(i) / n * (e[1] - e[0]), blade});
  }
  for (const ConvexPiece& p : tool.pieces)
    if (p.points.size() == 2) {  // a capsule of the shaft
      const int n = int(std::ceil((p.points[1] - p.points[0]).norm() / 1e-3));
      for (int i = 0; i <= n; ++i)
        balls_.push_back({p.points[0] + double(i) / n * (p.points[1] - p.points[0]), p.radius});
    }
}

double SweepPlanner::room(const Pose& pose, double* vessel, double* others) const {
  double least[2] = {Clearance::band, Clearance::band};
  for (const Ball& b : balls_) {
    const Vec3 p = pose.apply(b.at);
    least[0] = std::min(least[0], field_.vessel->at(p) - b.radius);
    least[1] = std::min(least[1], field_.others->at(p) - b.radius);
  }
  if (vessel) *vessel = std::min(*vessel, least[0]);
  if (others) *others = std::min(*others, least[1]);
  return std::min(least[0], least[1]);
}

double SweepPlanner::room(const Pose& from, const Pose& to) const {
  const int n = std::max(1, int(std::ceil((to.p - from.p).norm() / 0.5e-3)));
  double least = Clearance::band;
  for (int i = 0; i <= n; ++i) {
    const double s = double(i) / n;
    least = std::min(least, room(Pose{from.p + s * (to.p - from.p), from.q.slerp(s, to.q).normalized()}));
  }
  return least;
}

double SweepPlanner::cutting(const Sweep& sweep, const StrandState& strand) const {
  const Vec3 axis = (strand.b - strand.a).normalized();
  const double share = (sweep.across - sweep.across.dot(axis) * axis).norm();  // motion along a strand cuts nothing
  constexpr double step = 0.1e-3;
  double travel = 0;
  for (double o = -sweep.half; o <= sweep.half; o += step) {
    const Pose pose = sweep.pose(o);
    double least = 1;
    for (const auto& e : edges_) {
      double s, t;
      const Vec3 e0 = pose.apply(e[0]), e1 = pose.apply(e[1]);
      closest_segments(strand.a, strand.b, e0, e1, s, t);
      least = std::min(least, (strand.a + s * (strand.b - strand.a) - e0 - t * (e1 - e0)).norm());
    }
    if (least < 0.75 * reach_) travel += share * step;  // the last quarter of the reach is a margin
  }
  return travel / cut_length_;
}

// Candidate directions of the shaft: the usual lean, and rings of directions around it.
std::vector<Vec3> SweepPlanner::shafts(bool thorough) const {
  std::vector<Vec3> out{field_.lean};
  const Vec3 side = field_.lean.unitOrthogonal(), up = field_.lean.cross(side);
  for (const double tilt : thorough ? std::vector<double>{12, 24, 36, 48} : std::vector<double>{12, 24})
    for (int k = 0; k < 6; ++k) {
      const double t = tilt * std::numbers::pi / 180, a = (k + tilt / 24) * std::numbers::pi / 3;
      out.push_back(std::cos(t) * field_.lean + std::sin(t) * (std::cos(a) * side + std::sin(a) * up));
    }
  return out;
}

// Scores each strand without regard to obstacles. Strands near the surgeon, near the tip and with few tries score high.
std::vector<double> SweepPlanner::reachability(const std::vector<StrandState>& strands, const std::vector<int>& tries,
                                               const Vec3& tip) const {
  std::vector<double> out;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    const Vec3 middle = (strands[i].a + strands[i].b) / 2;
    out.push_back((middle - field_.centre).dot(field_.outward) / 2e-3 - (middle - tip).norm() / 4e-3 - 1.5 * tries[i]);
  }
  return out;
}

// Judges all candidate sweeps through one strand with one shaft, and updates the best sweep.
void SweepPlanner::try_shaft(const Search& search, std::size_t i, const Vec3& shaft, Sweep& best) const {
  const StrandState& s = search.strands[i];
  const Vec3 across = (s.b - s.a).normalized().cross(shaft);
  const bool end_on = across.norm() < 0.35;
  for (int turn = 0; turn < (end_on ? 4 : search.thorough ? 3 : 1); ++turn)
    for (const double along : search.positions)
      for (const double depth : search.depths)
        for (const double signed_half : {2.2e-3, -2.2e-3, 1.6e-3, -1.6e-3}) {
          Sweep w;
          w.strand = int(i);
          w.shaft = shaft;
          const double askew = end_on ? turn * std::numbers::pi / 4 : (turn == 2 ? -1 : turn) * std::numbers::pi / 6;
          w.across = Eigen::AngleAxisd(askew, shaft) * (end_on ? shaft.unitOrthogonal() : Vec3(across.normalized()));
          w.across *= signed_half > 0 ? 1 : -1;
          // The blade is curved, so at this height its edge is slightly beside the tool's axis.
          const Vec3 flat = w.across.cross(shaft);
          w.middle = s.a + along * (s.b - s.a) - depth * shaft + 0.15e-3 * flat;
          w.half = std::abs(signed_half);
          judge(search, w, best);
        }
}

// Keeps a sweep as the best if its clearance suffices and its score is higher.
void SweepPlanner::judge(const Search& search, Sweep& w, Sweep& best) const {
  w.vessel = w.others = Clearance::band;
  for (int k = -3; k <= 3; ++k) room(w.pose(k * w.half / 3), &w.vessel, &w.others);
  if (w.vessel < -0.1e-3 || w.others < -search.press) return;
  const std::size_t i = std::size_t(w.strand);
  // Clearance above a comfortable value adds no score.
  double score = 2.5 * std::min(w.vessel, 0.5e-3) / 0.5e-3 + std::min(w.others, 0.3e-3) / 0.3e-3;
  score += search.reachability[i] - 4 * (1 - w.shaft.dot(field_.lean)) +
           (w.half > 2e-3 ? 0.5 : 0);  // a long stroke divides the strand reliably
  if (score + 1.5 < best.score || cutting(w, search.strands[i]) < 1.5) return;
  int more = 0;
  for (std::size_t k = 0; k < search.strands.size(); ++k) {
    const StrandState& other = search.strands[k];
    if (k != i && other.integrity >= 0 && ((other.a + other.b) / 2 - w.middle).norm() < 4e-3)
      more += cutting(w, other) > 1.5;
  }
  w.score = score + 0.5 * std::min(more, 3);
  if (w.score > best.score) best = w;
}

Sweep SweepPlanner::best(const std::vector<StrandState>& strands, const std::vector<int>& tries, const Vec3& tip,
                         bool thorough) const {
  Search search{strands, reachability(strands, tries, tip), thorough};
  if (thorough) {
    search.positions = {0.5, 0.3, 0.7, 0.15, 0.85, 0.05, 0.95};
    search.depths = {0.2e-3, -0.15e-3, -0.35e-3, 0.7e-3, 1.4e-3};
    search.press = 1.0e-3;
  }
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < strands.size(); ++i)
    if (strands[i].integrity >= 0) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return search.reachability[a] != search.reachability[b] ? search.reachability[a] > search.reachability[b] : a < b;
  });
  const std::vector<Vec3> all_shafts = shafts(thorough);
  Sweep best;
  for (std::size_t n = 0; n < order.size() && (n < 8 || best.strand < 0); ++n)
    for (const Vec3& shaft : all_shafts) try_shaft(search, order[n], shaft, best);
  return best;
}

}  // namespace insula
