# SPDX-License-Identifier: GPL-3.0-or-later
# The dense kernels and those of plugins (plugins/<name>/kernels_impl.cpp), once per instruction set, always optimised the same
# way: their bits must not depend on the build type.
file(GLOB plugin_kernels CONFIGURE_DEPENDS plugins/*/kernels_impl.cpp)
function(insula_kernels name bytes nv nr)
  add_library(kernels_${name} OBJECT core/linalg/kernels_impl.cpp core/linalg/fp16_kernels_impl.cpp core/constraint/kernels_impl.cpp core/collision/search/kernels_impl.cpp ${plugin_kernels})
  target_compile_definitions(kernels_${name} PRIVATE KERNEL_NAME=${name} KERNEL_BYTES=${bytes} KERNEL_NV=${nv} KERNEL_NR=${nr})
  target_compile_options(kernels_${name} PRIVATE -O3 -ffp-contract=fast -fno-math-errno -Wall -Wextra -Wno-psabi -fno-sanitize=all ${ARGN})
  target_sources(insula_core PRIVATE $<TARGET_OBJECTS:kernels_${name}>)
endfunction()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  insula_kernels(sse2 16 2 4)
  insula_kernels(avx2 32 3 4 -mavx2 -mfma -mf16c)
  insula_kernels(avx512 64 3 8 -mavx512f -mavx512dq -mavx512vl -mavx2 -mfma -mf16c -mprefer-vector-width=512)
else()
  insula_kernels(sse2 16 2 4)
endif()
