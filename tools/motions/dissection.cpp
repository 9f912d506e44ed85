// SPDX-License-Identifier: GPL-3.0-or-later
/*
Writes the two scripted motions of exercise 2 by operating in its scene:

    cmake -B build -DINSULA_BUILD_TOOLS=ON && ninja -C build dissection_motions
    build/bin/dissection_motions scenes/training/2_aneurysm_dissection.xml scenes/training

steady  steers the dissector to the nearest and outermost strand, turns the blade across it and sweeps it forth and
        back, with room to the vessel and the lobes measured on grids of distances, until no strand stands;
rough   shoves the sac aside until strands tear, leans on the frontal lobe and presses the blade into the bleb until it bursts.

Then each motion is played once more through both simulated arms, as `insula run` does it, and its outcome printed. The same
scene gives the same files on the same processor (see docs/one-step.md on bits).
*/
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/input_error.h"
#include "core/mechanics/shell_body.h"
#include "plugins/strand_springs/strand_springs.h"
#include "tools/motions/dissection_play.h"
#include "tools/motions/sweeps.h"

namespace insula {
namespace {

constexpr double mm = 1e-3;

class Surgeon {
 public:
  explicit Surgeon(const fs::path& scene)
      : simulation_(load(scene)), hands_(*simulation_), artery_(find()), vessel_(centre_ - Vec3::Constant(11 * mm), centre_ + Vec3::Constant(11 * mm), 0.3 * mm),
        others_(centre_ + Vec3(-13, -24, -24) * mm, centre_ + Vec3(42, 30, 28) * mm, 0.5 * mm),
        planner_(simulation_->instrument_of(1)->tool(), {centre_, outward_, lean_, &vessel_, &others_}, 0.6 * mm, 0.8 * mm) {
    hands_.wait(0.1);  // the first report names the strands
    look();
  }

  void steady(const fs::path& file) {
    // Rehearsed on tougher strands than the scene's, so that each is divided with room to spare.
    for (const char* id : {"to_frontal", "to_temporal", "to_branches"})
      if (auto* s = simulation_->scene().find_as<StrandSprings>(id)) {
        s->cut_length.set(1.5 * s->cut_length());
        s->reach.set(0.8 * s->reach());
      }
    const Pose left_home = hands_.left().pose, right_home = hands_.right().pose;
    Wish left = left_rest(), right{tool_pose(centre_ + 16 * mm * outward_ + Vec3(0, 6, 0) * mm, lean_, Vec3::UnitZ())};
    hands_.move(2.2, left, right);
    add_tool(0);
    std::vector<int> tries(strands().size(), 0);
    for (int n = 0; n < 150 && simulation_->report().strands_left > 0; ++n) {
      vessel_.clear();
      see(*artery_, vessel_);
      Sweep sweep = planner_.best(strands(), tries, hands_.right().pose.p);
      if (sweep.strand < 0 || tries[std::size_t(sweep.strand)] > 1) {  // look again, and closer
        others_.clear();
        look();
        add_tool(0);
        sweep = planner_.best(strands(), tries, hands_.right().pose.p, true);
      }
      if (sweep.strand < 0) say_left();
      if (sweep.strand < 0) throw InputError(fmt::format("{} strands are out of reach", simulation_->report().strands_left));
      const Vec3 tip = hands_.right().pose.p;
      const double way = (sweep.pose(-sweep.half).p - tip).norm() <= (sweep.pose(sweep.half).p - tip).norm() ? 1 : -1;
      go({sweep.pose(-way * sweep.half)});
      for (const int stroke : {1, -1, 1}) hands_.move(0.25 + 110 * sweep.half, {sweep.pose(stroke * way * sweep.half)});  // more than parts it, should the arms lag
      ++tries[std::size_t(sweep.strand)];
      std::printf("%6.2f s strand %2d  room vessel %5.2f others %5.2f mm  %d stand, tries %d\n", hands_.time(), sweep.strand, sweep.vessel / mm,
                  sweep.others / mm, simulation_->report().strands_left, tries[std::size_t(sweep.strand)]);
    }
    const Pose last = hands_.right().pose;
    hands_.move(0.8, {tool_pose(last.p + 9 * mm * (last.q * Vec3::UnitZ()), last.q * Vec3::UnitZ(), last.q * Vec3::UnitY())});
    hands_.move(2.2, {left_home}, {right_home});
    hands_.write(file);
  }

  /// Says of each strand whether a sweep reaches it as it stands at the start.
  void reach() {
    std::vector<StrandState> one;
    for (std::size_t i = 0; i < strands().size(); ++i) {
      one.assign(1, strands()[i]);
      const Sweep w = planner_.best(one, {0}, centre_ + 8 * mm * outward_);
      const Vec3 m = ((one[0].a + one[0].b) / 2 - centre_) / mm;
      std::printf("strand %2zu  length %.1f  at %5.1f %5.1f %5.1f mm from the sac, depth %4.1f: %s  room vessel %5.2f others %5.2f mm\n", i,
                  (one[0].a - one[0].b).norm() / mm, m.x(), m.y(), m.z(), -m.dot(outward_), w.strand < 0 ? "OUT OF REACH" : "reached", w.vessel / mm, w.others / mm);
    }
  }

  void rough(const fs::path& file) {
    Wish left = left_rest(), right{tool_pose(centre_ + 12 * mm * outward_ + Vec3(0, 4, 0) * mm, lean_, Vec3::UnitZ())};
    hands_.move(1.2, left, right);
    // The suction tube shoves the sac away from the frontal lobe: strands between them tear.
    const Vec3 aside = Vec3(0, -1, -0.6).normalized();
    const int before = simulation_->report().strands_left;
    press(0, left_shaft_, aside, [&] { return middle_of("sac"); }, 5 * mm, [&] { return simulation_->report().strands_left <= before - 4; });
    hands_.wait(0.3);
    hands_.move(0.7, left, right);
    // The dissector leans on the frontal lobe.
    const Body* frontal = simulation_->scene().find_as<Body>("frontal");
    if (!frontal) throw InputError("the scene has no frontal lobe");
    const MaterialPoint at = nearest(*frontal, centre_ + Vec3(4, 5, 0) * mm);
    double over = 0;
    press(1, lean_, Vec3(-0.2, 1, 0.1).normalized(), [&] { return frontal->position(at); }, 10 * mm, [&] {
      over = force(1, *frontal) > 0.24 ? over + 0.05 : 0;
      return over > 0.2;
    });
    hands_.wait(0.2);
    hands_.move(0.6, right);
    // And presses the bleb with the flat of the blade.
    const Vec3 out = (middle_of("bleb") - middle_of("sac")).normalized(), shaft = (outward_ - 0.35 * Vec3::UnitY()).normalized();
    press(1, shaft, -out, [&] { return middle_of("bleb"); }, 9 * mm, [&] {
      const auto& b = simulation_->report().bleeding;
      return std::any_of(b.begin(), b.end(), [](const BleedingState& x) { return x.open; });
    }, shaft.cross(out));
    hands_.move(0.7, right);
    hands_.wait(1);
    hands_.write(file);
  }

 private:
  const std::vector<StrandState>& strands() const { return simulation_->report().strands; }

  void say_left() const {
    for (std::size_t i = 0; i < strands().size(); ++i)
      if (const StrandState& s = strands()[i]; s.health >= 0) {
        const Vec3 a = (s.a - centre_) / mm, b = (s.b - centre_) / mm;
        std::printf("strand %2zu stands: %.1f mm from (%.1f %.1f %.1f) to (%.1f %.1f %.1f) mm from the sac\n", i, (a - b).norm(), a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
      }
  }
  /// Force of a hand's tool on a body, N.
  double force(int hand, const Body& body) const {
    const Body* tool = simulation_->instrument_of(hand);
    Vec3 sum = Vec3::Zero();
    for (const ContactPoint& c : simulation_->report().contacts) {
      const double sign = c.a == tool && c.b == &body ? 1 : c.b == tool && c.a == &body ? -1 : 0;
      sum += sign * (c.normal_force * c.normal + c.tangent_force);
    }
    return sum.norm();
  }
  /// Leans with a tool on a place that gives way: the hand goes from 5 mm before it to `most` behind it, wherever it is by
  /// then, until `enough`.
  template <class Place, class Enough>
  void press(int hand, const Vec3& shaft, const Vec3& way, Place place, double most, Enough enough, const Vec3& across = Vec3::UnitZ()) {
    const auto go_to = [&](double seconds, double depth) {
      Wish w[2] = {hands_.left(), hands_.right()};
      w[hand].pose = tool_pose(place() + depth * way, shaft, across);
      hands_.move(seconds, w[0], w[1]);
    };
    double depth = -5 * mm, vessel = 0, lobe = 0;
    go_to(0.8, depth);
    bool done = false;
    for (; depth < most && !done; depth += 0.6 * mm) {
      go_to(3 * simulation_->h(), depth);
      vessel = std::max(vessel, force(hand, *artery_));
      if (const Body* b = simulation_->scene().find_as<Body>("frontal")) lobe = std::max(lobe, force(hand, *b));
      done = enough();
    }
    if (done) go_to(0.25, depth + 1.5 * mm);  // enough also where the arms follow a little differently
    std::printf("%6.2f s pressed to %.1f mm: %s; up to %.3f N on the vessel, %.3f N on the frontal lobe, %d strands stand\n", hands_.time(), depth / mm,
                done ? "done" : "as far as it goes", vessel, lobe, simulation_->report().strands_left);
  }
  /// Mean of a region's vertices as they lie now.
  Vec3 middle_of(const std::string& region) const {
    const VesselModel& m = artery_->model();
    Vec3 sum = Vec3::Zero();
    int n = 0;
    for (int v = 0; v < artery_->nodes(); ++v)
      if (m.regions[std::size_t(m.vertex_region[std::size_t(v)])] == region) sum += artery_->q().segment<3>(3 * v), ++n;
    if (n == 0) throw InputError("the vessel has no " + region);
    return sum / n;
  }
  MaterialPoint nearest(const Body& body, const Vec3& at) const {
    MaterialPoint out;
    double least = 1;
    for (Surface* s : simulation_->surfaces())
      if (&s->body() == &body)
        for (const MaterialPoint& p : s->points())
          if (const double d = (body.position(p) - at).norm(); d < least) least = d, out = p;
    return out;
  }

  const ShellBody* find() {
    for (const Body* b : simulation_->bodies())
      if (const auto* shell = dynamic_cast<const ShellBody*>(b)) {
        artery_ = shell;
        centre_ = middle_of("sac");
        const Vec3 eye = simulation_->view()->eye();
        outward_ = (eye - centre_).normalized();
        lean_ = (outward_ + 0.2 * Vec3::UnitY()).normalized();
        left_shaft_ = (outward_ - 0.35 * Vec3::UnitY() + 0.1 * Vec3::UnitZ()).normalized();
        return shell;
      }
    throw InputError("the scene has no vessel");
  }
  /// The suction tube waits beside the sac, on the left.
  Wish left_rest() const { return {tool_pose(centre_ + 9 * mm * outward_ + Vec3(0, -7, 2) * mm, left_shaft_, Vec3::UnitZ())}; }

  void see(const Body& body, Clearance& grid) {
    for (Surface* s : simulation_->surfaces())
      if (&s->body() == &body && s->contact()) {
        s->update();
        grid.add(s->positions(), s->triangles());
      }
  }
  void add_tool(const Instrument& tool) {
    for (const ToolPart& part : tool.tool().parts) {
      std::vector<Vec3> at = part.mesh.vertices;
      for (Vec3& v : at) v = tool.pose().apply(v);
      others_.add(at, part.mesh.triangles);
    }
  }
  void add_tool(int hand) { add_tool(*simulation_->instrument_of(hand)); }
  void look() {
    for (const char* id : {"frontal", "temporal", "insula"})
      if (const Body* b = simulation_->scene().find_as<Body>(id)) see(*b, others_);
    for (const Instrument* tool : simulation_->instruments())
      if (tool->hand_index() < 0) add_tool(*tool);
    see(*artery_, vessel_);
  }

  /// To the start of a sweep: straight when there is room, else back along the shaft, across, and in again.
  void go(const Wish& to) {
    const Pose from = hands_.right().pose;
    const auto back = [](const Pose& p, double d) { return Pose{p.p + d * (p.q * Vec3::UnitZ()), p.q}; };
    const double enough = std::min({0.1 * mm, planner_.room(from), planner_.room(to.pose)}) - 0.02 * mm;
    double best = -1, most = -1;
    for (const double d : {0.0, 1.5 * mm, 3 * mm, 5 * mm, 8 * mm, 12 * mm}) {
      const double room = std::min({planner_.room(from, back(from, d)), planner_.room(back(from, d), back(to.pose, d)), planner_.room(back(to.pose, d), to.pose)});
      if (room > most) most = room, best = d;
      if (room >= enough) break;
    }
    const auto travel = [&](const Pose& p) {
      const double length = (p.p - hands_.right().pose.p).norm(), turn = p.q.angularDistance(hands_.right().pose.q);
      hands_.move(std::max({0.3, length / 0.016, turn / 2.2}), {p});
    };
    if (best > 0) travel(back(from, best));
    if (best > 0) travel(back(to.pose, best));
    travel(to.pose);
  }

  std::unique_ptr<Simulation> simulation_;
  Hands hands_;
  Vec3 centre_, outward_, lean_, left_shaft_;  ///< set by find()
  const ShellBody* artery_ = nullptr;
  Clearance vessel_, others_;
  SweepPlanner planner_;
};

}  // namespace
}  // namespace insula

int main(int count, char** arguments) {
  using namespace insula;
  if (count < 3) {
    std::fprintf(stderr, "usage: dissection_motions SCENE FOLDER [steady|rough|reach]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    const fs::path scene = arguments[1], stem = fs::path(arguments[2]) / scene.stem();
    if (count > 3 && arguments[3] == std::string("reach")) {
      Surgeon(scene).reach();
      return 0;
    }
    for (const std::string id : {"steady", "rough"}) {
      if (count > 3 && id != arguments[3]) continue;
      const fs::path file = stem.string() + "_" + id + ".csv";
      Surgeon surgeon(scene);
      id == "steady" ? surgeon.steady(file) : surgeon.rough(file);
      play(scene, file);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
