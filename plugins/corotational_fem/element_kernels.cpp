// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/instruction_set.h"
#include "plugins/corotational_fem/element_batch.h"

namespace insula {
INSULA_TABLES(ElementKernels, element_table)

const ElementKernels& element_kernels() { return every_element_table().chosen(); }

}  // namespace insula
