// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/instruction_set.h"

#include <cstdlib>
#include <string_view>

namespace insula {

bool processor_has(InstructionSet set) {
  if (set == InstructionSet::sse2) return true;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("f16c")))
    return false;
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
