// SPDX-License-Identifier: GPL-3.0-or-later
// Physical quantities and their units. A value in a scene file is a number with a unit. Inside the program it is in SI.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace insula {

struct Unit {
  std::string_view symbol;
  double to_si;        ///< SI value = written value * to_si
  bool listed = true;  ///< false: accepted, but not offered in messages (other spellings, rare units)
};

/// Each quantity is a tag type. `name` is its name in messages, `si` its SI symbol, and `units()` the allowed units.
#define INSULA_QUANTITY(Tag, text, si_symbol)         \
  struct Tag {                                        \
    static constexpr std::string_view name = text;    \
    static constexpr std::string_view si = si_symbol; \
    static std::span<const Unit> units();             \
  }
INSULA_QUANTITY(Scalar, "plain number", "");     // dimensionless, no unit allowed
INSULA_QUANTITY(Length, "length", "m");          // m cm mm um
INSULA_QUANTITY(Area, "area", "m2");             // m2 cm2 mm2
INSULA_QUANTITY(Volume, "volume", "m3");         // m3 l ml ul mm3
INSULA_QUANTITY(Duration, "time", "s");          // s ms us min
INSULA_QUANTITY(Frequency, "frequency", "Hz");   // Hz kHz MHz 1/min
INSULA_QUANTITY(Rate, "rate", "1/s");            // 1/s (Rayleigh mass damping)
INSULA_QUANTITY(Mass, "mass", "kg");             // kg g mg
INSULA_QUANTITY(Density, "density", "kg/m3");    // kg/m3 g/cm3
INSULA_QUANTITY(Force, "force", "N");            // N mN kN
INSULA_QUANTITY(Torque, "torque", "N m");        // "N m" "N mm" (also Nm, Nmm)
INSULA_QUANTITY(Pressure, "pressure", "Pa");     // Pa kPa MPa GPa mmHg
INSULA_QUANTITY(Stiffness, "stiffness", "N/m");  // N/m N/mm kN/m
INSULA_QUANTITY(AngularStiffness, "angular stiffness", "N m/rad");
INSULA_QUANTITY(Damping, "damping", "N s/m");  // N s/m (also Ns/m)
INSULA_QUANTITY(Angle, "angle", "rad");        // rad deg
INSULA_QUANTITY(Speed, "speed", "m/s");        // m/s mm/s cm/s
INSULA_QUANTITY(Acceleration, "acceleration", "m/s2");
INSULA_QUANTITY(AreaDensity, "number per area", "1/m2");           // 1/m2 1/cm2 1/mm2
INSULA_QUANTITY(SurfaceMass, "mass per area", "kg/m2");            // kg/m2 g/cm2
INSULA_QUANTITY(FoundationModulus, "foundation modulus", "N/m3");  // N/m3 kPa/mm N/mm3
INSULA_QUANTITY(FlowRate, "flow rate", "m3/s");                    // m3/s ml/s ml/min
INSULA_QUANTITY(Perfusion, "perfusion", "m3/s/kg");                // m3/s/kg ml/100g/min
INSULA_QUANTITY(Viscosity, "viscosity", "Pa s");                   // Pa s, mPa s
INSULA_QUANTITY(Impulse, "impulse", "N s");                        // N s mN s
INSULA_QUANTITY(ForceRate, "rate of force", "N/s");                // N/s mN/s
INSULA_QUANTITY(Power, "power", "W");                              // W mW
INSULA_QUANTITY(TemperatureRise, "temperature rise", "K");         // K, above the body's temperature
#undef INSULA_QUANTITY

/// Whether any quantity has a unit of this symbol. This distinguishes a wrong unit from a mistyped number.
bool is_known_unit(std::string_view symbol);

}  // namespace insula
