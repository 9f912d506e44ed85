// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/size_check.h"

#include <fmt/format.h>

#include <cmath>

namespace insula::case_builder {
namespace {

struct Unit {
  double mm;
  const char* name;
};

/// The usual unit that brings `size` nearest (in ratio) to `usual`, besides the one in use.
std::string advice(double size, double mm_per_unit, double usual, double least, double most) {
  static constexpr Unit units[] = {{1000, "m"}, {10, "cm"}, {1, "mm"}, {0.001, "um"}};
  const Unit* best = nullptr;
  double nearest = 1e300;
  for (const Unit& u : units) {
    const double there = size * u.mm / mm_per_unit, away = std::abs(std::log(there / usual));
    if (u.mm != mm_per_unit && there >= least && there <= most && away < nearest) nearest = away, best = &u;
  }
  if (best) return fmt::format("; as if its numbers were in {}: give --unit {}", best->name, best->name);
  const double factor = std::pow(10.0, std::round(std::log10(usual / size)));
  if (factor != 1)
    return fmt::format("; as if it were {:g} times too {}: scale it, or give the millimetres of its unit, --unit-mm {:g}", factor < 1 ? 1 / factor : factor, factor < 1 ? "large" : "small", mm_per_unit * factor);
  return "";
}

}  // namespace

std::string check_extent(double extent, double unit) {
  if (extent >= least_extent && extent <= most_extent) return "";
  return fmt::format("the surface is {:.3g} mm across, which no stretch of cerebral artery is (usual: {:g} to {:g} mm){}", extent, least_extent, most_extent,
                     advice(extent, unit, 30, least_extent, most_extent));
}

std::string check_calibre(double calibre, double unit) {
  if (calibre >= least_calibre && calibre <= most_calibre) return "";
  return fmt::format("the widest opening is {:.3g} mm across, which no cerebral artery is (usual: {:g} to {:g} mm){}", calibre, least_calibre, most_calibre,
                     advice(calibre, unit, 2.5, least_calibre, most_calibre));
}

}  // namespace insula::case_builder
