// SPDX-License-Identifier: GPL-3.0-or-later
// The string that decides whether a shared plugin and this program are compatible. Include this only where the string
// is used, since the generated header changes with every header of the core.
#pragma once
#include <Eigen/Core>

#include "insula_headers.h"  // INSULA_HEADERS: hash of the core's headers, made by cmake/headers_hash.cmake

#define INSULA_STR2(x) #x
#define INSULA_STR(x) INSULA_STR2(x)
// clang-format off
#define INSULA_ABI_STRING                                                                          \
  "insula headers " INSULA_HEADERS                                                                 \
  " g++ " INSULA_STR(__GXX_ABI_VERSION) " libstdc++ " INSULA_STR(_GLIBCXX_USE_CXX11_ABI)           \
  " eigen " INSULA_STR(EIGEN_WORLD_VERSION) "." INSULA_STR(EIGEN_MAJOR_VERSION) "."                \
  INSULA_STR(EIGEN_MINOR_VERSION) " align " INSULA_STR(EIGEN_MAX_ALIGN_BYTES)
// clang-format on
