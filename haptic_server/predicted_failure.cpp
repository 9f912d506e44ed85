// SPDX-License-Identifier: GPL-3.0-or-later
#include "haptic_server/predicted_failure.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

// The engine's problem with a failure arrives at most three steps, and the time of a message, after its tick.
constexpr double steps_late = 3, message_s = 0.01;

double worn(double delta, int sign) { return sign == 0 ? std::abs(delta) : std::max(0.0, sign * delta); }

unsigned tools_in(const ConstraintProblem& p, int row) {
  unsigned bits = 0;
  for (std::size_t t = 0; t < std::min<std::size_t>(p.tools.size(), 2); ++t)
    for (int c = 0; c < 6; ++c)
      if (p.tools[t].jacobian(row, c) != 0) bits |= 1U << t;
  return bits;
}

}  // namespace

PredictedFailure::PredictedFailure(int max_rows) {
  watched_.reserve(std::size_t(max_rows));
  wear_.reserve(std::size_t(max_rows));
}

void PredictedFailure::reset() noexcept {
  remembered_ = {};
  watched_.clear();
  release_ = 0;
}

void PredictedFailure::begin(const ConstraintProblem& p, std::span<const double> delta) noexcept {
  for (const Watched& w : watched_)
    if (w.bears && !w.failed && w.wear >= 0 && wear_[std::size_t(w.wear)].row == w.row &&
        std::none_of(p.blocks.begin(), p.blocks.end(), [&](const Block& b) { return b.id == w.id; }))
      release_ |= w.tools;
  watched_.clear();
  wear_.clear();
  step_s_ = p.step_s;
  for (const Block& b : p.blocks) {
    if (!plastic(b)) continue;
    const int sign = b.upper == 0 ? 1 : b.lower == 0 ? -1 : 0;
    wear_.push_back({b.row, sign, worn(delta[std::size_t(b.row)], sign), double(b.failure_travel)});
  }
  for (std::size_t k = 0; k < p.blocks.size(); ++k) {
    const Block& b = p.blocks[k];
    if (b.law != LawKind::box || (b.failure_group == 0 && !plastic(b) && !(b.failure_force > 0))) continue;
    Watched w{b.id,         int(k),
              b.row,        b.failure_group,
              -1,           false,
              false,        tools_in(p, b.row),
              b.compliance, double(b.failure_force)};
    for (std::size_t i = 0; i < p.blocks.size() && w.wear < 0; ++i) {
      const Block& other = p.blocks[i];
      if (!plastic(other) || (i != k && (b.failure_group == 0 || other.failure_group != b.failure_group))) continue;
      w.wear = int(std::find_if(wear_.begin(), wear_.end(), [&](const Wear& x) { return x.row == other.row; }) -
                   wear_.begin());
    }
    watched_.push_back(w);
  }
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    const auto known = std::find_if(remembered_.begin(), remembered_.end(),
                                    [&](const Remembered& r) { return r.left_s > 0 && r.id == watched_[k].id; });
    const bool worn_out = watched_[k].wear >= 0 && wear_[std::size_t(watched_[k].wear)].integrity() == 0;
    if (known != remembered_.end()) watched_[k].failed = true;  // it let go when it failed
    else if (worn_out) fail(k);
  }
}

void PredictedFailure::apply(std::span<Block> blocks) const noexcept {
  for (const Watched& w : watched_) {
    Block& b = blocks[std::size_t(w.block)];
    if (w.failed) b.lower = b.upper = 0;
    else if (w.wear >= 0 && wear_[std::size_t(w.wear)].row != w.row)
      b.compliance = w.compliance / wear_[std::size_t(w.wear)].integrity();
  }
}

void PredictedFailure::solved(std::span<const double> lambda, std::span<const double> delta, double dt_s) noexcept {
  for (Remembered& r : remembered_) r.left_s -= dt_s;
  for (Wear& w : wear_) w.travel += worn(delta[std::size_t(w.row)], w.sign);
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    Watched& w = watched_[k];
    if (w.failed) continue;
    w.bears = lambda[std::size_t(w.row)] != 0;
    const double integrity = w.wear >= 0 ? wear_[std::size_t(w.wear)].integrity() : 1;
    const bool torn = w.force > 0 && std::abs(lambda[std::size_t(w.row)]) > w.force * integrity;
    if (integrity == 0 || torn) fail(k);
  }
}

// With all of its group.
void PredictedFailure::fail(std::size_t watched) noexcept {
  const int group = watched_[watched].group;
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    Watched& w = watched_[k];
    if (w.failed || (k != watched && (group == 0 || w.group != group))) continue;
    w.failed = true;
    release_ |= w.tools;
    remember(w.id);
  }
}

void PredictedFailure::remember(std::uint64_t id) noexcept {
  Remembered* place = &remembered_[0];
  for (Remembered& r : remembered_) {
    if (r.id == id && r.left_s > 0) return;
    if (r.left_s < place->left_s) place = &r;
  }
  *place = {id, steps_late * step_s_ + message_s};
}

}  // namespace insula
