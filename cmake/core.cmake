# SPDX-License-Identifier: GPL-3.0-or-later
# The rooms of core/. Each folder is a target that names the rooms it may use. insula_core is all of them in one
# library.
#
# A room is linked by itself against the rooms that it names, with nothing left undefined. So a use that is not
# declared here does not link, and neither does a circle. tests/rooms/ checks the includes, which no linker sees.
set(insula_core_objects)
set(insula_core_sources)
set(insula_core_kernels)

# Vectorised kernels of a folder, once per instruction set, always optimised the same way: their bits must not depend on
# the build type.
function(insula_kernels out)  # insula_kernels(OUT name FILE...)
  list(POP_FRONT ARGN name)
  set(objects)
  set(files ${ARGN})
  macro(one_set set bytes nv nr)
    add_library(kernels_${name}_${set} OBJECT ${files})
    target_compile_definitions(kernels_${name}_${set} PRIVATE
      KERNEL_NAME=${set} KERNEL_BYTES=${bytes} KERNEL_NV=${nv} KERNEL_NR=${nr})
    target_compile_options(kernels_${name}_${set} PRIVATE
      -O3 -ffp-contract=fast -fno-math-errno -Wall -Wextra -Wno-psabi -fno-sanitize=all ${ARGN})
    # Each kernel file alone: with products contracted, the bits depend on what is inlined together.
    set_target_properties(kernels_${name}_${set} PROPERTIES UNITY_BUILD OFF)
    list(APPEND objects $<TARGET_OBJECTS:kernels_${name}_${set}>)
  endmacro()
  one_set(sse2 16 2 4)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    one_set(avx2 32 3 4 -mavx2 -mfma -mf16c)
    one_set(avx512 64 3 8 -mavx512f -mavx512dq -mavx512vl -mavx2 -mfma -mf16c -mprefer-vector-width=512)
  endif()
  set(${out} ${objects} PARENT_SCOPE)
endfunction()

# The solver on an OpenCL device: its kernels become a text of the program. It is left out without OpenCL's headers.
function(insula_opencl list_name)
  set(folder ${PROJECT_SOURCE_DIR}/core/linalg/opencl)
  if(NOT OPENCL_INCLUDE)
    list(FILTER ${list_name} EXCLUDE REGEX "/linalg/opencl/")
    set(${list_name} ${${list_name}} PARENT_SCOPE)
    return()
  endif()
  list(FILTER ${list_name} EXCLUDE REGEX "/opencl_solver_absent\\.cpp$")
  set(text "// generated: the text of the kernels\n#include \"core/linalg/opencl/source.h\"\n")
  string(APPEND text "const char* insula::opencl::kernel_source() {\n  return\n")
  foreach(file front_record.h common.cl factor.cl solve.cl compliance.cl)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${file})
    file(READ ${folder}/${file} content)
    string(APPEND text "R\"~insula~(${content})~insula~\"\n")
  endforeach()
  string(APPEND text ";\n}\n")
  set(output ${CMAKE_BINARY_DIR}/generated/opencl_source.cpp)
  set(before)
  if(EXISTS ${output})
    file(READ ${output} before)
  endif()
  if(NOT before STREQUAL text)
    file(WRITE ${output} "${text}")
  endif()
  set(${list_name} ${${list_name}} ${output} PARENT_SCOPE)
endfunction()

function(insula_room name)  # insula_room(NAME USES room... LIBS library...)
  cmake_parse_arguments(R "" "" "USES;LIBS" ${ARGN})
  insula_glob(sources core/${name}/*.cpp platform/${INSULA_PLATFORM}/${name}/*.cpp)
  if(name STREQUAL "linalg")
    insula_opencl(sources)
  endif()
  file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS core/${name}/*kernels_impl.cpp)
  set(objects)
  if(kernel_files)
    insula_kernels(objects ${name} ${kernel_files})
  endif()
  set(insula_core_kernels ${insula_core_kernels} ${objects} PARENT_SCOPE)
  add_library(insula_${name} OBJECT ${sources})
  add_dependencies(insula_${name} insula_headers_hash)
  set(used)
  foreach(other IN LISTS R_USES)
    list(APPEND used insula_link_${other})
  endforeach()
  target_include_directories(insula_${name} SYSTEM PUBLIC ${CHOLMOD_INCLUDE})
  target_compile_definitions(insula_${name} PUBLIC EIGEN_DONT_PARALLELIZE)
  target_link_libraries(insula_${name} PUBLIC Eigen3::Eigen ${R_LIBS})
  list(APPEND objects $<TARGET_OBJECTS:insula_${name}>)
  # The room alone, which only proves that it needs no other rooms than those it names.
  add_library(insula_link_${name} SHARED ${objects})
  target_link_libraries(insula_link_${name} PRIVATE ${used} ${R_LIBS} Eigen3::Eigen)
  target_link_options(insula_link_${name} PRIVATE LINKER:-z,defs)
  set_target_properties(insula_link_${name} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/rooms LINKER_LANGUAGE CXX)
  set(insula_core_objects ${insula_core_objects} ${objects} PARENT_SCOPE)
  set(insula_core_sources ${insula_core_sources} ${sources} PARENT_SCOPE)
  string(REPLACE ";" "," uses "${R_USES}")
  file(APPEND ${CMAKE_BINARY_DIR}/rooms.txt "${name}:${uses}\n")
endfunction()

file(WRITE ${CMAKE_BINARY_DIR}/rooms.txt "")
insula_room(base LIBS fmt::fmt spdlog::spdlog Threads::Threads)
insula_room(xml USES base LIBS EXPAT::EXPAT)
insula_room(container USES base LIBS PkgConfig::ZSTD ZLIB::ZLIB fmt::fmt)
insula_room(params USES base LIBS fmt::fmt)
insula_room(registry USES base params LIBS spdlog::spdlog ${CMAKE_DL_LIBS})
insula_room(scene USES base params registry xml LIBS fmt::fmt)
insula_room(linalg USES base LIBS ${CHOLMOD_LIBRARY} spdlog::spdlog Threads::Threads)
insula_room(constraint USES base linalg LIBS fmt::fmt)
insula_room(model USES base xml
  LIBS EXPAT::EXPAT PkgConfig::ASSIMP PkgConfig::URDFDOM nlohmann_json::nlohmann_json ZLIB::ZLIB fmt::fmt)
insula_room(collision USES base linalg model)
insula_room(mechanics USES base params registry linalg constraint model collision LIBS fmt::fmt)
insula_room(sim USES base xml params registry scene linalg constraint collision mechanics
  LIBS nlohmann_json::nlohmann_json fmt::fmt spdlog::spdlog)

add_library(insula_core STATIC ${insula_core_objects})
add_dependencies(insula_core insula_headers_hash)
target_include_directories(insula_core SYSTEM PUBLIC ${CHOLMOD_INCLUDE})
target_compile_definitions(insula_core PUBLIC EIGEN_DONT_PARALLELIZE)
target_link_libraries(insula_core PUBLIC Eigen3::Eigen fmt::fmt spdlog::spdlog nlohmann_json::nlohmann_json
  EXPAT::EXPAT PkgConfig::ASSIMP PkgConfig::URDFDOM ${CHOLMOD_LIBRARY}
  Threads::Threads ZLIB::ZLIB PkgConfig::ZSTD ${CMAKE_DL_LIBS})
