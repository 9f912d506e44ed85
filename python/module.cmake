# SPDX-License-Identifier: GPL-3.0-or-later
# The module insula._core, for the Python and the nanobind that were found. `engine` and `core`: the targets to link to.
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/src/*.cpp)
nanobind_add_module(insula_python NB_STATIC NOMINSIZE NB_SUPPRESS_WARNINGS ${sources})
# All of it in one compilation: most of the time goes into the headers.
set_target_properties(insula_python PROPERTIES OUTPUT_NAME _core UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 40)
target_compile_definitions(insula_python PRIVATE INSULA_VERSION="${PROJECT_VERSION}")
target_link_libraries(insula_python PRIVATE ${engine})
# A shared plugin takes the core from this module: all of it must be there, not only what the module uses itself.
target_link_options(insula_python PRIVATE LINKER:--as-needed
  LINKER:--whole-archive $<TARGET_FILE:${core}> LINKER:--no-whole-archive)
