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
/// A size, mm, and the option that says which unit a file has.
struct Usual {
  const char *what, *kind;
  double size, least, most;
  const char* option;
};

/// The usual unit that brings `size` nearest (in ratio) to the usual one, besides the one in use.
std::string advice(double size, double mm_per_unit, const Usual& usual) {
  static constexpr Unit units[] = {{1000, "m"}, {10, "cm"}, {1, "mm"}, {0.001, "um"}};
  const Unit* best = nullptr;
  double nearest = 1e300;
  for (const Unit& u : units) {
    const double there = size * u.mm / mm_per_unit, away = std::abs(std::log(there / usual.size));
    if (u.mm != mm_per_unit && there >= usual.least && there <= usual.most && away < nearest) nearest = away, best = &u;
  }
  if (best) return fmt::format("; as if its numbers were in {0}: give {1} {0}", best->name, usual.option);
  const double factor = std::pow(10.0, std::round(std::log10(usual.size / size)));
  if (factor != 1)
    return fmt::format("; as if it were {:g} times too {}: scale it, or give its unit as a length, {} \"{:g} mm\"",
                       factor < 1 ? 1 / factor : factor, factor < 1 ? "large" : "small", usual.option,
                       mm_per_unit * factor);
  return "";
}

std::string check(double size, double mm_per_unit, const Usual& usual) {
  if (size >= usual.least && size <= usual.most) return "";
  return fmt::format("the {} is {:.3g} mm across, which no {} is (usual: {:g} to {:g} mm){}", usual.what, size,
                     usual.kind, usual.least, usual.most, advice(size, mm_per_unit, usual));
}

constexpr Usual of_extent{"surface", "stretch of cerebral artery", 30, min_extent, max_extent, "--unit"};
constexpr Usual of_calibre{"widest opening", "cerebral artery", 2.5, min_calibre, max_calibre, "--unit"};

std::optional<double> scale(double size, const Usual& usual) {
  if (!(size > 0) || (size >= usual.least && size <= usual.most)) return std::nullopt;
  const double factor = std::pow(10.0, std::round(std::log10(usual.size / size)));
  const double there = factor * size;
  return factor != 1 && there >= usual.least && there <= usual.most ? std::optional(factor) : std::nullopt;
}

}  // namespace

std::string check_extent(double extent, double unit) { return check(extent, unit, of_extent); }
std::string check_calibre(double calibre, double unit) { return check(calibre, unit, of_calibre); }
std::optional<double> scale_of_extent(double extent) { return scale(extent, of_extent); }
std::optional<double> scale_of_calibre(double calibre) { return scale(calibre, of_calibre); }
std::string check_brain(double extent, double unit) {
  return check(extent, unit, {"surface", "part of a brain", 100, min_brain, max_brain, "--brain-unit"});
}

}  // namespace insula::case_builder
