// SPDX-License-Identifier: GPL-3.0-or-later
// Example scenes of plugins for tests: loaded with every message as a failure, with hands that follow a script.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula::test {

/// The program's registry: every built-in element, and those of add_plugin().
const Registry& builtin();
/// Adds the elements of a shared plugin, before the first test. Returns the error text; empty when done.
std::string add_plugin(const std::filesystem::path& library);

/// Adds elements of the test program itself, before it loads scenes that name them.
void add_elements(void (*add)(Registry&));

/// Loads a scene. An error or a warning becomes a test failure, and the result is null.
std::unique_ptr<Simulation> load(const std::filesystem::path& file, int threads = 1);
std::unique_ptr<Simulation> load_text(const std::string& xml, const std::filesystem::path& virtual_path,
                                      int threads = 1);

/// Sets both hands for the coming step. They move from home along the shaft by 5 mm in half a second, then across by 2
/// mm and back in another. Button 1 is held from 0.2 s on. From 1 s on the hands are still.
void drive(Simulation& simulation);
inline constexpr double script_length = 1.0;  ///< s

/// Drives and steps n times.
void run_script(Simulation& simulation, int n);

/// Length of the body's shortest edge at rest, m: the scale of noise and of differences.
double shortest_edge(const DeformableBody& body);
/// A rotated, bent and noisy shape for the body's q, with a strain of the order of `strain`, reproducible by `seed`.
VecX deformed(const DeformableBody& body, double strain, std::uint64_t seed);

}  // namespace insula::test
