// SPDX-License-Identifier: GPL-3.0-or-later
// The channels of a run: figures over all steps, and curves. Holds copies, so that a report may be written while the
// simulation goes on.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/sim/channel_table.h"

namespace insula {

class ChannelRecord {
 public:
  /// What a report says of one channel.
  struct Known {
    std::string id, component, group, name;  ///< name: without the group
    std::string unit, display_unit;
    double scale = 1;  ///< shown number = SI value * scale
    int digits = 2, size = 1;
    Shown shown = Shown::curve;
    std::size_t offset = 0;
    int curve = -1;  ///< its number among the curves; -1: it has none
  };
  /// Of one number over all steps in which it was known.
  struct Figures {
    double min = 0, max = 0, sum = 0, last = 0;
    long steps = 0;
    void add(double v);
  };

  /// Once: the channels, and room for the curves' samples (this allocates; nothing below does until `most` are there).
  void begin(const ChannelTable& table, std::size_t most);
  bool begun() const { return begun_; }
  /// A step's values, in the order of the table.
  void observe(const std::vector<double>& values);
  /// The same as the newest sample of the curves, or in place of it.
  void push(const std::vector<double>& values);
  void replace_last(const std::vector<double>& values);
  /// Every second sample of the first `samples` goes; the later one of each two stays.
  void halve(std::size_t samples);

  const std::vector<Known>& channels() const { return known_; }
  const Figures& figures(const Known& channel, int k = 0) const { return figures_[channel.offset + std::size_t(k)]; }
  int curves() const { return int(curve_offset_.size()); }
  double sample(std::size_t i, int curve) const { return samples_[i * curve_offset_.size() + std::size_t(curve)]; }
  std::size_t samples() const { return curve_offset_.empty() ? 0 : samples_.size() / curve_offset_.size(); }

  /// {"component.channel": {unit, min, max, mean, last}}; of a vector lists of three; null: was never known.
  nlohmann::ordered_json json() const;
  /// The vital signs at the end as tables, one a component; empty when there are none.
  std::string html() const;

 private:
  bool begun_ = false;
  std::vector<Known> known_;
  std::vector<Figures> figures_;
  std::vector<std::size_t> curve_offset_;
  std::vector<float> samples_;  ///< curves() a sample
};

}  // namespace insula
