// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/kernels.h"

#include "core/linalg/instruction_set.h"

namespace insula {
INSULA_TABLES(KernelSet, table)

template <>
const KernelsOf<double>& kernels_of<double>() {
  return every_table().chosen().f64;
}
template <>
const KernelsOf<float>& kernels_of<float>() {
  return every_table().chosen().f32;
}
BlockProduct block_product() { return every_table().chosen().block_product; }

}  // namespace insula
