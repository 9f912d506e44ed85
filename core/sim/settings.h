// SPDX-License-Identifier: GPL-3.0-or-later
// Scene-wide settings: the nonlinear solver, settling, devices, and the first view of the field.
#pragma once
#include "core/registry/component.h"

namespace insula {

class SolverSettings final : public Component {
 public:
  static constexpr std::string_view kind_name = "settings";
  Param<int> max_sweeps{
      this,
      {.name = "max_sweeps", .fallback = "100", .min = "1", .max = "10000", .doc = "most Gauss-Seidel sweeps a step"}};
  Param<Length> tolerance{this,
                          {.name = "tolerance",
                           .fallback = "1e-9 m",
                           .min = "1e-15 m",
                           .max = "1e-3 m",
                           .doc = "a sweep that moves no row by more than this is the last"}};
  Param<bool> conjugate{
      this,
      {.name = "conjugate",
       .fallback = "false",
       .doc = "whether sweeps are joined by conjugate directions: fewer of them where jaws press on thin walls"}};
  Param<int> newton{
      this,
      {.name = "newton",
       .fallback = "0",
       .min = "0",
       .max = "100",
       .doc = "most Newton steps a step, made where sweeps would not come to the tolerance; 0: sweeps alone"}};
};

class SettleSettings final : public Component {
 public:
  static constexpr std::string_view kind_name = "settings";
  Param<Duration> time{
      this,
      {.name = "time",
       .min = "0 s",
       .max = "60 s",
       .doc = "simulated time before the exercise begins, in which arms take their places and tissue comes to rest"}};
  Param<Duration> time_step{this,
                            {.name = "time_step",
                             .fallback = "16.6667 ms",
                             .min = "1 ms",
                             .max = "50 ms",
                             .doc = "length of a step until then; friction depends on it, so that the exercise begins "
                                    "in the same position at any length of its own steps"}};
};

/// Read by the program that starts the haptic server. The engine itself has no devices.
class DeviceSettings final : public Component {
 public:
  static constexpr std::string_view kind_name = "settings";
  Param<std::string> left{
      this,
      {.name = "left",
       .fallback = "simulated",
       .doc = "device of the left hand, best first: KIND[:WHICH], with commas between; the first that is plugged in"}};
  Param<std::string> right{this, {.name = "right", .fallback = "simulated", .doc = "device of the right hand"}};
  Param<Scalar> force_scale{
      this,
      {.name = "force_scale",
       .fallback = "1",
       .min = "0.1",
       .max = "10",
       .doc = "force on the hand over force in the scene: forces of this surgery lie below the friction of many arms"}};
};

class ViewSettings final : public Component {
 public:
  static constexpr std::string_view kind_name = "settings";
  Param<Vec<Length>> eye{this, {.name = "eye", .doc = "where the microscope stands"}};
  Param<Vec<Length>> target{this, {.name = "target", .doc = "what it looks at"}};
  Param<Vec<Scalar>> up{this, {.name = "up", .fallback = "0 0 1", .doc = "direction that is up in the picture"}};
  Param<Angle> field_of_view{this,
                             {.name = "field_of_view",
                              .fallback = "20 deg",
                              .min = "1 deg",
                              .max = "120 deg",
                              .doc = "vertical opening angle"}};

  void prepare(PrepareContext& context) override;
};

}  // namespace insula
