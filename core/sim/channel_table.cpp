// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/sim/channel_table.h"

#include <algorithm>

namespace insula {

void ChannelTable::collect(const std::vector<Component*>& components) {
  entries_.clear();
  numbers_ = 0;
  for (const Component* c : components)
    for (const ChannelBase* channel : c->channels())
      for (std::size_t item = 0; item < channel->groups().size(); ++item) {
        entries_.push_back({c, channel, item, numbers_, c->id + "." + channel->name(item)});
        numbers_ += std::size_t(channel->size());
      }
}

void ChannelTable::read(std::vector<double>& values) const {
  values.resize(numbers_);
  for (const ChannelEntry& e : entries_)
    std::copy_n(e.channel->values(e.item), std::size_t(e.size()), values.begin() + std::ptrdiff_t(e.offset));
}

const ChannelEntry* ChannelTable::find(std::string_view id) const {
  const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const ChannelEntry& e) { return e.id == id; });
  return it == entries_.end() ? nullptr : &*it;
}

std::vector<std::string> ChannelTable::ids() const {
  std::vector<std::string> out;
  for (const ChannelEntry& e : entries_) out.push_back(e.id);
  return out;
}

}  // namespace insula
