// SPDX-License-Identifier: GPL-3.0-or-later
// The largest force of one hand on some structures that lasts for a time. A force fault counts above its limit.
#pragma once
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/mechanics/body.h"
#include "core/sim/report.h"

namespace insula::test {

class LastingForce {
 public:
  /// `ids`: of the structures. `duration_s`: how long a force must last.
  LastingForce(std::set<std::string> ids, double duration_s) : ids_(std::move(ids)), duration_(duration_s) {}

  void see(const StepReport& r) {
    const auto steps = std::size_t(duration_ / r.h) + 1;
    for (const StructureForce& s : r.structures) {
      if (!ids_.contains(s.body->id)) continue;
      for (std::size_t hand = 0; hand < 2; ++hand) {
        std::deque<double>& last = last_[s.body][hand];
        last.push_back(s.of_hand[hand].norm());
        if (last.size() < steps) continue;
        if (last.size() > steps) last.pop_front();
        largest_ = std::max(largest_, *std::min_element(last.begin(), last.end()));
      }
    }
  }
  double largest() const { return largest_; }  ///< N

 private:
  std::set<std::string> ids_;
  double duration_, largest_ = 0;
  std::map<const Body*, std::array<std::deque<double>, 2>> last_;
};

}  // namespace insula::test
