// SPDX-License-Identifier: GPL-3.0-or-later
// The channels of a run: statistics over all steps, and curves. It holds copies, so a report may be written while the
// simulation continues.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/sim/channel_table.h"

namespace insula {

class ChannelRecord {
 public:
  /// Data of one channel for a report.
  struct Known {
    std::string id, component, group, name;  ///< name: without the group
    std::string unit, display_unit;
    double scale = 1;  ///< shown number = SI value * scale
    int digits = 2, size = 1;
    Shown shown = Shown::curve;
    std::size_t offset = 0;
    int curve = -1;  ///< its number among the curves; -1: none
  };
  /// Statistics of one number over all steps in which it was known.
  struct Figures {
    double min = 0, max = 0, sum = 0, last = 0;
    long steps = 0;
    void add(double v);
  };

  /// Called once. Takes the channels and reserves memory for `most` samples of the curves. Up to that number nothing
  /// below allocates.
  void begin(const ChannelTable& table, std::size_t most);
  bool begun() const { return begun_; }
  /// Takes a step's values, in the order of the table.
  void observe(const std::vector<double>& values);
  /// Stores the values as a new sample of the curves, or in place of the newest one.
  void push(const std::vector<double>& values);
  void replace_last(const std::vector<double>& values);
  /// Removes every second of the first `samples` samples. The later one of each two stays.
  void halve(std::size_t samples);

  const std::vector<Known>& channels() const { return known_; }
  const Figures& figures(const Known& channel, int k = 0) const { return figures_[channel.offset + std::size_t(k)]; }
  int curves() const { return int(curve_offset_.size()); }
  double sample(std::size_t i, int curve) const { return samples_[i * curve_offset_.size() + std::size_t(curve)]; }
  std::size_t samples() const { return curve_offset_.empty() ? 0 : samples_.size() / curve_offset_.size(); }

  /// {"component.channel": {unit, min, max, mean, last}}; lists of three numbers for a vector; null: never known.
  nlohmann::ordered_json json() const;
  /// The vital signs at the end as tables, one for each component; empty if there are none.
  std::string html() const;

 private:
  bool begun_ = false;
  std::vector<Known> known_;
  std::vector<Figures> figures_;
  std::vector<std::size_t> curve_offset_;
  std::vector<float> samples_;  ///< curves() numbers for each sample
};

}  // namespace insula
