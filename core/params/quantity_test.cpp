// SPDX-License-Identifier: GPL-3.0-or-later
// Every unit of every quantity, and every form of a wrong number.
#include "core/params/quantity.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "core/params/number.h"
#include "core/params/param.h"

namespace insula {
namespace {

struct UnitCase {
  std::span<const Unit> units;
  const char* text;
  double si;
};

const UnitCase every_unit[] = {
    {Length::units(), "2 m", 2},
    {Length::units(), "2 cm", 2e-2},
    {Length::units(), "2 mm", 2e-3},
    {Length::units(), "2 um", 2e-6},
    {Area::units(), "2 m2", 2},
    {Area::units(), "2 cm2", 2e-4},
    {Area::units(), "2 mm2", 2e-6},
    {Duration::units(), "2 s", 2},
    {Duration::units(), "2 ms", 2e-3},
    {Duration::units(), "2 us", 2e-6},
    {Duration::units(), "2 min", 120},
    {Frequency::units(), "2 Hz", 2},
    {Frequency::units(), "2 kHz", 2e3},
    {Frequency::units(), "2 MHz", 2e6},
    {Frequency::units(), "60 1/min", 1},
    {Rate::units(), "2 1/s", 2},
    {Mass::units(), "2 kg", 2},
    {Mass::units(), "2 g", 2e-3},
    {Mass::units(), "2 mg", 2e-6},
    {Density::units(), "1000 kg/m3", 1000},
    {Density::units(), "1 g/cm3", 1000},
    {Force::units(), "2 N", 2},
    {Force::units(), "2 mN", 2e-3},
    {Force::units(), "2 kN", 2e3},
    {Torque::units(), "2 N m", 2},
    {Torque::units(), "2 N mm", 2e-3},
    {Torque::units(), "2 Nm", 2},
    {Torque::units(), "2 Nmm", 2e-3},
    {Torque::units(), "2 N   mm", 2e-3},
    {Pressure::units(), "2 Pa", 2},
    {Pressure::units(), "2 kPa", 2e3},
    {Pressure::units(), "2 MPa", 2e6},
    {Pressure::units(), "2 GPa", 2e9},
    {Pressure::units(), "760 mmHg", 101325.0144354},
    {Stiffness::units(), "2 N/m", 2},
    {Stiffness::units(), "2 N/mm", 2e3},
    {Stiffness::units(), "2 kN/m", 2e3},
    {AngularStiffness::units(), "2 N m/rad", 2},
    {AngularStiffness::units(), "2 N mm/rad", 2e-3},
    {Damping::units(), "2 N s/m", 2},
    {Damping::units(), "2 Ns/m", 2},
    {Angle::units(), "2 rad", 2},
    {Angle::units(), "90 deg", std::numbers::pi / 2},
    {Speed::units(), "2 m/s", 2},
    {Speed::units(), "2 cm/s", 2e-2},
    {Speed::units(), "2 mm/s", 2e-3},
    {Acceleration::units(), "9.81 m/s2", 9.81},
    {Acceleration::units(), "2 mm/s2", 2e-3},
    {AreaDensity::units(), "2 1/m2", 2},
    {AreaDensity::units(), "2 1/cm2", 2e4},
    {AreaDensity::units(), "2 1/mm2", 2e6},
    {SurfaceMass::units(), "2 kg/m2", 2},
    {SurfaceMass::units(), "2 g/cm2", 20},
    {FoundationModulus::units(), "2 N/m3", 2},
    {FoundationModulus::units(), "2 kPa/mm", 2e6},
    {FoundationModulus::units(), "2 N/mm3", 2e9},
    {FlowRate::units(), "2 m3/s", 2},
    {FlowRate::units(), "2 ml/s", 2e-6},
    {FlowRate::units(), "60 ml/min", 1e-6},
    {Perfusion::units(), "2 m3/s/kg", 2},
    {Perfusion::units(), "60 ml/100g/min", 1e-5},
    {Viscosity::units(), "2 Pa s", 2},
    {Viscosity::units(), "3.5 mPa s", 3.5e-3},
    {Viscosity::units(), "2 Pas", 2},
    {Viscosity::units(), "2 mPas", 2e-3},
    {Impulse::units(), "2 N s", 2},
    {Impulse::units(), "2 mN s", 2e-3},
    {ForceRate::units(), "2 N/s", 2},
    {ForceRate::units(), "2 mN/s", 2e-3},
    {Power::units(), "2 W", 2},
    {Power::units(), "2 mW", 2e-3},
    {TemperatureRise::units(), "43 K", 43},
    {Scalar::units(), "0.45", 0.45},
};

TEST(Quantity, EveryUnit) {
  for (const auto& c : every_unit) {
    std::string error;
    const auto value = parse_quantity(c.text, c.units, "quantity", error);
    ASSERT_TRUE(value) << c.text << ": " << error;
    EXPECT_NEAR(*value, c.si, 1e-12 * c.si) << c.text;
  }
}

TEST(Quantity, EveryListedUnitIsCoveredAndPositive) {
  for (const auto units : {Length::units(),
                           Area::units(),
                           Duration::units(),
                           Frequency::units(),
                           Rate::units(),
                           Mass::units(),
                           Density::units(),
                           Force::units(),
                           Torque::units(),
                           Pressure::units(),
                           Stiffness::units(),
                           AngularStiffness::units(),
                           Damping::units(),
                           Angle::units(),
                           Speed::units(),
                           Acceleration::units(),
                           AreaDensity::units(),
                           SurfaceMass::units(),
                           FoundationModulus::units(),
                           FlowRate::units(),
                           Perfusion::units(),
                           Viscosity::units(),
                           Impulse::units(),
                           ForceRate::units(),
                           Power::units(),
                           TemperatureRise::units()}) {
    ASSERT_FALSE(units.empty());
    EXPECT_EQ(units.front().to_si, 1.0) << units.front().symbol;
    for (const auto& u : units) {
      EXPECT_GT(u.to_si, 0) << u.symbol;
      EXPECT_TRUE(is_known_unit(u.symbol)) << u.symbol;
      std::string error;
      EXPECT_TRUE(parse_quantity("1 " + std::string(u.symbol), units, "quantity", error)) << u.symbol << ": " << error;
    }
  }
}

TEST(Quantity, NumbersAsPeopleWriteThem) {
  for (const char* text : {"5 mm", "5mm", " 5 mm ", "+5 mm", "5. mm", "5.0e0 mm", "0.5E1mm", "50e-1\tmm"}) {
    std::string error;
    const auto value = parse_quantity(text, Length::units(), "length", error);
    ASSERT_TRUE(value) << text << ": " << error;
    EXPECT_NEAR(*value, 5e-3, 1e-15) << text;
  }
  std::string error;
  EXPECT_EQ(*parse_quantity("-.5 m", Length::units(), "length", error), -0.5);
}

struct BadCase {
  const char* text;
  const char* message;
};

TEST(Quantity, EveryWayToWriteItWrongly) {
  const BadCase cases[] = {
      {"", "the value is empty"},
      {"   ", "the value is empty"},
      {"12O0", "\"12O0\" is not a number"},
      {"12O0 Pa", "\"12O0\" is not a number"},
      {"12OO Pa", "\"12OO\" is not a number"},
      {"0,5 kPa", "\"0,5\" is not a number (the decimal sign is a point, not a comma)"},
      {"1.2.3 Pa", "\"1.2.3\" is not a number"},
      {"1e400 Pa", "\"1e400\" is too large or too small a number"},
      {"1e-400 Pa", "\"1e-400\" is too large or too small a number"},
      {"1e308 kPa", "is too large or too small a number"},
      {"nan Pa", "is not a number"},
      {"inf Pa", "is not a number"},
      {"-inf", "is not a number"},
      {"infinity Pa", "is not a number"},
      {"0x1p3 Pa", "\"0x1p3\" is not a number"},
      {"0x10 Pa", "\"0x10\" is not a number"},
      {"- 5 Pa", "is not a number"},
      {"+-5 Pa", "is not a number"},
      {"e5 Pa", "is not a number"},
      {". Pa", "is not a number"},
      {"Pa", "\"Pa\" is not a number"},
      {"five Pa", "is not a number"},
      {"5", "\"5\" has no unit; a pressure needs one of Pa, kPa, MPa, mmHg"},
      {"10 N", "\"N\" is not a unit of pressure (use one of Pa, kPa, MPa, mmHg)"},
      {"10N", "\"N\" is not a unit of pressure (use one of Pa, kPa, MPa, mmHg)"},
      {"10m2", "\"m2\" is not a unit of pressure"},
      {"10 pa", "\"pa\" is not a unit of pressure"},
      {"10 Pa Pa", "\"Pa Pa\" is not a unit of pressure"},
      {"10 Pa 5", "\"Pa 5\" is not a unit of pressure"},
      {"10 20 Pa", "is not a unit of pressure"},
      {"1e Pa", "is not a number"},
  };
  for (const auto& c : cases) {
    std::string error;
    const auto value = parse_quantity(c.text, Pressure::units(), "pressure", error);
    EXPECT_FALSE(value) << c.text;
    EXPECT_NE(error.find(c.message), std::string::npos) << c.text << " gave: " << error;
  }
}

TEST(Quantity, PlainNumbersTakeNoUnit) {
  std::string error;
  EXPECT_FALSE(parse_quantity("5 Pa", Scalar::units(), "plain number", error));
  EXPECT_NE(error.find("\"Pa\" may not stand here"), std::string::npos) << error;
  EXPECT_FALSE(parse_quantity("0.5x1", Scalar::units(), "plain number", error));
  EXPECT_NE(error.find("\"0.5x1\" is not a number"), std::string::npos) << error;
}

TEST(Number, LengthOfTheNumberInFront) {
  EXPECT_EQ(number_length("12.5e-3x"), 7u);
  EXPECT_EQ(number_length("12e"), 2u);
  EXPECT_EQ(number_length("."), 0u);
  EXPECT_EQ(number_length("-"), 0u);
  EXPECT_EQ(number_length("x1"), 0u);
}

}  // namespace
}  // namespace insula
