# SPDX-License-Identifier: GPL-3.0-or-later
# Headers of libraries that nearly every source includes, compiled once. Headers of the project are not among them: a change
# of one would compile everything again. Sources still include what they use; with INSULA_PRECOMPILE=OFF this shows.
set(precompiled_headers <algorithm> <array> <atomic> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional>
  <set> <string> <thread> <vector> <Eigen/Dense> <fmt/format.h>)
set(precompiled_test_headers ${precompiled_headers} <gtest/gtest.h> <nlohmann/json.hpp>)

# insula_precompile(TARGET [FROM OTHER] [TEST]): precompiled headers for a target, or those of OTHER, whose flags must be the same.
function(insula_precompile target)
  cmake_parse_arguments(P "TEST" "FROM" "" ${ARGN})
  if(NOT INSULA_PRECOMPILE)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)  # asked for by ccache
  endif()
  if(P_FROM)
    target_precompile_headers(${target} REUSE_FROM ${P_FROM})
  elseif(P_TEST)
    target_precompile_headers(${target} PRIVATE ${precompiled_test_headers})
  else()
    target_precompile_headers(${target} PRIVATE ${precompiled_headers})
  endif()
endfunction()
