// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/fp16_factor.h"

#include <algorithm>

#include "core/linalg/flush_subnormals.h"
#include "core/linalg/instruction_set.h"

namespace insula {

INSULA_TABLES(Fp16Kernels, fp16_table)
const Fp16Kernels& fp16_kernels() { return every_fp16_table().chosen(); }

Fp16Factor::Fp16Factor(const MultifrontalCholesky<float>& factor) : factor_(&factor) {
  const Elimination& e = factor.elimination();
  long size = 0, largest = 0;
  int rows = 0;
  for (const Front& f : e.front) {
    rows = std::max(rows, 3 * f.rows);
    for (int c = 0; c < 3 * f.own; c += half_columns_from(c, 3 * f.own)) {
      const long block = half_block_size(3 * f.rows, c, half_columns_from(c, 3 * f.own));
      size += block;
      largest = std::max(largest, block);
    }
  }
  stream_.assign(std::size_t(size), Half(0));
  block_.assign(std::size_t(largest), 0.f);
  front_.assign(std::size_t(rows + 2 * half_lanes), 0.f);
  x_.assign(3 * std::size_t(e.nodes), 0.f);
  inverse_root_ = x_;
}

void Fp16Factor::round() {
  const FlushSubnormals<float> flush;
  const Fp16Kernels& k = fp16_kernels();
  const Elimination& e = factor_->elimination();
  Half* to = stream_.data();
  for (const Front& f : e.front) {
    const float* panel = factor_->panels() + f.panel;
    const int own = 3 * f.own, rows = 3 * f.rows;
    float* inverse = inverse_root_.data() + 3 * f.first;
    for (int c = 0; c < own; ++c) inverse[c] = 1 / panel[c + long(c) * f.lda];
    for (int first = 0; first < own;) {
      const int n = half_columns_from(first, own), last = first + n;
      const long size = half_block_size(rows, first, n);
      std::fill_n(block_.begin(), size, 0.f);
      float* triangle = block_.data();
      for (int c = first; c < last; ++c) {
        const float* l = panel + long(c) * f.lda;
        for (int r = c + 1; r < last; ++r) *triangle++ = l[r] * inverse[c];
        float* below = block_.data() + half_lanes + long(c - first) * half_lanes;
        for (int r = last; r < rows; ++r)
          below[long((r - last) / half_lanes) * half_lanes * n + (r - last) % half_lanes] = l[r] * inverse[c];
      }
      k.to_half(to, block_.data(), size);
      to += size;
      first = last;
    }
  }
}

void Fp16Factor::forward() {
  const Fp16Kernels& k = fp16_kernels();
  const Elimination& e = factor_->elimination();
  float* t = front_.data();
  const Half* s = stream_.data();
  for (const Front& f : e.front) {
    const int own = 3 * f.own, rows = 3 * f.rows;
    const int* index = e.row_scalar.data() + 3 * f.row_begin;
    std::copy_n(x_.begin() + 3 * f.first, own, t);
    for (int r = own; r < rows; ++r) t[r] = x_[std::size_t(index[r])];
    s = k.forward(t, s, own, rows);
    std::copy_n(t, own, x_.begin() + 3 * f.first);
    for (int r = own; r < rows; ++r) x_[std::size_t(index[r])] = t[r];
  }
}

void Fp16Factor::backward() {
  const Fp16Kernels& k = fp16_kernels();
  const Elimination& e = factor_->elimination();
  float* t = front_.data();
  const Half* s = stream_.data() + stream_.size();
  for (auto f = e.front.rbegin(); f != e.front.rend(); ++f) {
    const int own = 3 * f->own, rows = 3 * f->rows;
    const int* index = e.row_scalar.data() + 3 * f->row_begin;
    std::copy_n(x_.begin() + 3 * f->first, own, t);
    for (int r = own; r < rows; ++r) t[r] = x_[std::size_t(index[r])];
    std::fill_n(t + rows, half_lanes, 0.f);
    s = k.backward(t, s, own, rows);
    std::copy_n(t, own, x_.begin() + 3 * f->first);
  }
}

void Fp16Factor::solve(double* x) {
  const FlushSubnormals<float> flush;
  factor_->elimination().permute(x, x_.data());
  forward();
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i] *= inverse_root_[i] * inverse_root_[i];
  backward();
  factor_->elimination().restore(x_.data(), x);
}

void Fp16Factor::correct(const BodyRows& rows, const double* lambda, double* x) {
  const FlushSubnormals<float> flush;
  std::fill(x_.begin(), x_.end(), 0.f);
  factor_->combine(rows, lambda, x_.data());
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i] *= inverse_root_[i];
  backward();
  factor_->elimination().restore(x_.data(), x);
}

}  // namespace insula
