// SPDX-License-Identifier: GPL-3.0-or-later
// The largest force of one hand on some structures that lasts as long as a force fault of the scene forgives.
#pragma once
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <string>

#include "core/mechanics/body.h"
#include "core/registry/component.h"
#include "core/sim/report.h"

namespace insula::test {

class LastingForce {
 public:
  /// fault: a <fault_force>.
  explicit LastingForce(const Component& fault)
      : id_(fault.id),
        on_(dynamic_cast<const RefList<Body>&>(*fault.find_param("on"))()),
        limit_N_(dynamic_cast<const Param<Force>&>(*fault.find_param("limit"))()),
        grace_s_(dynamic_cast<const Param<Duration>&>(*fault.find_param("grace"))()) {}

  void see(const StepReport& r) {
    const auto steps = std::size_t(grace_s_ / r.h) + 1;
    for (const StructureForce& s : r.structures) {
      if (std::find(on_.begin(), on_.end(), s.body) == on_.end()) continue;
      for (std::size_t hand = 0; hand < 2; ++hand) {
        std::deque<double>& last = last_[s.body][hand];
        last.push_back(s.of_hand[hand].norm());
        if (last.size() < steps) continue;
        if (last.size() > steps) last.pop_front();
        largest_N_ = std::max(largest_N_, *std::min_element(last.begin(), last.end()));
      }
    }
  }
  const std::string& id() const { return id_; }  ///< of the fault
  double share_of_limit() const { return largest_N_ / limit_N_; }

 private:
  std::string id_;
  std::vector<Body*> on_;
  double limit_N_, grace_s_, largest_N_ = 0;
  std::map<const Body*, std::array<std::deque<double>, 2>> last_;
};

}  // namespace insula::test
