// SPDX-License-Identifier: GPL-3.0-or-later
// The true lanes of a comparison as the bits of a number, for loops compiled once per instruction set. Without it,
// compilers read the lanes one by one although the processor has a single instruction.
#pragma once
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace insula::KERNEL_NAME {

/// `Mask`: the result of comparing two vectors, each lane all ones or all zeros.
template <class Mask>
inline unsigned lane_bits(Mask m) {
  constexpr int bytes = sizeof(m[0]), lanes = int(sizeof m) / bytes;
#if defined(__AVX512DQ__)
  if constexpr (sizeof m == 64 && bytes == 8) return _mm512_movepi64_mask((__m512i)m);
  if constexpr (sizeof m == 64 && bytes == 4) return _mm512_movepi32_mask((__m512i)m);
#endif
#if defined(__AVX2__)
  if constexpr (sizeof m == 32 && bytes == 8) return unsigned(_mm256_movemask_pd((__m256d)m));
  if constexpr (sizeof m == 32 && bytes == 4) return unsigned(_mm256_movemask_ps((__m256)m));
#endif
#if defined(__SSE2__)
  if constexpr (sizeof m == 16 && bytes == 8) return unsigned(_mm_movemask_pd((__m128d)m));
  if constexpr (sizeof m == 16 && bytes == 4) return unsigned(_mm_movemask_ps((__m128)m));
#endif
  unsigned out = 0;
  for (int i = 0; i < lanes; ++i) out |= m[i] ? 1u << i : 0u;
  return out;
}

}  // namespace insula::KERNEL_NAME
