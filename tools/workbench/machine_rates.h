// SPDX-License-Identifier: GPL-3.0-or-later
// What the core that runs this can do, measured: the yardstick of the solvers.
#pragma once

namespace insula {

struct MachineRates {
  double peak_f64 = 0, peak_f32 = 0;        ///< multiplications and additions in registers, flop/s
  double product_f64 = 0, product_f32 = 0;  ///< a dense product of our kernels that fits the second cache, flop/s
  double read = 0;                          ///< a stream from memory, bytes/s
};
/// The best of several tries each; some tenths of a second.
MachineRates measure_machine();

}  // namespace insula
