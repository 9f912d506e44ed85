# SPDX-License-Identifier: GPL-3.0-or-later
# The project around what docs/writing-a-plugin.md shows; sources are those of the page.
cmake_minimum_required(VERSION 3.25)
project(tether LANGUAGES CXX)
find_package(Eigen3 REQUIRED)
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/../plugins ${CMAKE_SOURCE_DIR}/plugins SYMBOLIC)
@SNIPPET@
