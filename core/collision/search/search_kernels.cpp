// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/collision/search/search_kernels.h"

#include "core/linalg/instruction_set.h"

namespace insula {
INSULA_TABLES(SearchKernels, search_table)

const SearchKernels& search_kernels() { return every_search_table().chosen(); }

}  // namespace insula
