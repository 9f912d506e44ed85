// SPDX-License-Identifier: GPL-3.0-or-later
// The arteries of the brain as a network of resistances, from the common carotid and vertebral arteries to the beds of
// the territories (equations in circle_of_willis.cpp).
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "plugins/pressure/star_mesh.h"

namespace insula {

class CerebralNetwork {
 public:
  static constexpr int arteries = -1;  ///< instead of a node: the pressure of the arteries of the neck

  struct Segment {
    std::string name;             ///< "m1_right"
    int from = arteries, to = 0;  /// nodes
    double length = 0;            ///< m
    double radius = 0;            ///< m; 0: it is missing
    double lumen = 1;             ///< least cross-section over its own
    double narrow_length = 0;     ///< of the part with the least cross-section, m
    double flow = 0;              ///< m3/s, positive from `from` to `to`
  };
  struct Territory {
    std::string name;      ///< "mca_superior_right"
    int node = 0;          ///< that feeds its bed
    double rest_flow = 0;  ///< m3/s
    double bed = 0;        ///< conductance, m3/(s Pa)
    double flow = 0;       ///< m3/s
  };
  /// Vessels on the surface of the brain, between the ends of two territories.
  struct Anastomosis {
    int a = 0, b = 0;
    double conductance = 0;  ///< m3/(s Pa)
    double flow = 0;         ///< m3/s, positive from a to b
  };

  double viscosity = 3.5e-3;  ///< Pa s
  double venous = 0;          ///< Pa, behind the beds
  std::vector<Segment> segments;
  std::vector<Territory> territories;
  std::vector<Anastomosis> anastomoses;

  Segment* find(std::string_view name);
  double conductance(const Segment& s) const;
  /// Sizes the beds, so that each territory has its flow at rest under that pressure of the arteries. Returns the name
  /// of the first territory that the arteries cannot supply so; empty: done.
  std::string size_beds(double arterial);
  /// Pressures and flows under a pressure of the arteries, Pa. Allocates only the first time.
  void solve(double arterial);
  double pressure(int node) const { return pressure_[std::size_t(node)]; }  ///< Pa
  int nodes() const { return int(pressure_.size()); }

 private:
  void set_links(double arterial);
  void eliminate();

  StarMesh mesh_;
  std::vector<double> pressure_;
};

/// The complete, symmetric circle without beds: lengths and radii in cerebral_network.cpp. `brain_flow` is the flow of
/// the internal carotid and vertebral arteries at rest, m3/s.
CerebralNetwork complete_circle(double brain_flow);

}  // namespace insula
