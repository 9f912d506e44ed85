// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the instruction set once.
#include "core/linalg/kernels.h"

#include <cstdlib>
#include <string_view>

namespace insula {
namespace sse2 { extern const KernelSet table; }
#if defined(__x86_64__)
namespace avx2 { extern const KernelSet table; }
namespace avx512 { extern const KernelSet table; }
#endif

namespace {
const KernelSet& choose() {
#if defined(__x86_64__)
  const char* wanted = std::getenv("INSULA_KERNELS");
  const std::string_view most = wanted ? wanted : "avx512";
  __builtin_cpu_init();
  const bool has512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  const bool has2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (has512 && most == "avx512") return avx512::table;
  if (has2 && (most == "avx512" || most == "avx2")) return avx2::table;
#endif
  return sse2::table;
}
const KernelSet& chosen() {
  static const KernelSet& set = choose();
  return set;
}
}  // namespace

template <>
const KernelsOf<double>& kernels_of<double>() { return chosen().f64; }
template <>
const KernelsOf<float>& kernels_of<float>() { return chosen().f32; }

}  // namespace insula
