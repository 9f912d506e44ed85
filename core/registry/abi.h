// SPDX-License-Identifier: GPL-3.0-or-later
// The string that says whether a shared plugin and this program may be mixed.
#pragma once
#include <Eigen/Core>

#define INSULA_ABI_VERSION 3
#define INSULA_STR2(x) #x
#define INSULA_STR(x) INSULA_STR2(x)
#define INSULA_ABI_STRING                                                                              \
  "insula " INSULA_STR(INSULA_ABI_VERSION) " g++ " INSULA_STR(__GXX_ABI_VERSION) " libstdc++ " INSULA_STR( \
      _GLIBCXX_USE_CXX11_ABI) " eigen " INSULA_STR(EIGEN_WORLD_VERSION) "." INSULA_STR(EIGEN_MAJOR_VERSION) "." INSULA_STR(EIGEN_MINOR_VERSION) " align " INSULA_STR(EIGEN_MAX_ALIGN_BYTES)
