// SPDX-License-Identifier: GPL-3.0-or-later
// In single precision, coefficients between distant nodes fall below the smallest normal number, where processors are a
// hundred times slower. While an object of this class exists, such numbers are zero on its thread. They are far below
// the rounding error of the results.
#pragma once
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace insula {

template <class Real>
struct FlushSubnormals {};  // the range of double precision suffices

#if defined(__x86_64__)
template <>
struct FlushSubnormals<float> {
  FlushSubnormals() : before(_mm_getcsr()) { _mm_setcsr(before | 0x8040u); }  // results and operands
  ~FlushSubnormals() { _mm_setcsr(before); }
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;
  unsigned before;
};
#endif

}  // namespace insula
