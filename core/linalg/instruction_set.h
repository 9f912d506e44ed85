// SPDX-License-Identifier: GPL-3.0-or-later
// Loops that are compiled once per instruction set (cmake/core.cmake) have one table for each set. The set is chosen
// here, once per run.
#pragma once
#include <array>

namespace insula {

enum class InstructionSet { sse2, avx2, avx512 };

bool processor_has(InstructionSet set);
/// The best set of the processor. INSULA_KERNELS=sse2|avx2|avx512 in the environment selects a lower one.
InstructionSet chosen_instruction_set();

/// A table for each instruction set, in the order of InstructionSet.
template <class Table>
struct TablesOf {
  std::array<const Table*, 3> table;
  const Table& chosen() const { return *table[std::size_t(chosen_instruction_set())]; }
};

}  // namespace insula

/// In namespace insula: declares the tables `name` of all sets, and every_name(), which lists them.
#if defined(__x86_64__)
#define INSULA_TABLES(Table, name) \
  namespace sse2 {                 \
  extern const Table name;         \
  }                                \
  namespace avx2 {                 \
  extern const Table name;         \
  }                                \
  namespace avx512 {               \
  extern const Table name;         \
  }                                \
  inline TablesOf<Table> every_##name() { return {{&sse2::name, &avx2::name, &avx512::name}}; }
#else
#define INSULA_TABLES(Table, name) \
  namespace sse2 {                 \
  extern const Table name;         \
  }                                \
  inline TablesOf<Table> every_##name() { return {{&sse2::name, &sse2::name, &sse2::name}}; }
#endif
