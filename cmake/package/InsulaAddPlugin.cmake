# SPDX-License-Identifier: GPL-3.0-or-later
# insula_add_plugin(NAME [FOLDER folder]): the plugin of a folder that holds NAME.cpp, NAME_test.cpp and example.xml.
#   target NAME        NAME.so, a shared plugin; `cmake --install` puts it into the plugin folder of the prefix
#   target NAME_test   loads NAME.so and runs the author's tests and the contracts of each element, on example.xml
#   tests              NAME.tests, NAME.check and NAME.run (the program with the plugin, on the example)
# An Insula that was built without tests has no contracts: then there are no NAME_test and no NAME.tests.
function(insula_add_plugin name)
  cmake_parse_arguments(P "" "FOLDER" "" ${ARGN})
  if(NOT P_FOLDER)
    set(P_FOLDER ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
  get_filename_component(P_FOLDER ${P_FOLDER} ABSOLUTE)
  foreach(file ${name}.cpp ${name}_test.cpp example.xml)
    if(NOT EXISTS ${P_FOLDER}/${file})
      message(FATAL_ERROR "insula_add_plugin(${name}): ${P_FOLDER}/${file} is missing")
    endif()
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${P_FOLDER}/*.cpp)
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")

  add_library(${name} MODULE ${sources})
  target_compile_definitions(${name} PRIVATE INSULA_PLUGIN_SHARED)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow)
  target_link_libraries(${name} PRIVATE Insula::plugin)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden)
  install(TARGETS ${name} LIBRARY DESTINATION lib/insula/plugins)

  add_test(NAME ${name}.check COMMAND Insula::insula --plugin-path $<TARGET_FILE:${name}> check ${P_FOLDER}/example.xml)
  add_test(NAME ${name}.run
    COMMAND Insula::insula --plugin-path $<TARGET_FILE:${name}> run ${P_FOLDER}/example.xml --duration 2 --quiet)
  if(NOT TARGET Insula::plugin_testing)
    message(STATUS "Insula was built without tests: ${name} has no program of tests")
    return()
  endif()

  # A shared plugin takes the core from the program that loads it: the test program must hold all of the core, too.
  set(main ${CMAKE_CURRENT_BINARY_DIR}/${name}_test_main.cpp)
  file(CONFIGURE OUTPUT ${main}.in CONTENT "#include \"core/testing/plugin_main.h\"
int main(int argc, char** argv) {
  return insula::test::run_plugin_tests(argc, argv, \"$<TARGET_FILE:${name}>\", \"${P_FOLDER}/example.xml\");
}
" @ONLY)
  file(GENERATE OUTPUT ${main} INPUT ${main}.in)
  add_executable(${name}_test ${tests} ${main})
  target_compile_options(${name}_test PRIVATE -Wall -Wextra -Wpedantic -Wshadow)
  target_compile_definitions(${name}_test PRIVATE INSULA_PLUGIN_FOLDER="${P_FOLDER}")
  target_link_libraries(${name}_test PRIVATE Insula::plugin Insula::plugin_testing)
  target_link_options(${name}_test PRIVATE LINKER:--whole-archive $<TARGET_FILE:Insula::core> LINKER:--no-whole-archive)
  set_target_properties(${name}_test PROPERTIES ENABLE_EXPORTS ON)
  add_dependencies(${name}_test ${name})

  add_test(NAME ${name}.tests COMMAND ${name}_test)
endfunction()
