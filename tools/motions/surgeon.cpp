// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/motions/surgeon.h"

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "plugins/strand_springs/strand_springs.h"

namespace insula {
namespace {

constexpr double mm = 1e-3;
constexpr double pulse = 0.1e-3;  // m, that a wall may come nearer with the next beat

}  // namespace

Surgeon::Surgeon(Simulation& simulation)
    : simulation_(simulation),
      hands_(simulation),
      artery_(find()),
      vessel_(centre_ - Vec3::Constant(11 * mm), centre_ + Vec3::Constant(11 * mm), 0.3 * mm),
      others_(centre_ + Vec3(-13, -24, -24) * mm, centre_ + Vec3(42, 30, 28) * mm, 0.5 * mm),
      planner_(simulation.instrument_of(1)->tool(), {centre_, outward_, lean_, &vessel_, &others_}, 0.6 * mm,
               0.8 * mm) {
  hands_.wait(0.1);
  look();
}

std::vector<int> Surgeon::out_of_reach() const {
  std::vector<int> out;
  for (std::size_t i = 0; i < strands().size(); ++i)
    if (const Sweep s = planner_.best({strands()[i]}, {0}, centre_ + 8 * mm * outward_, true);
        s.strand < 0 || s.vessel < pulse)
      out.push_back(int(i));
  return out;
}

int Surgeon::divide(const Pace& pace, const std::function<void(const Sweep&, int)>& told) {
  for (StrandSprings* s : simulation_.scene().all<StrandSprings>()) {
    s->cut_length.set(1.5 * s->cut_length());
    s->reach.set(0.8 * s->reach());
  }
  const Pose left_home = hands_.left().pose, right_home = hands_.right().pose;
  Wish left = left_rest(), right{tool_pose(centre_ + 16 * mm * outward_ + Vec3(0, 6, 0) * mm, lean_, Vec3::UnitZ())};
  hands_.move(pace.enter, left, right);
  add_tool(*simulation_.instrument_of(0));
  std::vector<int> tries(strands().size(), 0);
  bool withdrawn = false;
  for (int n = 0; n < 150 && Strands(simulation_).left() > 0; ++n) {
    vessel_.clear();
    see(*artery_, vessel_);
    Sweep sweep = planner_.best(strands(), tries, hands_.right().pose.p);
    if (sweep.strand < 0 || tries[std::size_t(sweep.strand)] > 1) {  // look again, and closer
      others_.clear();
      look();
      if (!withdrawn) add_tool(*simulation_.instrument_of(0));
      sweep = planner_.best(strands(), tries, hands_.right().pose.p, true);
    }
    if (sweep.strand < 0 && !withdrawn) {  // perhaps the suction tube is in the path
      const Pose at = hands_.left().pose;
      hands_.move(0.8, {Pose{at.p + 25 * mm * (at.q * Vec3::UnitZ()), at.q}}, hands_.right());
      withdrawn = true;
      others_.clear();
      look();
      sweep = planner_.best(strands(), tries, hands_.right().pose.p, true);
    }
    if (sweep.strand < 0) break;
    const std::size_t strand = std::size_t(sweep.strand);
    const Vec3 tip = hands_.right().pose.p;
    const double sense = (sweep.pose(-sweep.half).p - tip).norm() <= (sweep.pose(sweep.half).p - tip).norm() ? 1 : -1;
    go({sweep.pose(-sense * sweep.half)}, pace);
    for (const int stroke : {1, -1, 1}) {
      hands_.move(pace.stroke + pace.stroke_per_m * sweep.half,
                  {sweep.pose(stroke * sense * sweep.half)});  // more than parts it, should the arms lag
      if (pace.until_severed && strands()[strand].integrity < 0) break;
    }
    ++tries[strand];
    if (told) told(sweep, tries[strand]);
  }
  const Pose last = hands_.right().pose;
  hands_.move(0.8,
              {tool_pose(last.p + 9 * mm * (last.q * Vec3::UnitZ()), last.q * Vec3::UnitZ(), last.q * Vec3::UnitY())});
  hands_.move(pace.enter, {left_home}, {right_home});
  return Strands(simulation_).left();
}

Vec3 Surgeon::middle_of(const std::string& region) const {
  const WallModel& m = artery_->model();
  Vec3 sum = Vec3::Zero();
  int n = 0;
  for (int v = 0; v < artery_->nodes(); ++v)
    if (m.regions[std::size_t(m.vertex_region[std::size_t(v)])] == region) sum += artery_->q().segment<3>(3 * v), ++n;
  if (n == 0) throw InputError("the vessel has no " + region);
  return sum / n;
}

const ShellBody* Surgeon::find() {
  for (const Body* b : simulation_.bodies())
    if (const auto* shell = dynamic_cast<const ShellBody*>(b)) {
      artery_ = shell;
      centre_ = middle_of("sac");
      const Vec3 eye = simulation_.view()->eye();
      outward_ = (eye - centre_).normalized();
      lean_ = (outward_ + 0.2 * Vec3::UnitY()).normalized();
      left_shaft_ = (outward_ - 0.35 * Vec3::UnitY() + 0.1 * Vec3::UnitZ()).normalized();
      return shell;
    }
  throw InputError("the scene has no vessel");
}

Wish Surgeon::left_rest() const {
  return {tool_pose(centre_ + 9 * mm * outward_ + Vec3(0, -7, 2) * mm, left_shaft_, Vec3::UnitZ())};
}

void Surgeon::see(const Body& body, Clearance& grid) {
  for (Surface* s : simulation_.surfaces())
    if (&s->body() == &body && s->contact()) {
      s->update();
      grid.add(s->positions(), s->triangles());
    }
}

void Surgeon::add_tool(const Instrument& tool) {
  for (const ToolPart& part : tool.tool().parts) {
    std::vector<Vec3> at = part.mesh.vertices;
    for (Vec3& v : at) v = tool.pose().apply(v);
    others_.add(at, part.mesh.triangles);
  }
}

void Surgeon::look() {
  for (const char* id : {"frontal", "temporal", "insula"})
    if (const Body* b = simulation_.scene().find_as<Body>(id)) see(*b, others_);
  for (const Instrument* tool : simulation_.instruments())
    if (tool->hand_index() < 0) add_tool(*tool);
  see(*artery_, vessel_);
}

void Surgeon::go(const Wish& to, const Pace& pace) {
  const Pose from = hands_.right().pose;
  const auto back = [](const Pose& p, double d) { return Pose{p.p + d * (p.q * Vec3::UnitZ()), p.q}; };
  const double enough = std::min({0.1 * mm, planner_.room(from), planner_.room(to.pose)}) - 0.02 * mm;
  double best = -1, most = -1;
  for (const double d : {0.0, 1.5 * mm, 3 * mm, 5 * mm, 8 * mm, 12 * mm}) {
    const double room = std::min({planner_.room(from, back(from, d)), planner_.room(back(from, d), back(to.pose, d)),
                                  planner_.room(back(to.pose, d), to.pose)});
    if (room > most) most = room, best = d;
    if (room >= enough) break;
  }
  const auto travel = [&](const Pose& p) {
    const double length = (p.p - hands_.right().pose.p).norm(), turn = p.q.angularDistance(hands_.right().pose.q);
    hands_.move(std::max({pace.at_least, length / pace.travel, turn / pace.turn}), {p});
  };
  if (best > 0) travel(back(from, best));
  if (best > 0) travel(back(to.pose, best));
  travel(to.pose);
}

}  // namespace insula
