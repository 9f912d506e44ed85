// SPDX-License-Identifier: GPL-3.0-or-later
// Example scenes of plugins as tests see them: loaded with every message shown, with hands that follow a plain script.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula::test {

/// Every built-in element, and those of add_plugin(); one for the program.
const Registry& builtin();
/// Adds the elements of a shared plugin, before the first test. Returns why not, empty when done.
std::string add_plugin(const std::filesystem::path& library);

/// Adds elements of the test program itself, before it loads scenes that name them.
void add_elements(void (*add)(Registry&));

/// Loads a scene; what is wrong becomes a test failure and the result is null. Warnings are failures too.
std::unique_ptr<Simulation> load(const std::filesystem::path& file, int threads = 1);
std::unique_ptr<Simulation> load_text(const std::string& xml, const std::filesystem::path& virtual_path,
                                      int threads = 1);

/// Both hands for the coming step: in from home along the shaft by 5 mm within half a second, then across by 2 mm and
/// back within another; button 1 is held from 0.2 s on. From 1 s on the hands are still.
void drive(Simulation& simulation);
inline constexpr double script_length = 1.0;  ///< s

/// Drives and steps n times.
void run_script(Simulation& simulation, int n);

/// Length of the body's shortest edge at rest, m: the scale of noise and of differences.
double shortest_edge(const DeformableBody& body);
/// A shape, turned, bent and noisy, for the body's q: strain of the order of `strain`, reproducible by `seed`.
VecX deformed(const DeformableBody& body, double strain, std::uint64_t seed);

}  // namespace insula::test
