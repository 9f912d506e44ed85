// SPDX-License-Identifier: GPL-3.0-or-later
/*
Writes the two scripted motions of exercise 2 by operating in its scene:

    cmake -B build -DINSULA_BUILD_TOOLS=ON && ninja -C build dissection_motions
    build/bin/dissection_motions scenes/training/2_aneurysm_dissection.xml scenes/training

steady  steers the dissector to the nearest and outermost strand, turns the blade across it and sweeps it through, with room
        to the vessel and the lobes measured on grids of distances, until no strand stands;
rough   pushes the lobe aside until strands tear, leans on the sac and stabs the bleb.

Then each motion is played once more through both simulated arms, as `insula run` does it, and its outcome printed. The same
scene gives the same files on the same processor (see docs/one-step.md on bits).
*/
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/input_error.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "engine/headless.h"
#include "tools/motions/sweeps.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
constexpr double mm = 1e-3;

std::unique_ptr<Simulation> load(const fs::path& scene) {
  Registry registry;
  register_builtin(registry);
  SimulationResult loaded = load_simulation(scene, registry, 1);
  if (!loaded.simulation) throw InputError(loaded.diagnostics.format());
  return std::move(loaded.simulation);
}

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
    const Pose left_home = hands_.left().pose, right_home = hands_.right().pose;
    Wish left = left_rest(), right{tool_pose(centre_ + 16 * mm * outward_ + Vec3(0, 6, 0) * mm, lean_, Vec3::UnitZ())};
    hands_.move(2.2, left, right);
    add_tool(0);
    std::vector<int> tries(strands().size(), 0);
    for (int n = 0; n < 150 && simulation_->report().strands_left > 0; ++n) {
      vessel_.clear();
      see(*artery_, vessel_);
      const Sweep sweep = planner_.best(strands(), tries, hands_.right().pose.p);
      if (sweep.strand < 0) throw InputError(fmt::format("{} strands are out of reach", simulation_->report().strands_left));
      const Vec3 tip = hands_.right().pose.p;
      const double way = (sweep.pose(-sweep.half).p - tip).norm() <= (sweep.pose(sweep.half).p - tip).norm() ? 1 : -1;
      go({sweep.pose(-way * sweep.half)});
      hands_.move(0.32, {sweep.pose(way * sweep.half)});
      ++tries[std::size_t(sweep.strand)];
      std::printf("%6.2f s strand %2d  room vessel %5.2f others %5.2f mm  %d stand, tries %d\n", hands_.time(), sweep.strand, sweep.vessel / mm,
                  sweep.others / mm, simulation_->report().strands_left, tries[std::size_t(sweep.strand)]);
    }
    const Pose last = hands_.right().pose;
    hands_.move(0.8, {tool_pose(last.p + 9 * mm * (last.q * Vec3::UnitZ()), last.q * Vec3::UnitZ(), last.q * Vec3::UnitY())});
    hands_.move(2.2, {left_home}, {right_home});
    hands_.write(file);
  }

  void rough(const fs::path& file) {
    const Vec3 bleb = bleb_now();
    const Vec3 out = (bleb - centre_).normalized();
    Wish left = left_rest(), right{tool_pose(centre_ + 12 * mm * outward_ + Vec3(0, 4, 0) * mm, lean_, Vec3::UnitZ())};
    hands_.move(1.2, left, right);
    // The suction tube shoves the frontal lobe away: strands tear.
    const Vec3 lobe = centre_ + Vec3(1, 5, 3) * mm;
    hands_.move(0.6, {tool_pose(lobe, left_shaft_, Vec3::UnitZ())}, right);
    hands_.move(1.0, {tool_pose(lobe + Vec3(2, 9, 7) * mm, left_shaft_, Vec3::UnitZ())}, right);
    hands_.wait(0.6);
    hands_.move(0.8, left, right);
    // The dissector leans on the side of the sac ...
    const Vec3 side = centre_ - out.cross(outward_).normalized() * 3.2 * mm + 2 * mm * outward_;
    hands_.move(0.7, {tool_pose(side + 4 * mm * outward_, lean_, Vec3::UnitZ())});
    hands_.move(0.6, {tool_pose(centre_ + 0.5 * mm * outward_, lean_, Vec3::UnitZ())});
    hands_.wait(0.5);
    hands_.move(0.5, {tool_pose(side + 5 * mm * outward_, lean_, Vec3::UnitZ())});
    // ... and stabs the bleb.
    const Vec3 target = bleb_now();
    hands_.move(0.5, {tool_pose(target + 3 * mm * out, lean_, Vec3::UnitZ())});
    hands_.move(0.5, {tool_pose(target - 3 * mm * out, lean_, Vec3::UnitZ())});
    hands_.wait(0.5);
    hands_.move(0.6, {tool_pose(target + 12 * mm * outward_, lean_, Vec3::UnitZ())});
    hands_.wait(0.5);
    hands_.write(file);
  }

 private:
  const std::vector<StrandState>& strands() const { return simulation_->report().strands; }

  const ShellBody* find() {
    for (const Body* b : simulation_->bodies())
      if (const auto* shell = dynamic_cast<const ShellBody*>(b)) {
        const VesselModel& m = shell->model();
        Vec3 sum = Vec3::Zero();
        int n = 0;
        for (int v = 0; v < shell->nodes(); ++v)
          if (m.regions[std::size_t(m.vertex_region[std::size_t(v)])] == "sac") sum += shell->q().segment<3>(3 * v), ++n;
        if (n == 0) throw InputError("the vessel has no sac");
        centre_ = sum / n;
        const Vec3 eye = simulation_->view()->eye();
        outward_ = (eye - centre_).normalized();
        lean_ = (outward_ + 0.2 * Vec3::UnitY()).normalized();
        left_shaft_ = (outward_ - 0.35 * Vec3::UnitY() + 0.1 * Vec3::UnitZ()).normalized();
        return shell;
      }
    throw InputError("the scene has no vessel");
  }
  Vec3 bleb_now() const {
    const VesselModel& m = artery_->model();
    Vec3 far = centre_;
    for (int v = 0; v < artery_->nodes(); ++v)
      if (m.regions[std::size_t(m.vertex_region[std::size_t(v)])] == "bleb" &&
          (artery_->q().segment<3>(3 * v) - centre_).norm() > (far - centre_).norm())
        far = artery_->q().segment<3>(3 * v);
    return far;
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
      hands_.move(std::max({0.15, length / 0.022, turn / 3.0}), {p});
    };
    if (best > 0) travel(back(from, best));
    if (best > 0) travel(back(to.pose, best));
    travel(to.pose);
  }

  std::unique_ptr<Simulation> simulation_;
  Hands hands_;
  Vec3 centre_, outward_, lean_, left_shaft_;  ///< set by find()
  const ShellBody* artery_;
  Clearance vessel_, others_;
  SweepPlanner planner_;
};

/// Plays a motion as `insula run` does and says what came of it.
void play(const fs::path& scene, const fs::path& file) {
  const auto s = load(scene);
  const Motion motion = load_motion(file);
  HeadlessRun run(*s, motion);
  double press = 0;
  while (s->time() < motion.duration() + 0.5) {
    run.step();
    for (const ToolReport& t : s->report().tools)
      if (t.hand >= 0) press = std::max(press, t.contact_force);
  }
  std::printf("%s: %.1f s, %d of %d strands stand, largest contact force %.3f N\n", file.c_str(), motion.duration(), s->report().strands_left,
              s->report().strands_total, press);
  if (!s->exercise()) return;
  for (const GoalState& g : s->exercise()->log().goals()) std::printf("  goal %s %s %.1f s\n", g.id.c_str(), g.done ? "reached at" : "open", g.time);
  for (const FaultState& f : s->exercise()->log().faults()) std::printf("  fault %s %d\n", f.id.c_str(), f.count);
}

}  // namespace
}  // namespace insula

int main(int count, char** arguments) {
  using namespace insula;
  if (count < 3) {
    std::fprintf(stderr, "usage: dissection_motions SCENE FOLDER [steady|rough]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    const fs::path scene = arguments[1], stem = fs::path(arguments[2]) / scene.stem();
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
