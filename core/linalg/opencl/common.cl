// SPDX-License-Identifier: GPL-3.0-or-later
// What all kernels use. TILE, CHUNK, GROUP and LINE_GROUP are given when the program is built (device.cpp).
#pragma OPENCL EXTENSION cl_khr_fp64 : enable

typedef struct {
  int front, a, b, c;
} Task;

// First of n ascending numbers that is not below `least`.
int first_from(__global const int* numbers, int n, int least) {
  int begin = 0;
  while (n > 0) {
    const int half_way = n / 2;
    if (numbers[begin + half_way] < least) {
      begin += half_way + 1;
      n -= half_way + 1;
    } else {
      n = half_way;
    }
  }
  return begin;
}

// sum[i][j] += sum over p < k of a[r + p lda] b[c + p ldb], r = x + 8 i, c = y + 8 j, for the item (x, y) of 8 x 8.
// Only rows in [a_begin, a_end) and columns in [b_begin, b_end) are read; the others count as zero.
void multiply(double sum[4][4], __global const double* a, long lda, int a_begin, int a_end, __global const double* b,
              long ldb, int b_begin, int b_end, int k, __local double* as, __local double* bs) {
  const int me = get_local_id(0), x = me % 8, y = me / 8;
  for (int begin = 0; begin < k; begin += CHUNK) {
    const int depth = min(CHUNK, k - begin);
    for (int e = me; e < TILE * depth; e += GROUP) {
      const int r = e % TILE;
      const long p = begin + e / TILE;
      as[e] = r >= a_begin && r < a_end ? a[r + p * lda] : 0.0;
      bs[e] = r >= b_begin && r < b_end ? b[r + p * ldb] : 0.0;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int p = 0; p < depth; ++p) {
      double left[4], right[4];
      for (int i = 0; i < 4; ++i) {
        left[i] = as[TILE * p + x + 8 * i];
        right[i] = bs[TILE * p + y + 8 * i];
      }
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) sum[i][j] += left[i] * right[j];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

void clear(double sum[4][4]) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) sum[i][j] = 0.0;
}
