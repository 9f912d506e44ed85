// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set, as kernels_impl.cpp is.
#if defined(__F16C__)
#include <immintrin.h>
#endif
#include <cstring>

#include "core/linalg/fp16_kernels.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_BYTES / 4;  // numbers a vector
constexpr int parts = half_lanes / W;
typedef float V __attribute__((vector_size(KERNEL_BYTES), aligned(4), may_alias));

inline V load(const float* p) { return *reinterpret_cast<const V*>(p); }
inline void store(float* p, V v) { *reinterpret_cast<V*>(p) = v; }

#if defined(__AVX512F__)
inline V widened(const Half* p) {
  return V(_mm512_maskz_cvtph_ps(0xffff, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))));
}
inline float widened_one(Half h) { return _cvtsh_ss(h); }
#elif defined(__F16C__)
inline V widened(const Half* p) { return V(_mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)))); }
inline float widened_one(Half h) { return _cvtsh_ss(h); }
#else
// Exponent and fraction are shifted to their positions, then multiplied by 2^112 for the difference of the exponents'
// biases.
inline V widened(const Half* p) {
  typedef unsigned U __attribute__((vector_size(KERNEL_BYTES)));
  U u;
  for (int i = 0; i < W; ++i) u[i] = p[i];
  const U magnitude = (u & 0x7fffu) << 13, sign = (u & 0x8000u) << 16;
  return V(U(V(magnitude) * 0x1p112f) | sign);
}
inline float widened_one(Half h) {
  const unsigned magnitude = (h & 0x7fffu) << 13, sign = (h & 0x8000u) << 16;
  float f;
  std::memcpy(&f, &magnitude, 4);
  f *= 0x1p112f;
  return sign ? -f : f;
}
#endif

constexpr float largest_half = 65504;

#if !defined(__F16C__)
/// The nearest half of a number that is at most largest_half in size; of two, the even one.
inline Half nearest_half(float x) {
#if defined(__FLT16_MANT_DIG__)
  const _Float16 h = static_cast<_Float16>(x);
  Half out;
  std::memcpy(&out, &h, 2);
  return out;
#else
  // clang 14 has no _Float16 for x86. Adding 2^13 times the unit of x's exponent lets the addition round.
  const float size = x < 0 ? -x : x;
  unsigned sign, bits;
  std::memcpy(&sign, &x, 4);
  std::memcpy(&bits, &size, 4);
  const unsigned lowest = 113u << 23;  // 2^-14, the least normal half
  const unsigned exponent = ((bits > lowest ? bits : lowest) & 0x7f800000u) + (13u << 23);
  float large;
  std::memcpy(&large, &exponent, 4);
  const float rounded = (size + large) - large;
  const float scaled = rounded * 0x1p-112f;
  std::memcpy(&bits, &scaled, 4);
  return Half((sign >> 16 & 0x8000u) | bits >> 13);
#endif
}
#endif

void to_half(Half* out, const float* in, long n) {
  const auto bounded = [](float x) {
    return x < largest_half ? (x > -largest_half ? x : -largest_half) : largest_half;
  };
  long i = 0;
#if defined(__F16C__)
  for (; i + 8 <= n; i += 8) {
    const __m256 most = _mm256_set1_ps(largest_half), x = _mm256_loadu_ps(in + i);
    const __m256 within = _mm256_max_ps(_mm256_min_ps(x, most), _mm256_sub_ps(_mm256_setzero_ps(), most));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), _mm256_cvtps_ph(within, _MM_FROUND_TO_NEAREST_INT));
  }
  for (; i < n; ++i) {
    const __m128i half = _mm_cvtps_ph(_mm_set_ss(bounded(in[i])), _MM_FROUND_TO_NEAREST_INT);
    out[i] = std::uint16_t(_mm_extract_epi16(half, 0));
  }
#else
  for (; i < n; ++i) out[i] = nearest_half(bounded(in[i]));
#endif
}

template <int n>
inline __attribute__((always_inline)) const Half* forward_columns(float* t, const Half* s, int rows) {
  for (int c = 0; c < n; ++c)
    for (int r = c + 1; r < n; ++r) t[r] -= widened_one(*s++) * t[c];
  s += half_lanes - n * (n - 1) / 2;
  float x[n];
  for (int c = 0; c < n; ++c) x[c] = t[c];
  for (int r = n; r < rows; r += half_lanes, s += half_lanes * n)
#pragma GCC unroll 4
    for (int v = 0; v < parts; ++v) {
      const Half* a = s + v * W;
      V sum = widened(a) * x[0];
#pragma GCC unroll 8
      for (int c = 1; c < n; ++c) sum += widened(a + c * half_lanes) * x[c];
      store(t + r + v * W, load(t + r + v * W) - sum);
    }
  return s;
}

template <int n>
inline __attribute__((always_inline)) void backward_columns(float* t, const Half* s, int rows) {
  V sum[n];
  for (int c = 0; c < n; ++c) sum[c] = V{};
  const Half* a = s + half_lanes;
  for (int r = n; r < rows; r += half_lanes, a += half_lanes * n)
#pragma GCC unroll 4
    for (int v = 0; v < parts; ++v) {
      const V x = load(t + r + v * W);
#pragma GCC unroll 8
      for (int c = 0; c < n; ++c) sum[c] += widened(a + v * W + c * half_lanes) * x;
    }
  const Half* triangle = s + n * (n - 1) / 2;
  for (int c = n - 1; c >= 0; --c) {
    float less = 0;
    for (int i = 0; i < W; ++i) less += sum[c][i];
    triangle -= n - 1 - c;
    for (int r = c + 1; r < n; ++r) less += widened_one(triangle[r - c - 1]) * t[r];
    t[c] -= less;
  }
}

const Half* forward(float* t, const Half* s, int own, int rows) {
  for (int c = 0; c < own;) {
    const int n = half_columns_from(c, own);
    s = n == 3 ? forward_columns<3>(t + c, s, rows - c) : forward_columns<half_columns>(t + c, s, rows - c);
    c += n;
  }
  return s;
}

const Half* backward(float* t, const Half* end, int own, int rows) {
  for (int c = own; c > 0;) {
    c = (c - 1) / half_columns * half_columns;
    const int n = half_columns_from(c, own);
    end -= half_block_size(rows, c, n);
    if (n == 3) backward_columns<3>(t + c, end, rows - c);
    else backward_columns<half_columns>(t + c, end, rows - c);
  }
  return end;
}

}  // namespace

extern const Fp16Kernels fp16_table;
const Fp16Kernels fp16_table = {to_half, forward, backward};

}  // namespace insula::KERNEL_NAME
