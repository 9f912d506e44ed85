// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/instruction_set.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <cstdlib>
#include <string_view>

namespace insula {
namespace {

#if defined(__x86_64__)
/// Conversion between half and single precision, for which clang 14 has no name in __builtin_cpu_supports.
bool has_f16c() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
}
#endif

}  // namespace

bool processor_has(InstructionSet set) {
  if (set == InstructionSet::sse2) return true;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && has_f16c())) return false;
  if (set == InstructionSet::avx2) return true;
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

namespace {
InstructionSet choose() {
  const char* wanted = std::getenv("INSULA_KERNELS");
  const std::string_view most = wanted ? wanted : "avx512";
  if (most == "avx512" && processor_has(InstructionSet::avx512)) return InstructionSet::avx512;
  if ((most == "avx512" || most == "avx2") && processor_has(InstructionSet::avx2)) return InstructionSet::avx2;
  return InstructionSet::sse2;
}
}  // namespace

InstructionSet chosen_instruction_set() {
  static const InstructionSet chosen = choose();
  return chosen;
}

}  // namespace insula
