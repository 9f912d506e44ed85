// SPDX-License-Identifier: GPL-3.0-or-later
// Splitting and assembly of LCM's datagrams.
#include "core/bus/udpm_packet.h"

#include <algorithm>
#include <cstring>

#include "core/bus/byte_io.h"

namespace insula::udpm {
namespace {

constexpr std::uint32_t short_mark = 0x4C433032, fragment_mark = 0x4C433033;  // "LC02", "LC03"
constexpr std::size_t short_head = 8, fragment_head = 20;

void put16(Datagram& d, std::size_t value) {
  d.head[d.head_bytes++] = std::uint8_t(value >> 8);
  d.head[d.head_bytes++] = std::uint8_t(value);
}

void put32(Datagram& d, std::size_t value) {
  put16(d, value >> 16);
  put16(d, value);
}

void put_name(Datagram& d, std::string_view name) {
  std::memcpy(d.head.data() + d.head_bytes, name.data(), name.size());
  d.head_bytes += name.size();
  d.head[d.head_bytes++] = 0;
}

/// The channel's name in front of `rest`, which is moved behind its zero byte. Empty when there is no good name.
std::string_view take_name(Bytes& rest) {
  const Bytes searched = rest.first(std::min(rest.size(), max_name_bytes + 1));
  const auto end = std::find(searched.begin(), searched.end(), std::uint8_t(0));
  if (end == searched.end()) return {};
  const std::string_view name(reinterpret_cast<const char*>(rest.data()), std::size_t(end - searched.begin()));
  rest = rest.subspan(name.size() + 1);
  return name;
}

}  // namespace

bool cut(std::string_view channel, Bytes message, std::uint32_t sequence,
         const std::function<bool(const Datagram&)>& send) {
  Datagram d;
  if (short_head + channel.size() + 1 + message.size() <= max_datagram_bytes) {
    put32(d, short_mark);
    put32(d, sequence);
    put_name(d, channel);
    d.payload = message;
    return send(d);
  }
  constexpr std::size_t room = max_datagram_bytes - fragment_head;
  const std::size_t in_all = channel.size() + 1 + message.size(), fragments = (in_all + room - 1) / room;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < fragments; ++i) {
    d.head_bytes = 0;
    put32(d, fragment_mark);
    put32(d, sequence);
    put32(d, message.size());
    put32(d, offset);
    put16(d, i);
    put16(d, fragments);
    if (i == 0) put_name(d, channel);
    d.payload = message.subspan(offset, std::min(max_datagram_bytes - d.head_bytes, message.size() - offset));
    if (!send(d)) return false;
    offset += d.payload.size();
  }
  return true;
}

bool Assembler::add(std::uint64_t sender, Bytes datagram, Received& out) {
  if (datagram.size() < short_head) return refuse();
  switch (wire::load32(datagram.data())) {
    case short_mark: return add_short(datagram, out);
    case fragment_mark: return add_fragment(sender, datagram, out);
    default: return refuse();
  }
}

bool Assembler::add_short(Bytes datagram, Received& out) {
  Bytes rest = datagram.subspan(short_head);
  out.channel = take_name(rest);
  if (out.channel.empty()) return refuse();
  out.message = rest;
  return true;
}

bool Assembler::add_fragment(std::uint64_t sender, Bytes datagram, Received& out) {
  if (datagram.size() < fragment_head) return refuse();
  const std::uint8_t* head = datagram.data();
  const std::uint32_t sequence = wire::load32(head + 4), size = wire::load32(head + 8),
                      offset = wire::load32(head + 12);
  const std::uint16_t number = wire::load16(head + 16), fragments = wire::load16(head + 18);
  if (size > max_message_bytes || number >= fragments) return refuse();
  Bytes rest = datagram.subspan(fragment_head);
  Partial* partial = number == 0 ? begin(sender, datagram, rest) : find(sender);
  if (partial == nullptr) return refuse();
  const bool follows = partial->sequence == sequence && partial->fragments == fragments &&
                       partial->next_fragment == number && partial->payload.size() == size && partial->filled == offset;
  if (!follows || rest.size() > size - partial->filled) {  // filled <= size always holds, so the difference cannot wrap
    partial->next_fragment = partial->fragments = 0;
    return refuse();
  }
  if (!rest.empty()) std::memcpy(partial->payload.data() + partial->filled, rest.data(), rest.size());
  partial->filled += rest.size();
  partial->last_used = ++uses_;
  if (++partial->next_fragment < fragments) return false;
  partial->next_fragment = partial->fragments = 0;
  if (partial->filled != size) return refuse();
  out = {{partial->name.data(), partial->name_bytes}, partial->payload};
  return true;
}

Assembler::Partial* Assembler::find(std::uint64_t sender) {
  const auto found =
      std::find_if(partials_.begin(), partials_.end(), [&](const Partial& p) { return p.sender == sender; });
  return found == partials_.end() || found->next_fragment == 0 ? nullptr : &*found;
}

Assembler::Partial* Assembler::begin(std::uint64_t sender, Bytes datagram, Bytes& rest) {
  const std::string_view name = take_name(rest);
  if (name.empty()) return nullptr;
  auto place = std::find_if(partials_.begin(), partials_.end(), [&](const Partial& p) { return p.sender == sender; });
  if (place == partials_.end() && partials_.size() < max_senders) {
    partials_.emplace_back();
    place = partials_.end() - 1;
  } else if (place == partials_.end()) {  // replaces the sender that was silent for longest
    const auto longer_silent = [](const Partial& a, const Partial& b) { return a.last_used < b.last_used; };
    place = std::min_element(partials_.begin(), partials_.end(), longer_silent);
  }
  place->sender = sender;
  place->sequence = wire::load32(datagram.data() + 4);
  place->fragments = wire::load16(datagram.data() + 18);
  place->next_fragment = 0;
  std::copy(name.begin(), name.end(), place->name.begin());
  place->name_bytes = name.size();
  place->payload.resize(wire::load32(datagram.data() + 8));
  place->filled = 0;
  return &*place;
}

}  // namespace insula::udpm
