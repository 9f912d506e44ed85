// SPDX-License-Identifier: GPL-3.0-or-later
// The instruction set of the element loops is that of the dense kernels.
#include <string_view>

#include "core/linalg/kernels.h"
#include "plugins/corotational_fem/element_batch.h"

namespace insula {
namespace sse2 { extern const ElementKernels element_table; }
#if defined(__x86_64__)
namespace avx2 { extern const ElementKernels element_table; }
namespace avx512 { extern const ElementKernels element_table; }
#endif

const ElementKernels& element_kernels() {
#if defined(__x86_64__)
  const std::string_view name = kernels().name;
  if (name == "avx512") return avx512::element_table;
  if (name == "avx2") return avx2::element_table;
#endif
  return sse2::element_table;
}

}  // namespace insula
