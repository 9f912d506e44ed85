// SPDX-License-Identifier: GPL-3.0-or-later
// Heat balance of the tissue between two tips, and what its temperature does (equations in bipolar_forceps.cpp).
#pragma once

namespace insula {

constexpr double body_temperature = 310.15;  ///< K
constexpr double boiling_rise = 62.85;       ///< K above the body: water boils at 100 degrees Celsius

/// A sphere of tissue.
class HeatedTissue {
 public:
  explicit HeatedTissue(double volume);                ///< m3
  double capacity() const { return capacity_; }        ///< J/K
  double conductance() const { return conductance_; }  ///< into the tissue around it, W/K
  double water_heat() const { return water_heat_; }    ///< that boils all of its water off, J

  double rise() const { return rise_; }    ///< above the body's temperature, K
  double dried() const { return dried_; }  ///< share of its water that has boiled off, 0..1
  /// Heats it for the time h, s, with a constant power, W, while `washing`, m3/s, of blood carries heat away. Returns
  /// the Arrhenius integral of that time.
  double heat(double h, double power, double washing);
  void reset() { rise_ = dried_ = 0; }

 private:
  double capacity_, conductance_, water_heat_;
  double rise_ = 0, dried_ = 0;
};

/// Rate of coagulation at a temperature, 1/s.
double coagulation_rate(double rise);

}  // namespace insula
