// SPDX-License-Identifier: GPL-3.0-or-later
// Numeric factor and single right-hand sides. Many right-hand sides: opencl_compliance.cpp.
#include "core/linalg/opencl/opencl_cholesky.h"

#include <limits>

namespace insula::opencl {

void OpenclCholesky::analyse(const BlockMatrix& a) {
  constexpr int lanes = 8;  // columns begin at a multiple of 64 bytes
  e_.analyse(a, lanes);
  plan_ = Plan(e_, a);
  rows_ = {};
  second_rows_ = {};
  loaded_ = false;
  if (e_.nodes == 0) return;
  device_.upload_all(fronts_, plan_.fronts);
  device_.upload_all(children_, plan_.children);
  device_.upload_all(map_, e_.map);
  device_.upload_all(index_, e_.row_node);
  device_.upload_all(tasks_, plan_.tasks);
  device_.upload_all(scatter_target_, plan_.scatter_target);
  device_.upload_all(scatter_, plan_.scatter);
  device_.upload_all(diagonal_, plan_.diagonal);
  const std::size_t size = 3 * std::size_t(e_.nodes);
  permuted_.resize(size);
  device_.reserve<double>(values_, 9 * std::size_t(a.slots()));
  device_.reserve<double>(panels_, std::size_t(e_.panel_size));
  device_.reserve<double>(inverses_, std::size_t(plan_.inverse_size));
  device_.reserve<int>(bad_, 1);
  for (Buffer& b : updates_) device_.reserve<double>(b, std::size_t(plan_.update_size));
  for (Buffer& b : carried_one_) device_.reserve<double>(b, std::size_t(plan_.carried_rows));
  device_.reserve<double>(x_, size);
  device_.reserve<double>(load_, size);
}

void OpenclCholesky::queue_factor(const BlockMatrix& a) {
  constexpr double least = 16 * std::numeric_limits<double>::epsilon(), largest = std::numeric_limits<double>::max();
  ++factor_number_;
  device_.upload(values_, a.block(0), 9 * std::size_t(a.slots()));
  device_.fill_zero(bad_, sizeof(int));
  device_.fill_zero(panels_, sizeof(double) * std::size_t(e_.panel_size));
  const int blocks = int(plan_.scatter.size());
  device_.run(Kernel::scatter, std::size_t((blocks + group - 1) / group), group, values_, scatter_target_, scatter_,
              blocks, panels_);
  for (std::size_t i = 0; i < plan_.levels.size(); ++i) {
    const Level& level = plan_.levels[i];
    const Buffer &mine = updates_[i % 2], &below = updates_[(i + 1) % 2];
    device_.run(Kernel::assemble, std::size_t(level.assemble.count), group, fronts_, children_, map_, tasks_,
                level.assemble.first, panels_, mine, below);
    for (const Level::Block& b : level.blocks) {
      device_.run(Kernel::update_block, std::size_t(b.update.count), group, fronts_, tasks_, b.update.first, panels_);
      device_.run(Kernel::factor_diagonal, std::size_t(b.diagonal.count), group, fronts_, tasks_, b.diagonal.first,
                  panels_, inverses_, values_, diagonal_, least, largest, bad_);
      device_.run(Kernel::solve_block, std::size_t(b.solve.count), group, fronts_, tasks_, b.solve.first, panels_,
                  inverses_);
    }
    device_.run(Kernel::subtract_update, std::size_t(level.subtract.count), group, fronts_, tasks_,
                level.subtract.first, panels_, mine);
  }
}

bool OpenclCholesky::factor_is_good() {
  int bad = 1;
  device_.download(bad_, &bad, 1);
  return bad == 0;
}

bool OpenclCholesky::factorise(const BlockMatrix& a) {
  loaded_ = false;
  if (e_.nodes == 0) return true;
  queue_factor(a);
  return factor_is_good();
}

void OpenclCholesky::queue_forward(const Buffer& x) {
  for (std::size_t i = 0; i < plan_.levels.size(); ++i) {
    const TaskRange& all = plan_.levels[i].all;
    device_.run(Kernel::forward_one, std::size_t(all.count), line_group, fronts_, children_, map_, tasks_, all.first,
                panels_, inverses_, x, carried_one_[i % 2], carried_one_[(i + 1) % 2]);
  }
}

void OpenclCholesky::queue_backward(const Buffer& x) {
  for (auto level = plan_.levels.rbegin(); level != plan_.levels.rend(); ++level)
    device_.run(Kernel::backward_one, std::size_t(level->all.count), line_group, fronts_, index_, tasks_,
                level->all.first, panels_, inverses_, x);
}

void OpenclCholesky::put(const double* natural, const Buffer& to) {
  e_.permute(natural, permuted_.data());
  device_.upload(to, permuted_.data(), permuted_.size());
}

void OpenclCholesky::get(const Buffer& from, double* natural) {
  device_.download(from, permuted_.data(), permuted_.size());
  e_.restore(permuted_.data(), natural);
}

void OpenclCholesky::solve(double* x) {
  if (e_.nodes == 0) return;
  put(x, x_);
  queue_forward(x_);
  queue_backward(x_);
  get(x_, x);
}

bool OpenclCholesky::begin_motion(const BlockMatrix* a, const VecX& load, const VecX&) {
  loaded_ = true;
  if (e_.nodes == 0) return true;
  if (a) queue_factor(*a);
  put(load.data(), load_);
  queue_forward(load_);
  if (a) return factor_is_good();
  device_.flush();
  return true;
}

void OpenclCholesky::unforced_motion(const VecX&, VecX& x) { end_motion({}, nullptr, x); }

void OpenclCholesky::end_motion(const BodyRows& rows, const double* lambda, VecX& x) {
  x.resize(3 * e_.nodes);
  if (e_.nodes == 0) return;
  device_.copy(load_, x_, sizeof(double) * permuted_.size());
  if (rows.count() > 0 && rows_.columns > 0) {
    rows_.lambda.assign(std::size_t(rows_.ldy), 0.0);
    for (std::size_t c = 0; c < rows_.order.size(); ++c)
      rows_.lambda[c] = lambda[rows.row[std::size_t(rows_.order[c])]];
    device_.upload(rows_.lambda_there, rows_.lambda.data(), rows_.lambda.size());
    device_.run(Kernel::combine, rows_.reached.size(), group, fronts_, rows_.reached_there, rows_.reach_there, rows_.y,
                rows_.ldy, rows_.lambda_there, x_);
  }
  queue_backward(x_);
  get(x_, x.data());
}

}  // namespace insula::opencl
