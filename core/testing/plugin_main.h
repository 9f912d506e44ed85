// SPDX-License-Identifier: GPL-3.0-or-later
// The test program of one shared plugin, as insula_add_plugin() of the CMake package creates it.
#pragma once

namespace insula::test {

/// Loads the plugin's library into test::builtin(). Adds the contracts of every element in it, checked on `example`, to
/// the program's own tests, and runs all tests. Returns the exit status.
int run_plugin_tests(int argc, char** argv, const char* library, const char* example);

}  // namespace insula::test
