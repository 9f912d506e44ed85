# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where, in two components, and the Debian packages made of them:
#   insula      bin/ programs, share/insula/ page, scenes, curricula, meshes, examples, manual; what desktops need
#   insula-dev  include/insula/ headers, lib/insula/ libraries, lib/cmake/Insula/ package for find_package(Insula)
include(CMakePackageConfigHelpers)
set(share share/insula)
set(config lib/cmake/Insula)

# --- programs and data -----------------------------------------------------------------------------------------------
install(TARGETS insula EXPORT InsulaTargets RUNTIME DESTINATION bin COMPONENT insula)
install(TARGETS insula_workbench haptic_server gateway RUNTIME DESTINATION bin COMPONENT insula)
install(DIRECTORY scenes curricula meshes studies DESTINATION ${share} COMPONENT insula PATTERN "*.py" EXCLUDE)
install(DIRECTORY plugins DESTINATION ${share} COMPONENT insula FILES_MATCHING PATTERN "*.xml")
install(DIRECTORY docs DESTINATION ${share} COMPONENT insula)
install(FILES LICENSE README.md DESTINATION ${share} COMPONENT insula)
install(FILES packaging/desktop/insula.desktop DESTINATION share/applications COMPONENT insula)
install(FILES packaging/desktop/insula.svg DESTINATION share/icons/hicolor/scalable/apps COMPONENT insula)
# Folders that only shared plugins fill are made beforehand, so that one sees where they go.
install(DIRECTORY DESTINATION lib/insula/plugins COMPONENT insula)
# The page is built by npm (./insula build); an engine without it still runs, checks and reports.
install(DIRECTORY viewer/page/dist/ DESTINATION ${share}/page COMPONENT insula OPTIONAL)
install(CODE "if(NOT EXISTS \"${PROJECT_SOURCE_DIR}/viewer/page/dist/index.html\")
  message(WARNING \"the viewer's page is not built and is left out: run ./insula build first\")
endif()" COMPONENT insula)

# --- headers, libraries, CMake package -------------------------------------------------------------------------------
install(DIRECTORY core DESTINATION include/insula COMPONENT insula-dev FILES_MATCHING PATTERN "*.h"
  PATTERN "bus" EXCLUDE PATTERN "haptics" EXCLUDE PATTERN "*_for_test.h" EXCLUDE)
install(FILES ${abi_header} DESTINATION include/insula COMPONENT insula-dev)
target_include_directories(insula_core SYSTEM INTERFACE $<INSTALL_INTERFACE:include/insula>
  "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR};${CMAKE_BINARY_DIR}/generated/abi>")

# What a plugin is compiled with: headers alone, for the core is in the program that loads it.
add_library(insula_plugin INTERFACE)
set(built_headers ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR}/generated/abi)
target_include_directories(insula_plugin SYSTEM INTERFACE $<INSTALL_INTERFACE:include/insula>
  "$<BUILD_INTERFACE:${built_headers}>")
target_compile_features(insula_plugin INTERFACE cxx_std_20)
target_compile_options(insula_plugin INTERFACE -ffp-contract=off)
target_compile_definitions(insula_plugin INTERFACE EIGEN_DONT_PARALLELIZE)
target_link_libraries(insula_plugin INTERFACE Eigen3::Eigen)

set_target_properties(insula_core PROPERTIES EXPORT_NAME core)
set_target_properties(insula_plugins PROPERTIES EXPORT_NAME plugins)
set_target_properties(insula_plugin PROPERTIES EXPORT_NAME plugin)
set(libraries insula_core insula_plugins insula_plugin)
# The contracts need GoogleTest: a build without tests has none to give.
if(TARGET insula_testing)
  set_target_properties(insula_testing PROPERTIES EXPORT_NAME plugin_testing)
  list(APPEND libraries insula_testing)
endif()
install(TARGETS ${libraries} EXPORT InsulaTargets ARCHIVE DESTINATION lib/insula COMPONENT insula-dev)
install(EXPORT InsulaTargets NAMESPACE Insula:: DESTINATION ${config} COMPONENT insula-dev)
configure_package_config_file(cmake/package/InsulaConfig.cmake.in ${CMAKE_BINARY_DIR}/package/InsulaConfig.cmake
  INSTALL_DESTINATION ${config})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/InsulaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
# The build folder is found as an installation is: find_package(Insula HINTS build/release).
export(EXPORT InsulaTargets NAMESPACE Insula:: FILE ${CMAKE_BINARY_DIR}/InsulaTargets.cmake)
configure_package_config_file(cmake/package/InsulaConfig.cmake.in ${CMAKE_BINARY_DIR}/InsulaConfig.cmake
  INSTALL_DESTINATION ${CMAKE_BINARY_DIR} INSTALL_PREFIX ${CMAKE_BINARY_DIR})
file(COPY ${CMAKE_BINARY_DIR}/package/InsulaConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/package/InsulaAddPlugin.cmake DESTINATION ${CMAKE_BINARY_DIR})
install(FILES ${CMAKE_BINARY_DIR}/package/InsulaConfig.cmake ${CMAKE_BINARY_DIR}/package/InsulaConfigVersion.cmake
  cmake/package/InsulaAddPlugin.cmake DESTINATION ${config} COMPONENT insula-dev)

# --- Debian packages: cpack -G DEB in the build folder ---------------------------------------------------------------
set(CPACK_PACKAGE_VENDOR "Insula")
set(CPACK_PACKAGE_CONTACT "the authors of Insula <insula@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "aneurysm surgery with two-handed haptics")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL insula insula-dev)
string(CONCAT CPACK_COMPONENT_INSULA_DESCRIPTION
  "Simulator for training in aneurysm surgery: engine, haptic server, viewer, exercises.\n"
  " For training only, never for the care of patients.")
set(CPACK_COMPONENT_INSULA-DEV_DESCRIPTION
  "Headers, libraries and CMake package for plugins of Insula and their tests.")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_INSULA_PACKAGE_NAME insula)
set(CPACK_DEBIAN_INSULA-DEV_PACKAGE_NAME insula-dev)
set(CPACK_DEBIAN_INSULA-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_INSULA-DEV_PACKAGE_SHLIBDEPS OFF)
string(CONCAT CPACK_DEBIAN_INSULA-DEV_PACKAGE_DEPENDS
  "insula (= ${PROJECT_VERSION}), cmake, g++, pkg-config, libeigen3-dev, libsuitesparse-dev, libassimp-dev, "
  "liburdfdom-dev, libconsole-bridge-dev, libexpat1-dev, libspdlog-dev, libfmt-dev, nlohmann-json3-dev, zlib1g-dev, "
  "libzstd-dev, libgtest-dev")
include(CPack)
