// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/asynchronous_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace insula {
namespace {

constexpr double hardly =
    0.02;  ///< a row keeps its compliance if its entries changed by less than this part of the largest one
constexpr double poor = 0.05;  ///< a factor that reduces the error by less than this in an iteration is replaced

double largest(const std::vector<double>& x) {
  double out = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3)
    out = std::max(out, x[i] * x[i] + x[i + 1] * x[i + 1] + x[i + 2] * x[i + 2]);
  return std::sqrt(out);
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
  for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

AsynchronousSolver::AsynchronousSolver(double tolerance) : tolerance_(tolerance) {}

void AsynchronousSolver::analyse(const BlockMatrix& a) {
  front_ = std::make_unique<StaleFactor>(a);
  background_.prepare(a, *front_);
  const std::size_t n = 3 * std::size_t(a.nodes());
  for (std::vector<double>* v : {&b_, &r_, &z_, &p_, &ap_, &last_x_, &difference_, &lagged_, &given_, &left_})
    v->assign(n, 0.0);
  rotation_.assign(std::size_t(a.nodes()), Mat3::Identity());
  since_ = factor_rotation_ = requested_rotation_ = rotation_;
}

void AsynchronousSolver::set_rotations(const std::vector<Mat3>& rotation) { rotation_ = rotation; }

bool AsynchronousSolver::factorise(const BlockMatrix& a) {
  a_ = &a;
  took_ = false;
  if (!usable_) {
    status_ = {};
    if (!front_->factorise(a)) return false;
    usable_ = true;
    factor_rotation_ = rotation_;
    factor_is_new_ = true;
    ++status_.factors;
  } else {
    ++status_.age;
    take();
    if (status_.iterations > enough_iterations || seen_ > poor) ask();
    quality_ = std::min(1.0, 2 * quality_);  // the estimate of an earlier step is less reliable
  }
  take_next_ = false;
  status_.iterations = 0;
  status_.residual_m = 0;
  lagged_.swap(given_);
  std::fill(given_.begin(), given_.end(), 0.0);
  std::fill(left_.begin(), left_.end(), 0.0);
  for (std::size_t i = 0; i < since_.size(); ++i) since_[i].noalias() = rotation_[i] * factor_rotation_[i].transpose();
  return true;
}

void AsynchronousSolver::precondition(const double* r, double* z) {
  for (std::size_t i = 0; i < since_.size(); ++i)
    Eigen::Map<Vec3>(z + 3 * i) = since_[i].transpose() * Eigen::Map<const Vec3>(r + 3 * i);
  front_->fp16.solve(z);
  for (std::size_t i = 0; i < since_.size(); ++i)
    Eigen::Map<Vec3>(z + 3 * i) = (since_[i] * Eigen::Map<Vec3>(z + 3 * i)).eval();
}

// Preconditioned conjugate gradients from x. The remaining error is estimated from the reduction in the last
// iterations, since its computation would cost as much as another iteration.
double AsynchronousSolver::refine(const double* b, double* x, double tolerance) {
  const std::size_t n = r_.size();
  std::fill(ap_.begin(), ap_.end(), 0.0);
  a_->add_product(x, ap_.data());
  for (std::size_t i = 0; i < n; ++i) r_[i] = b[i] - ap_[i];
  double before = 0, size = 0, left = 0;
  int k = 0;
  while (k < max_iterations) {
    precondition(r_.data(), z_.data());
    const double last = size;
    size = largest(z_);
    if (k > 0 && last > 0) {
      seen_ = size / last;
      quality_ = std::max(seen_, 0.25 * quality_);  // one good iteration is not reliable
    }
    const double rz = product(r_, z_), beta = k > 0 ? rz / before : 0;
    before = rz;
    for (std::size_t i = 0; i < n; ++i) p_[i] = z_[i] + beta * p_[i];
    std::fill(ap_.begin(), ap_.end(), 0.0);
    a_->add_product(p_.data(), ap_.data());
    const double curvature = product(p_, ap_);
    ++k;
    if (!(curvature > 0)) break;
    const double alpha = rz / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * p_[i];
      r_[i] -= alpha * ap_[i];
    }
    left = size * std::min(1.0, quality_);
    if (left <= tolerance) break;
  }
  status_.iterations = std::max(status_.iterations, k);
  return left;
}

void AsynchronousSolver::solve(double* x) {
  std::copy_n(x, b_.size(), b_.data());
  std::fill_n(x, b_.size(), 0.0);
  status_.residual_m = refine(b_.data(), x, tolerance_);
}

bool AsynchronousSolver::begin_motion(const BlockMatrix* a, const VecX& load, const VecX& guess) {
  if (a && !factorise(*a)) return false;
  for (std::size_t i = 0; i < b_.size(); ++i) b_[i] = load[long(i)] + lagged_[i];
  free_ = guess;
  status_.residual_m = refine(b_.data(), free_.data(), early * tolerance_);
  left_ = r_;
  return true;
}

void AsynchronousSolver::end_motion(const BodyRows& rows, const double* lambda, VecX& x) {
  x = free_;
  const std::vector<double>& correction = correct(rows, lambda);
  x += Eigen::Map<const VecX>(correction.data(), long(correction.size()));
}

void AsynchronousSolver::add_rows_of(const double* x, const BodyRows& rows, double* delta) const {
  for (int i = 0; i < rows.count(); ++i)
    for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
      if (const int node = (*nodes_of_block_)[std::size_t(rows.block[std::size_t(e)])]; node >= 0)
        delta[rows.row[std::size_t(i)]] += rows.coeff[std::size_t(e)].dot(Eigen::Map<const Vec3>(x + 3 * node));
}

void AsynchronousSolver::begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
  std::swap(rotated_rows_, rows_before_);
  rotated_rows_.row.resize(rows.row.size());
  std::iota(rotated_rows_.row.begin(), rotated_rows_.row.end(), 0);
  rotated_rows_.start = rows.start;
  rotated_rows_.block = rows.block;
  rotated_rows_.coeff.resize(rows.coeff.size());
  for (std::size_t e = 0; e < rows.coeff.size(); ++e)
    if (const int node = node_of_block[std::size_t(rows.block[e])]; node >= 0)
      rotated_rows_.coeff[e].noalias() = since_[std::size_t(node)].transpose() * rows.coeff[e];
    else rotated_rows_.coeff[e].setZero();
  nodes_of_block_ = &node_of_block;
  add_lagged_row(node_of_block);
  if (!factor_is_new_) keep_rows();
  factor_is_new_ = false;
  front_->full.begin_compliance(rotated_rows_, node_of_block);
  corrected_ = false;
  const std::size_t all = std::size_t(rotated_rows_.count());
  s_.resize(all * all);
}

// Adds the lagged forces as a row whose lambda is -1. Their effect is then subtracted with the same compliance with
// which lambda adds it.
void AsynchronousSolver::add_lagged_row(const std::vector<int>& node_of_block) {
  if (block_of_node_.empty()) {
    block_of_node_.resize(lagged_.size() / 3);
    for (std::size_t k = 0; k < node_of_block.size(); ++k)
      if (node_of_block[k] >= 0) block_of_node_[std::size_t(node_of_block[k])] = int(k);
  }
  if (std::all_of(lagged_.begin(), lagged_.end(), [](double f) { return f == 0; })) return;
  rotated_rows_.open(rotated_rows_.count());
  for (std::size_t i = 0; i < since_.size(); ++i) {
    const Eigen::Map<const Vec3> force(lagged_.data() + 3 * i);
    if (!force.isZero(0)) rotated_rows_.add(block_of_node_[i], since_[i].transpose() * force);
  }
}

void AsynchronousSolver::add_compliance(const BodyRows& rows, double* w, int stride) {
  const std::size_t m = std::size_t(rows.count()), all = std::size_t(rotated_rows_.count());
  if (m == 0) return;
  std::fill(s_.begin(), s_.end(), 0.0);
  front_->full.add_compliance(rotated_rows_, s_.data(), int(all));
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j)
      w[std::size_t(rows.row[i]) * std::size_t(stride) + std::size_t(rows.row[j])] += s_[i * all + j];
}

void AsynchronousSolver::subtract_lagged(const BodyRows& rows, double* delta) const {
  const std::size_t m = std::size_t(rows.count()), all = std::size_t(rotated_rows_.count());
  if (all == m) return;
  for (std::size_t i = 0; i < m; ++i) delta[rows.row[i]] -= s_[i * all + m];
}

// Rows rotate a little in every step, and a row with the same bits costs nothing. So rows with small changes are kept,
// since the compliance is approximate anyway.
void AsynchronousSolver::keep_rows() {
  const BodyRows& old = rows_before_;
  for (int i = 0; i < rotated_rows_.count(); ++i) {
    const int begin = rotated_rows_.start[std::size_t(i)], size = rotated_rows_.start[std::size_t(i) + 1] - begin;
    for (int j = 0; j < old.count(); ++j) {
      const int from = old.start[std::size_t(j)];
      if (old.start[std::size_t(j) + 1] - from != size ||
          !std::equal(old.block.begin() + from, old.block.begin() + from + size, rotated_rows_.block.begin() + begin))
        continue;
      double most = 0, change = 0;
      for (int e = 0; e < size; ++e) {
        most = std::max(most, old.coeff[std::size_t(from + e)].squaredNorm());
        change = std::max(
            change, (old.coeff[std::size_t(from + e)] - rotated_rows_.coeff[std::size_t(begin + e)]).squaredNorm());
      }
      if (change > hardly * hardly * most) continue;
      std::copy_n(old.coeff.begin() + from, size, rotated_rows_.coeff.begin() + begin);
      break;
    }
  }
}

// Starts from the result of the last lambda, if there is one, plus the approximate compliance of the change. Then
// solves with the step's own matrix.
const std::vector<double>& AsynchronousSolver::correct(const BodyRows& rows, const double* lambda) {
  const std::size_t m = std::size_t(rows.count()), n = b_.size();
  bool moved = !corrected_;
  change_.assign(std::size_t(rotated_rows_.count()), 0.0);
  if (!corrected_) {
    last_lambda_.assign(m, 0.0);
    std::fill(last_x_.begin(), last_x_.end(), 0.0);
    if (change_.size() > m) change_[m] = -1;  // the lagged forces
    lacks_ = 1;
    corrected_ = true;
  }
  for (std::size_t i = 0; i < m; ++i) {
    change_[i] = lambda[rows.row[i]] - last_lambda_[i];
    last_lambda_[i] = lambda[rows.row[i]];
    moved = moved || change_[i] != 0;
  }
  if (moved) {
    front_->fp16.correct(rotated_rows_, change_.data(), difference_.data());
    for (std::size_t i = 0; i < since_.size(); ++i)
      Eigen::Map<Vec3>(difference_.data() + 3 * i) = (since_[i] * Eigen::Map<Vec3>(difference_.data() + 3 * i)).eval();
    for (std::size_t i = 0; i < n; ++i) last_x_[i] += difference_[i];
    // The error of a change is that of the factor, and of its rows, which may differ by `hardly`.
    lacks_ += largest(difference_) * std::max(quality_, hardly);
    std::fill(given_.begin(), given_.end(), 0.0);
    for (std::size_t i = 0; i < m; ++i)
      for (int e = rows.start[i]; e < rows.start[i + 1]; ++e)
        if (const int node = (*nodes_of_block_)[std::size_t(rows.block[std::size_t(e)])]; node >= 0)
          Eigen::Map<Vec3>(given_.data() + 3 * node) += lambda[rows.row[i]] * rows.coeff[std::size_t(e)];
  }
  if (lacks_ > tolerance_) {
    for (std::size_t i = 0; i < n; ++i) b_[i] = given_[i] - lagged_[i] + left_[i];
    lacks_ = refine(b_.data(), last_x_.data(), tolerance_);
  }
  status_.residual_m = lacks_;
  return last_x_;
}

void AsynchronousSolver::reset() {
  background_.drop();
  usable_ = take_next_ = took_ = false;
  quality_ = 1;
  seen_ = 0;
  std::fill(given_.begin(), given_.end(), 0.0);
  status_ = {};
}

void AsynchronousSolver::ask() {
  if (!background_.idle()) return;
  background_.ask(*a_);
  requested_rotation_ = rotation_;
  asked_steps_ = 0;
}

void AsynchronousSolver::take() {
  ++asked_steps_;
  if (timing_ == FactorTiming::counted && asked_steps_ < delay()) return;
  if (timing_ == FactorTiming::told && !take_next_) return;
  const BackgroundFactor::Answer answer = background_.take(front_, timing_ != FactorTiming::when_ready);
  took_ = answer == BackgroundFactor::Answer::good || answer == BackgroundFactor::Answer::bad;
  if (answer != BackgroundFactor::Answer::good) return;
  factor_is_new_ = true;
  std::swap(factor_rotation_, requested_rotation_);
  status_.age = asked_steps_;
  quality_ = 1;
  seen_ = 0;
  ++status_.factors;
}

}  // namespace insula
