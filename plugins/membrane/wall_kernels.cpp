// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/instruction_set.h"
#include "plugins/membrane/wall_batch.h"

namespace insula {
INSULA_TABLES(WallKernels, wall_table)

const WallKernels& wall_kernels() { return every_wall_table().chosen(); }

}  // namespace insula
