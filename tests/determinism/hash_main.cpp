// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the hash of the state of scenes under scripted hands. Built twice, optimised and not, to be compared.
// Usage: insula_hash STEPS SCENE...
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include "core/registry/registry.h"
#include "tests/determinism/script.h"

int main(int argc, char** argv) {
  using namespace insula;
  const int steps = argc > 1 ? std::atoi(argv[1]) : 0;
  if (argc < 3 || steps <= 0) {
    std::fprintf(stderr, "usage: %s STEPS SCENE...\n", argv[0]);
    return 2;
  }
  Registry registry;
  register_builtin(registry);
  for (int a = 2; a < argc; ++a) {
    auto result = load_simulation(argv[a], registry, 1);
    if (!result.simulation) {
      std::fprintf(stderr, "%s", result.diagnostics.format().c_str());
      return 2;
    }
    std::printf("%s", argv[a]);
    for (int i = 1; i <= steps; ++i) {
      script_hands(*result.simulation);
      result.simulation->step();
      if (i % 20 == 0 || i == steps) std::printf(" %016" PRIx64, result.simulation->state_hash());
    }
    std::printf("\n");
  }
  return 0;
}
