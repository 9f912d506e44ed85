#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What rattler-build runs for the recipe: the page by npm, then programs and data.
set -euo pipefail
(cd viewer/page && npm ci --no-audit --no-fund && npm run build)
cmake -S . -B build/conda -G Ninja ${CMAKE_ARGS:-} -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" \
  -DBUILD_TESTING=OFF -DINSULA_PYTHON=OFF
cmake --build build/conda --parallel "${CPU_COUNT:-2}" --target insula insula_workbench haptic_server gateway
cmake --install build/conda --component insula --strip
