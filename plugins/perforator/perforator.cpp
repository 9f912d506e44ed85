// SPDX-License-Identifier: GPL-3.0-or-later
/*
# perforator

A perforating artery: a thin vessel from an artery to the tissue behind it. A clip that closes on it stops its flow, and
the tissue that it feeds dies. It is therefore to be seen and spared before the blades close.

    <perforator id="lenticulostriate" from="artery_wall" to="insula_surface" start="46 15 -10 mm" end="43 16 -12 mm"/>

It is one fibre between two points of the surfaces: a compliant row that carries tension only,

    delta = |a - b| - slack |a - b|(0),   delta + lambda / stiffness = 0,   lambda <= 0.

It tears when its tension exceeds `strength`. Its course bends by `bulge` to one side and follows both ends. The blades
of a clip push the part of the course that lies between them to the middle of their slit. What else lies in the slit
keeps the blades apart by `occluded_slit` while the spring flattens the vessel. With the slit g, a vessel of diameter d
is open to the share (g - occluded_slit) / d between 0 and 1, and its flow follows Poiseuille's law: share^4.

A blade that comes from the side pushes the fibre only through this capture, not through contact. The fibre is too thin
to resist it.

Sources: Rhoton 2002 (lenticulostriate arteries: 0.3 to 0.5 mm wide); Marinkovic et al. 1985.
*/
#include "plugins/perforator/perforator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mechanics/body.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

/// The vertex of a surface that is nearest to p at rest, as a material point.
const MaterialPoint& nearest_point(const Surface& surface, const Vec3& p) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto& all = surface.rest().vertices;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const double d = (all[i] - p).squaredNorm(); d < least) least = d, best = i;
  return surface.points()[best];
}

}  // namespace

void Perforator::connect(PrepareContext& context, Simulation& simulation) {
  clips_ = Clips(simulation);
  if ((start() - end()).norm() < diameter()) return error(context, end, "lies at its start");
  a_ = nearest_point(*from, start());
  b_ = nearest_point(*to, end());
  rest_ = slack() * (a_.body->position(a_) - b_.body->position(b_)).norm();
  const Vec3 chord = end() - start();
  side_ = bulge() - bulge().dot(chord) / chord.squaredNorm() * chord;
  reset();
}

Vec3 Perforator::on_course(double s) const {
  const Vec3 a = a_.body->position(a_), b = b_.body->position(b_);
  return (1 - s) * a + s * b + 4 * s * (1 - s) * side_;
}

void Perforator::reset() {
  torn_ = false;
  pull_ = 0;
  share_ = 1;
  caught_ = false;
  holder_.fill(-1);
  for (int k = 0; k < points; ++k) at_[std::size_t(k)] = on_course(double(k) / (points - 1));
}

void Perforator::build(const StepContext&, ConstraintBuilder& builder) {
  row_ = -1;
  if (torn_) return;
  const Vec3 d = a_.body->position(a_) - b_.body->position(b_);
  const double length = d.norm();
  if (!(length > 1e-9)) return;
  Block block;
  block.id = row_id(*this, 0);
  block.role = BlockRole::fibre;
  block.compliance = 1 / stiffness();
  block.upper = 0;
  row_ = builder.add(block);
  builder.violation(row_, length - rest_);
  builder.point(row_, a_, d / length);
  builder.point(row_, b_, -d / length);
}

void Perforator::finish(const StepContext& context, const ConstraintSolution& solution) {
  if (torn_) return;
  pull_ = row_ >= 0 ? -solution.lambda[row_] : 0;
  const double end = context.time + context.h;
  if (pull_ > strength()) {
    torn_ = true;
    share_ = 0;
    if (context.events) context.events->emit({tear.name(), id, "", pull_, end, -1});
    pull_ = 0;
    return;
  }
  catch_between_blades();
  const bool shut = share_ < 0.5;
  if (shut && !caught_ && context.events) context.events->emit({occlusion.name(), id, "", flow_share(), end, -1});
  caught_ = shut;
}

/// Each point of the course that lies within the width of a clip's blades and between them stays between them until the
/// clip opens or leaves.
void Perforator::catch_between_blades() {
  const std::vector<ClipState>& clips = clips_.now();
  share_ = 1;
  for (int k = 0; k < points; ++k) {
    const std::size_t i = std::size_t(k);
    at_[i] = on_course(double(k) / (points - 1));
    int held_by = -1;
    for (std::size_t c = 0; c < clips.size() && held_by < 0; ++c) {
      const ClipState& clip = clips[c];
      if (clip.on_tray) continue;
      const Vec3 x = clip.local(at_[i]);
      const double half_slit = 0.5 * clip.gap, across = across_blades(clip, x);
      if (!std::isfinite(across)) continue;
      const bool was = holder_[i] == int(c);
      if (std::abs(across) > half_slit + (was ? 1e300 : 0.5 * diameter())) continue;
      held_by = int(c);
      share_ = std::min(share_, std::max(0.0, clip.gap - occluded_slit()) / diameter());
      const double inside = std::clamp(across, -half_slit, half_slit);
      at_[i] += clip.pose.q * ((inside - across) * clip.normal);
    }
    holder_[i] = held_by;
  }
}

/// Distance of a point from the middle of the slit along the blades' normal, in the clip's frame, m. Infinite for a
/// point beside the blades.
double Perforator::across_blades(const ClipState& clip, const Vec3& x) const {
  std::array<Vec3, 2> ends;
  const std::span<const Vec3> line = clip.clamping_line(ends);
  double least = std::numeric_limits<double>::infinity(), across = least;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vec3 along = line[k + 1] - line[k];
    const Vec3 flat = along - along.dot(clip.normal) * clip.normal;
    const bool last = k + 2 == line.size();
    const double s = (x - line[k]).dot(flat) / flat.squaredNorm(), t = std::clamp(s, 0.0, 1.0);
    if ((k == 0 && s < 0) || (last && s > 1)) continue;  // the blades end here
    const Vec3 d = x - line[k] - t * along;
    const double normal = d.dot(clip.normal), beside = (d - normal * clip.normal).norm();
    if (beside > 0.5 * clip.blade_width || beside >= least) continue;
    least = beside;
    across = normal;
  }
  return across;
}

void Perforator::publish() {
  tension.set(pull_);
  flow.set(flow_share());
  course.resize(1);
  for (int k = 0; k < points; ++k) course.set(0, std::size_t(k), at_[std::size_t(k)], torn_ ? -1 : flow_share());
}

void Perforator::append_state(std::vector<double>& out) const {
  out.insert(out.end(), {double(torn_), share_});
  for (int c : holder_) out.push_back(c);
}

StatedLaw Perforator::law() const {
  const double stretch = (a_.body->position(a_) - b_.body->position(b_)).norm() - rest_;
  return StatedLaw::potential(torn_ || stretch <= 0 ? 0.0 : 0.5 * stiffness() * stretch * stretch);
}

}  // namespace insula

INSULA_PLUGIN(perforator) {
  registry.add<insula::Perforator>("perforator", insula::Kind::constraint,
                                   "thin artery that a clip must spare: tears, and is shut between blades");
}
