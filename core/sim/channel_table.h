// SPDX-License-Identifier: GPL-3.0-or-later
// All channels of a scene, numbered in document order. Frames, reports and tables use this order.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/registry/component.h"

namespace insula {

class Scene;

struct ChannelEntry {
  const Component* component = nullptr;
  const ChannelBase* channel = nullptr;
  std::size_t item = 0;    ///< of a group of channels
  std::size_t offset = 0;  ///< of its first number among all numbers
  std::string id;          ///< "component.channel", "component.group.channel"
  const std::string& group() const { return channel->groups()[item]; }
  int size() const { return channel->size(); }
};

class ChannelTable {
 public:
  /// Called once, when all components are connected and groups are known.
  void collect(const std::vector<Component*>& components);
  const std::vector<ChannelEntry>& entries() const { return entries_; }
  std::size_t numbers() const { return numbers_; }  ///< of all channels; a vector counts as three
  /// Copies the present values. Allocates only the first time.
  void read(std::vector<double>& values) const;
  const ChannelEntry* find(std::string_view id) const;
  std::vector<std::string> ids() const;

 private:
  std::vector<ChannelEntry> entries_;
  std::size_t numbers_ = 0;
};

}  // namespace insula
