// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/bipolar_forceps/heated_tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace insula {
namespace {

constexpr double heat_per_volume = 3.7e6;        // of tissue, J/(m3 K)
constexpr double blood_heat_per_volume = 3.8e6;  // J/(m3 K)
constexpr double conductivity = 0.5;             // W/(m K)
constexpr double water_share = 0.75;             // of the volume
constexpr double latent_heat = 2.257e9;          // of boiling water, J/m3
constexpr double frequency_factor = 5.6e63;      // 1/s
constexpr double activation_energy = 4.3e5;      // J/mol
constexpr double gas_constant = 8.314462618;     // J/(mol K)

}  // namespace

double coagulation_rate(double rise) {
  return frequency_factor * std::exp(-activation_energy / (gas_constant * (body_temperature + rise)));
}

HeatedTissue::HeatedTissue(double volume)
    : capacity_(heat_per_volume * volume),
      conductance_(4 * std::numbers::pi * conductivity * std::cbrt(3 * volume / (4 * std::numbers::pi))),
      water_heat_(water_share * latent_heat * volume) {}

double HeatedTissue::heat(double h, double power, double washing) {
  const double loss = conductance_ + blood_heat_per_volume * washing, steady = power / loss, rate = loss / capacity_;
  const double first = rise_;
  const auto at = [&](double t) { return steady + (first - steady) * std::exp(-rate * t); };
  // The time until it boils; dry tissue would go on, but then no current flows.
  double warming = h;
  if (steady > boiling_rise)
    warming = std::min(h, first < boiling_rise ? std::log((steady - first) / (steady - boiling_rise)) / rate : 0.0);
  // Gauss-Legendre with five points: the integrand is smooth.
  constexpr std::array<double, 5> x{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                    0.9061798459386640};
  constexpr std::array<double, 5> w{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                    0.2369268850561891};
  double dose = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    dose += 0.5 * warming * w[k] * coagulation_rate(at(0.5 * warming * (1 + x[k])));
  rise_ = at(warming);
  if (warming < h) {
    rise_ = boiling_rise;
    const double boiling = h - warming;
    dose += boiling * coagulation_rate(boiling_rise);
    dried_ = std::min(1.0, dried_ + boiling * (power - loss * boiling_rise) / water_heat_);
  }
  return dose;
}

}  // namespace insula
