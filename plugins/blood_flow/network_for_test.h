// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels with a network for tests. They are closed by moving the positions that the wall's springs pull to.
#pragma once
#include "core/sim/report.h"
#include "plugins/blood_flow/blood_flow.h"
#include "plugins/pressure/shell_for_test.h"

namespace insula::test {

inline constexpr double ml_min = 1e-6 / 60;  ///< m3/s
inline const std::string steady = R"(systolic="93 mmHg" diastolic="93 mmHg" heart_rate="60 1/min")";

struct Vessel : TestScene {
  BloodPressure* pressure = nullptr;
  BloodFlow* flow = nullptr;
  void load_vessel(const TestVessel& v, const std::string& pressure_attributes, const std::string& flow_attributes) {
    v.write(folder);
    // The network comes first, since the order of elements does not matter.
    load(fmt::format(R"(<scene time_step="10 ms"><solver tolerance="1e-14 m" max_sweeps="2000"/>
  <shell_body id="artery" wall="meshes/vessel.json"><test_wall stiffness="2000 N/m"/></shell_body>
  <blood_flow id="flow" pressure="p" {}/><pressure id="p" on="artery" {}/></scene>)",
                     flow_attributes, pressure_attributes));
    if (!s) return;
    pressure = &get<BloodPressure>("p");
    flow = &get<BloodFlow>("flow");
  }
  /// Presses a region flat across x between two heights, so that its wall's middle surfaces lie `gap` apart.
  void squeeze(const std::string& region, double low, double high, double axis, double gap) const {
    TestWall& w = wall();
    const int r = shell().region(region);
    for (std::size_t i = 0; i < w.place.size(); ++i) {
      const Vec3& x = shell().rest_nodes()[i];
      if (shell().model().vertex_region[i] == r && x.z() > low && x.z() < high && std::abs(x.x() - axis) > 1e-9)
        w.place[i].x() = axis + std::copysign(0.5 * gap, x.x() - axis);
    }
  }
  void release() const { wall().place = shell().rest_nodes(); }
  mutable Vessels vessels;
  const VesselState& state(std::string_view id) const {
    vessels = Vessels(*s);
    for (const VesselState& v : vessels.now())
      if (v.id == id) return v;
    throw std::runtime_error("no such stretch");
  }
};

/// A parent that divides into two branches and carries a sac.
struct Bifurcation : Vessel {
  Bifurcation(const std::string& p = steady, const std::string& f = "") {
    TestVessel v;
    v.add_tube("parent", "inlet", "bifurcation", Vec3(0, 0, 0), 0.0014, 0.014, 12, 14);
    v.add_tube("superior", "bifurcation", "superior_outlet", Vec3(0.01, 0, 0), 0.0011, 0.012, 12, 12);
    v.add_tube("inferior", "bifurcation", "inferior_outlet", Vec3(0.02, 0, 0), 0.0009, 0.012, 12, 12);
    v.add_tube("sac", "bifurcation", "dome", Vec3(0.03, 0, 0), 0.002, 0.006, 12, 6);
    load_vessel(v, p, f);
  }
};

}  // namespace insula::test
