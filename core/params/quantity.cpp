// SPDX-License-Identifier: GPL-3.0-or-later
// The units of each quantity, SI unit first (NIST SP 811 for the factors of mmHg and degree).
#include "core/params/quantity.h"

#include <array>
#include <numbers>

namespace insula {
namespace {
template <std::size_t N>
using Units = std::array<Unit, N>;

constexpr Units<4> length{{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}}};
constexpr Units<3> area{{{"m2", 1}, {"cm2", 1e-4}, {"mm2", 1e-6}}};
constexpr Units<5> volume{{{"m3", 1}, {"l", 1e-3}, {"ml", 1e-6}, {"ul", 1e-9}, {"mm3", 1e-9}}};
constexpr Units<4> duration{{{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60}}};
constexpr Units<4> frequency{{{"Hz", 1}, {"kHz", 1e3}, {"MHz", 1e6}, {"1/min", 1.0 / 60}}};
constexpr Units<1> rate{{{"1/s", 1}}};
constexpr Units<3> mass{{{"kg", 1}, {"g", 1e-3}, {"mg", 1e-6}}};
constexpr Units<2> density{{{"kg/m3", 1}, {"g/cm3", 1e3}}};
constexpr Units<3> force{{{"N", 1}, {"mN", 1e-3}, {"kN", 1e3}}};
constexpr Units<4> torque{{{"N m", 1}, {"N mm", 1e-3}, {"Nm", 1, false}, {"Nmm", 1e-3, false}}};
constexpr Units<5> pressure{{{"Pa", 1}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9, false}, {"mmHg", 133.322387415}}};
constexpr Units<3> stiffness{{{"N/m", 1}, {"N/mm", 1e3}, {"kN/m", 1e3}}};
constexpr Units<4> angular_stiffness{
    {{"N m/rad", 1}, {"N mm/rad", 1e-3}, {"Nm/rad", 1, false}, {"Nmm/rad", 1e-3, false}}};
constexpr Units<2> damping{{{"N s/m", 1}, {"Ns/m", 1, false}}};
constexpr Units<2> angle{{{"rad", 1}, {"deg", std::numbers::pi / 180}}};
constexpr Units<3> speed{{{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};
constexpr Units<2> acceleration{{{"m/s2", 1}, {"mm/s2", 1e-3}}};
constexpr Units<3> area_density{{{"1/m2", 1}, {"1/cm2", 1e4}, {"1/mm2", 1e6}}};
constexpr Units<2> surface_mass{{{"kg/m2", 1}, {"g/cm2", 10}}};
constexpr Units<3> foundation_modulus{{{"N/m3", 1}, {"kPa/mm", 1e6}, {"N/mm3", 1e9}}};
constexpr Units<3> flow_rate{{{"m3/s", 1}, {"ml/s", 1e-6}, {"ml/min", 1e-6 / 60}}};
constexpr Units<2> perfusion{{{"m3/s/kg", 1}, {"ml/100g/min", 1e-5 / 60}}};
constexpr Units<4> viscosity{{{"Pa s", 1}, {"mPa s", 1e-3}, {"Pas", 1, false}, {"mPas", 1e-3, false}}};
constexpr Units<4> impulse{{{"N s", 1}, {"mN s", 1e-3}, {"Ns", 1, false}, {"mNs", 1e-3, false}}};
constexpr Units<2> force_rate{{{"N/s", 1}, {"mN/s", 1e-3}}};
constexpr Units<2> power{{{"W", 1}, {"mW", 1e-3}}};
constexpr Units<1> temperature_rise{{{"K", 1}}};
}  // namespace

std::span<const Unit> Scalar::units() { return {}; }
std::span<const Unit> Length::units() { return length; }
std::span<const Unit> Area::units() { return area; }
std::span<const Unit> Volume::units() { return volume; }
std::span<const Unit> Duration::units() { return duration; }
std::span<const Unit> Frequency::units() { return frequency; }
std::span<const Unit> Rate::units() { return rate; }
std::span<const Unit> Mass::units() { return mass; }
std::span<const Unit> Density::units() { return density; }
std::span<const Unit> Force::units() { return force; }
std::span<const Unit> Torque::units() { return torque; }
std::span<const Unit> Pressure::units() { return pressure; }
std::span<const Unit> Stiffness::units() { return stiffness; }
std::span<const Unit> AngularStiffness::units() { return angular_stiffness; }
std::span<const Unit> Damping::units() { return damping; }
std::span<const Unit> Angle::units() { return angle; }
std::span<const Unit> Speed::units() { return speed; }
std::span<const Unit> Acceleration::units() { return acceleration; }
std::span<const Unit> AreaDensity::units() { return area_density; }
std::span<const Unit> SurfaceMass::units() { return surface_mass; }
std::span<const Unit> FoundationModulus::units() { return foundation_modulus; }
std::span<const Unit> FlowRate::units() { return flow_rate; }
std::span<const Unit> Perfusion::units() { return perfusion; }
std::span<const Unit> Viscosity::units() { return viscosity; }
std::span<const Unit> Impulse::units() { return impulse; }
std::span<const Unit> ForceRate::units() { return force_rate; }
std::span<const Unit> Power::units() { return power; }
std::span<const Unit> TemperatureRise::units() { return temperature_rise; }

bool is_known_unit(std::string_view symbol) {
  const std::span<const Unit> all[] = {
      length,       area,         volume,          duration,           frequency,         rate,      mass,      density,
      force,        torque,       pressure,        stiffness,          angular_stiffness, damping,   angle,     speed,
      acceleration, area_density, surface_mass,    foundation_modulus, flow_rate,         perfusion, viscosity, impulse,
      force_rate,   power,        temperature_rise};
  for (const auto& units : all)
    for (const auto& u : units)
      if (u.symbol == symbol) return true;
  return false;
}

}  // namespace insula
