# SPDX-License-Identifier: GPL-3.0-or-later
# Everything Insula uses, all from Debian 12 or 13.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(EXPAT REQUIRED)
if(BUILD_TESTING)
  find_package(GTest REQUIRED)
endif()
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Boost REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(URDFDOM REQUIRED IMPORTED_TARGET urdfdom)
# Messages of urdfdom are captured through its console_bridge, which newer packages do not link by themselves.
find_library(CONSOLE_BRIDGE_LIBRARY console_bridge REQUIRED)
target_link_libraries(PkgConfig::URDFDOM INTERFACE ${CONSOLE_BRIDGE_LIBRARY})
# Not by pkg-config: lcm.pc asks for glib's development files, which nothing here needs.
find_library(LCM_LIBRARY lcm REQUIRED)
find_path(LCM_INCLUDE lcm/lcm.h REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
# The generator that belongs to the installed headers, not one that a Python environment put first in the path.
find_program(LCM_GEN lcm-gen HINTS /usr/bin NO_DEFAULT_PATH)
find_program(LCM_GEN lcm-gen REQUIRED)

if(BUILD_TESTING)
  # For tests alone: the judge of our collision. Not all of bullet-float64.pc, which names the dynamics too.
  find_path(BULLET_INCLUDE btBulletCollisionCommon.h PATH_SUFFIXES bullet REQUIRED)
  find_library(BULLET_COLLISION BulletCollision-float64 REQUIRED)
  find_library(BULLET_MATH LinearMath-float64 REQUIRED)
  add_library(insula_bullet INTERFACE)
  target_include_directories(insula_bullet SYSTEM INTERFACE ${BULLET_INCLUDE})
  target_compile_definitions(insula_bullet INTERFACE BT_USE_DOUBLE_PRECISION)
  target_link_libraries(insula_bullet INTERFACE ${BULLET_COLLISION} ${BULLET_MATH})
endif()
