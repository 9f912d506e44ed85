// SPDX-License-Identifier: GPL-3.0-or-later
// Loading and driving example scenes.
#include "core/testing/example.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace insula::test {

namespace {
Registry& registry() {
  static Registry all = [] {
    Registry r;
    register_builtin(r);
    return r;
  }();
  return all;
}
}  // namespace

const Registry& builtin() { return registry(); }
std::string add_plugin(const std::filesystem::path& library) { return load_plugin(registry(), library); }

void add_elements(void (*add)(Registry&)) { add(registry()); }

namespace {
std::unique_ptr<Simulation> take(SimulationResult result) {
  if (!result.diagnostics.all().empty()) ADD_FAILURE() << result.diagnostics.format();
  return std::move(result.simulation);
}
}  // namespace

std::unique_ptr<Simulation> load(const std::filesystem::path& file, int threads) {
  return take(load_simulation(file, builtin(), threads));
}

std::unique_ptr<Simulation> load_text(const std::string& xml, const std::filesystem::path& virtual_path, int threads) {
  return take(load_simulation_text(xml, virtual_path, builtin(), threads));
}

void drive(Simulation& simulation) {
  const double t = std::min(simulation.time() + simulation.h(), script_length);
  const double in = std::min(1.0, 2 * t), across = t > 0.5 ? std::sin(2 * 3.14159265358979323846 * (t - 0.5)) : 0.0;
  for (int hand = 0; hand < 2; ++hand) {
    Instrument* tool = simulation.instrument_of(hand);
    if (!tool) continue;
    HandState state;
    state.present = true;
    state.device = tool->home_pose();
    const Mat3 axes = state.device.q.toRotationMatrix();
    state.device.p += -0.005 * in * axes.col(2) + 0.002 * across * axes.col(1);
    state.device.q = (Quat(Eigen::AngleAxisd(0.1 * across, axes.col(0))) * state.device.q).normalized();
    state.button1 = t > 0.2;
    simulation.set_hand(hand, state);
  }
}

void run_script(Simulation& simulation, int n) {
  for (int i = 0; i < n; ++i) {
    drive(simulation);
    simulation.step();
  }
}

double shortest_edge(const DeformableBody& body) {
  double edge = 1;
  const auto take = [&](const auto& cells) {
    for (const auto& cell : cells)
      for (std::size_t i = 0; i < cell.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          edge = std::min(edge,
                          (body.rest_nodes()[std::size_t(cell[i])] - body.rest_nodes()[std::size_t(cell[j])]).norm());
  };
  if (const auto* soft = dynamic_cast<const SoftBody*>(&body)) take(soft->rest().tets);
  if (const auto* shell = dynamic_cast<const ShellBody*>(&body)) take(shell->rest().triangles);
  return edge;
}

VecX deformed(const DeformableBody& body, double strain, std::uint64_t seed) {
  Random random(seed);
  const auto any = [&] { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  Vec3 low = body.rest_nodes().front(), high = low;
  for (const Vec3& x : body.rest_nodes()) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double size = (high - low).norm();
  const Vec3 centre = 0.5 * (low + high);
  const Quat turn = from_rotation_vector(2 * any());
  Mat3 stretch;
  stretch << any(), any(), any();
  const Vec3 bend = any(), shift = size * any();
  // Noise must not turn small elements inside out: scaled by the shortest edge.
  const double edge = std::min(size, shortest_edge(body));
  VecX q(3 * body.nodes());
  for (int i = 0; i < body.nodes(); ++i) {
    const Vec3 r = body.rest_nodes()[std::size_t(i)] - centre;
    Vec3 x = r + strain * stretch * r + strain * (r.squaredNorm() / size) * bend + 0.3 * strain * edge * any();
    q.segment<3>(3 * i) = centre + shift + turn * x;
  }
  return q;
}

}  // namespace insula::test
