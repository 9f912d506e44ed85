// SPDX-License-Identifier: GPL-3.0-or-later
// Selection of rows for the haptic problem, and elimination of the others.
#include "core/haptics/condense.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/problem_fields.h"
#include "core/constraint/solve.h"
#include "core/constraint/sweep.h"
#include "core/haptics/condense_modes.h"
#include "core/haptics/weld_elimination.h"

namespace insula {
namespace {

/// A force this close to a bound is at it.
double near_bound_N(double bound) { return 1e-9 * (1 + std::abs(bound)); }

long padded(std::size_t n) { return long((n + 7) / 8 * 8); }

}  // namespace

void Condenser::find_rows_at_tools(const ConstraintProblem& full, std::vector<char>& at_tool) {
  at_tool.assign(std::size_t(full.rows), 0);
  for (std::size_t t = 0; t < std::min<std::size_t>(full.tools.size(), 2); ++t) {
    for (int r = 0; r < full.rows; ++r)
      if (!full.tools[t].jacobian.row(r).isZero(0)) at_tool[std::size_t(r)] = 1;
    // Contacts of a grasped body count as contacts of the tool, since the servo merges the two
    // (core/haptics/weld_elimination.h).
    const int weld = first_weld_row(full, t);
    for (int r = 0; weld >= 0 && r < full.rows; ++r)
      for (int k = 0; k < weld_rows; ++k)
        if (full.w_at(r, weld + k) != 0) at_tool[std::size_t(r)] = 1;
  }
}

void Condenser::find_tool_coupled_rows(const ConstraintProblem& full) {
  find_rows_at_tools(full, tool_coupled_);
  for (const Block& b : full.blocks)
    // Contacts between steps use the first. The second fail with a row at a tool.
    if (b.role == BlockRole::surface || b.failure_group != 0) tool_coupled_[std::size_t(b.row)] = 1;
  is_weld_.assign(std::size_t(full.rows), 0);
  for (std::size_t t = 0; t < std::min<std::size_t>(full.tools.size(), 2); ++t)
    if (const int weld = first_weld_row(full, t); weld >= 0) std::fill_n(is_weld_.begin() + weld, weld_rows, char(1));
}

/// Marks the block's rows that are linear in their present state. Returns its margin.
double Condenser::state(const ConstraintProblem& full, const Block& b) {
  const double* lambda = full.lambda.data() + b.row;
  const double* delta = delta_m_.data() + b.row;
  Fate* fate = fate_.data() + b.row;
  const auto w = [&](int k) { return full.w_at(b.row + k, b.row + k); };
  if (b.law == LawKind::box) {
    if (b.lower == -infinite && b.upper == infinite) {
      fate[0] = Fate::linear;
      return -1;
    }
    const double away_N = std::min(lambda[0] - b.lower, b.upper - lambda[0]);
    const double bound = lambda[0] - b.lower < b.upper - lambda[0] ? b.lower : b.upper;
    if (away_N <= near_bound_N(bound)) return std::abs(delta[0] + b.compliance * lambda[0]);
    fate[0] = Fate::linear;
    return away_N * w(0);
  }
  int tangent = 0;
  double pressed_N = 0, margin_m = infinite;
  if (b.law == LawKind::friction) {
    tangent = 1;
    pressed_N = lambda[0];
    if (pressed_N <= near_bound_N(0)) return std::abs(delta[0]);
    fate[0] = Fate::linear;
    margin_m = pressed_N * w(0);
  } else {
    for (int i = 1; i <= b.normals; ++i) pressed_N += std::max(0.0, *(lambda - i));
    if (pressed_N <= near_bound_N(0)) return infinite;  // its contacts determine this
  }
  const double left_N = b.friction * pressed_N - std::hypot(lambda[tangent], lambda[tangent + 1]);
  if (left_N <= 1e-6 * b.friction * pressed_N) {  // linear only across the slip
    if (b.friction > 0) fate[tangent] = Fate::slips;
    return 0;
  }
  fate[tangent] = fate[tangent + 1] = Fate::linear;
  return std::min(margin_m, left_N * std::max(w(tangent), w(tangent + 1)));
}

void Condenser::find_states(const ConstraintProblem& full) {
  full_delta(full, {full.delta_free.data(), std::size_t(full.rows)}, full.lambda.data(), delta_m_);
  fate_.assign(std::size_t(full.rows), Fate::held);
  margin_m_.clear();
  for (const Block& b : full.blocks) margin_m_.push_back(state(full, b));
}

void Condenser::make_groups(const ConstraintProblem& full) {
  groups_.clear();
  for (std::size_t b = 0; b < full.blocks.size(); ++b) {
    const Block& block = full.blocks[b];
    Group g{int(b), int(b), block.rows(), false, margin_m_[b] < 0, 0};
    for (int k = 0; k < block.rows(); ++k) {
      const int r = block.row + k;
      g.tool_coupled = g.tool_coupled || tool_coupled_[std::size_t(r)];
      double coupling = 0;
      for (int c = 0; c < full.rows; ++c)
        if (tool_coupled_[std::size_t(c)]) coupling = std::max(coupling, std::abs(full.w_at(r, c)));
      // Motion of the tools' rows if this row's force vanished. For rows without a tool: if it changed by a newton,
      // with a larger weight for rows that may soon leave their linear state.
      g.rank = std::max(
          g.rank, is_weld_[std::size_t(r)] ? infinite : (std::abs(full.lambda[std::size_t(r)]) + 1e-6) * coupling);
      if (!tool_coupled_[std::size_t(r)]) g.rank = std::max(g.rank, coupling / (std::abs(margin_m_[b]) + 1e-6));
    }
    if (block.law == LawKind::patch)
      for (int i = 0; i < block.normals; ++i) {
        const Group& contact = groups_.back();
        g = {contact.first,
             g.last,
             g.rows + contact.rows,
             g.tool_coupled || contact.tool_coupled,
             false,
             std::max(g.rank, contact.rank)};
        groups_.pop_back();
      }
    groups_.push_back(g);
  }
  std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
    if (a.tool_coupled != b.tool_coupled) return a.tool_coupled;
    if (!a.tool_coupled && a.linear != b.linear) return b.linear;
    return a.rank != b.rank ? a.rank > b.rank : a.first < b.first;
  });
}

void Condenser::choose(const ConstraintProblem& full, int max_rows, ConstraintProblem& small) {
  chosen_.clear();
  std::size_t g = 0;
  for (int rows = 0;
       g < groups_.size() && !(groups_[g].linear && !groups_[g].tool_coupled) && rows + groups_[g].rows <= max_rows;
       ++g) {
    rows += groups_[g].rows;
    for (int b = groups_[g].first; b <= groups_[g].last; ++b) chosen_.push_back(b);
  }
  // Laws without bounds are last in the order and first here, since their elimination is exact.
  eliminated_.clear();
  for (std::size_t last = groups_.size(); last-- > g;)
    for (int b = groups_[last].first; b <= groups_[last].last && !groups_[last].tool_coupled; ++b)
      add_eliminated(full, full.blocks[std::size_t(b)]);
  std::sort(eliminated_.begin(), eliminated_.end(),
            [](const Direction& a, const Direction& b) { return a.row < b.row; });
  std::sort(chosen_.begin(), chosen_.end());
  kept_.clear();
  small.blocks.clear();
  for (int b : chosen_) {
    Block block = full.blocks[std::size_t(b)];
    const int first = int(kept_.size());
    for (int k = 0; k < block.rows(); ++k) {
      fate_[std::size_t(block.row + k)] = Fate::kept;
      kept_.push_back(block.row + k);
    }
    block.row = first;
    small.blocks.push_back(block);
  }
}

void Condenser::add_eliminated(const ConstraintProblem& full, const Block& b) {
  for (int k = 0; k < b.rows() && int(eliminated_.size()) < max_eliminated; ++k) {
    const std::size_t r = std::size_t(b.row + k);
    if (fate_[r] == Fate::linear) {
      const double c = k == 0 && b.law != LawKind::patch ? b.compliance : 0;
      eliminated_.push_back({int(r), {1, 0}, c, delta_m_[r] + c * full.lambda[r]});
    } else if (fate_[r] == Fate::slips) {
      const double *lambda = full.lambda.data() + r, *delta = delta_m_.data() + r,
                   size = std::hypot(lambda[0], lambda[1]);
      const double v[2] = {-lambda[1] / size, lambda[0] / size};
      eliminated_.push_back(
          {int(r), {v[0], v[1]}, std::hypot(delta[0], delta[1]) / size, v[0] * delta[0] + v[1] * delta[1]});
    }
  }
}

/// Copies the kept rows as if all others were held.
void Condenser::copy_kept(const ConstraintProblem& full, ConstraintProblem& small) {
  const std::size_t rows = kept_.size();
  small.resize(int(rows));
  copy_scalars(full, small);
  small.reduced.take_modes(full.reduced, rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t s = std::size_t(kept_[i]);
    double free = full.delta_free[s];
    for (std::size_t c = 0; c < std::size_t(full.rows); ++c)
      if (fate_[c] != Fate::kept) free += full.w_at(int(s), int(c)) * full.lambda[c];
    copy_row(full, s, small, i);
    small.delta_free[i] = free;
    for (std::size_t j = 0; j < rows; ++j) small.w[i * std::size_t(small.stride) + j] = full.w_at(int(s), kept_[j]);
  }
  small.tools.resize(full.tools.size());
  for (std::size_t t = 0; t < small.tools.size(); ++t) {
    const ToolTerms& from = full.tools[t];
    ToolTerms& to = small.tools[t];
    to.coupling() = from;
    to.jacobian.resize(long(rows), 6);
    for (std::size_t i = 0; i < rows; ++i) to.jacobian.row(long(i)) = from.jacobian.row(kept_[i]);
  }
  new_row_.assign(std::size_t(full.rows), -1);
  for (std::size_t i = 0; i < rows; ++i) new_row_[std::size_t(kept_[i])] = int(i);
  small.patches = full.patches;
  renumber_rows(small.patches, new_row_);
}

/// A row for each eliminated unknown: W_EE + C, W_EK, r, and its part in the modes.
void Condenser::fill_factor(const ConstraintProblem& full, long kept_at, long r_at, long modes_at, long width) {
  const std::size_t n = eliminated_.size(), k = kept_.size(), modes = full.reduced.modes.size();
  factor_.assign(n * std::size_t(width), 0.0);
  const auto row = [&](std::size_t j) { return factor_.data() + long(j) * width; };
  const auto w_to = [&](const Direction& d, int c) {
    const double w = d.along[0] * full.w_at(d.row, c);
    return d.along[1] == 0 ? w : w + d.along[1] * full.w_at(d.row + 1, c);
  };
  for (std::size_t j = 0; j < n; ++j) {
    const Direction& d = eliminated_[j];
    for (std::size_t i = j; i < n; ++i) {
      const Direction& e = eliminated_[i];
      row(j)[i] = e.along[0] * w_to(d, e.row);
      if (e.along[1] != 0) row(j)[i] += e.along[1] * w_to(d, e.row + 1);
    }
    for (std::size_t i = 0; i < k; ++i) row(j)[kept_at + long(i)] = w_to(d, kept_[i]);
    row(j)[r_at] = d.free;
    for (std::size_t m = 0; m < modes; ++m) {
      row(j)[modes_at + long(m)] = d.along[0] * full.reduced.row(std::size_t(d.row))[m];
      if (d.along[1] != 0) row(j)[modes_at + long(m)] += d.along[1] * full.reduced.row(std::size_t(d.row) + 1)[m];
    }
    row(j)[j] += d.compliance;
  }
}

/// With lambda_E in the unknowns' directions: lambda_E = lambda_E0 - M (r + W_EK (lambda_K - lambda_K0)), M = (W_EE +
/// C)^-1, r = delta_E + C lambda_E of the full solution. With W_EE + C = U^T U, Y = U^-T W_EK and z = U^-T r:
///   W' = W_KK - Y^T Y,   delta_free' = (all others held) - Y^T (z - Y lambda_K0)
/// A reduced model takes part in the same pass, with Z = U^-T g_E (core/haptics/condense_modes.h).
void Condenser::eliminate(const ConstraintProblem& full, ConstraintProblem& small) {
  const auto combine = sweep_kernels().combine;
  const std::size_t n = eliminated_.size(), k = kept_.size();
  const std::size_t modes = full.reduced.modes.size();
  const long kept_at = padded(n), r_at = kept_at + small.stride, modes_at = r_at + 8, width = modes_at + padded(modes);
  weights_.assign(std::max(n, k) + 8, 0.0);
  fill_factor(full, kept_at, r_at, modes_at, width);
  const auto row = [&](std::size_t j) { return factor_.data() + long(j) * width; };
  // Computes each row of U from those above it. W_EK and r become Y and z in the same pass.
  for (std::size_t j = 0; j < n; ++j) {
    const long from = long(j / 8 * 8);
    const double whole = row(j)[j];
    for (std::size_t i = 0; i < j; ++i) weights_[i] = -row(i)[j];
    combine(row(j) + from, factor_.data() + from, width, weights_.data(), int(j), int(width - from));
    const double pivot = row(j)[j];
    const double scale = pivot > 1e-10 * whole ? 1 / std::sqrt(pivot) : 0;  // depends on the others: held
    for (long c = long(j); c < width; ++c) row(j)[c] *= scale;
  }
  for (std::size_t j = 0; j < n; ++j) {
    double sum = -row(j)[r_at];
    for (std::size_t i = 0; i < k; ++i) sum += row(j)[kept_at + long(i)] * small.lambda[i];
    delta_m_[j] = sum;
  }
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j < n; ++j) small.delta_free[i] += row(j)[kept_at + long(i)] * delta_m_[j];
  for (std::size_t i = 0; i < k; ++i) {
    const long from = long(i / 8 * 8);
    double* w = small.w.data() + long(i) * small.stride;
    for (std::size_t j = 0; j < n; ++j) weights_[j] = -row(j)[kept_at + long(i)];
    combine(w + from, factor_.data() + kept_at + from, width, weights_.data(), int(n), int(small.stride - from));
  }
  if (modes > 0)
    condense_modes({factor_.data(), n, std::size_t(width), std::size_t(kept_at), std::size_t(modes_at)}, k,
                   small.reduced);
  // A row that depends only on the eliminated rows has no compliance of its own. Rounding must not give it a small or
  // negative one.
  for (std::size_t i = 0; i < k; ++i) {
    double* w = small.w.data() + i * std::size_t(small.stride);
    if (w[i] > 1e-10 * full.w_at(kept_[i], kept_[i])) continue;
    std::fill(w + i, w + k, 0.0);
    std::fill_n(small.reduced.row(i), small.reduced.modes.size(), 0.0);
    for (std::size_t r = 0; r < i; ++r) small.w[r * std::size_t(small.stride) + i] = 0;
  }
  small.reduced.limit(0, k, [&](std::size_t i) { return small.w_at(int(i), int(i)); });
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t c = i + 1; c < k; ++c)
      small.w[c * std::size_t(small.stride) + i] = small.w[i * std::size_t(small.stride) + c];
}

const ConstraintProblem& Condenser::operator()(const ConstraintProblem& full, int max_rows, ConstraintProblem& small) {
  if (full.rows <= max_rows) return full;
  find_tool_coupled_rows(full);
  find_states(full);
  make_groups(full);
  choose(full, max_rows, small);
  copy_kept(full, small);
  if (!eliminated_.empty() && !kept_.empty()) eliminate(full, small);
  return small;
}

}  // namespace insula
