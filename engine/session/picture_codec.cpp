// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/picture_codec.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace insula {
using namespace picture;
namespace {

constexpr std::uint8_t is_key = 1;
constexpr std::size_t list_head = 1 + 1 + 4 + 4;  // kind, width, index, count
constexpr std::uint32_t most_lists = 4096, most_numbers = 10'000'000;

std::int32_t coded(float value) {
  const double v = double(value) / unit;
  return std::isfinite(v) ? std::int32_t(std::lround(std::clamp(v, -2147483000.0, 2147483000.0))) : unknown;
}
float decoded(std::int32_t code) {
  return code == unknown ? std::numeric_limits<float>::quiet_NaN() : float(double(code) * unit);
}

/// Differences wrap around: any two numbers have one.
std::uint32_t zigzag(std::int32_t now, std::int32_t before) {
  const auto d = std::int32_t(std::uint32_t(now) - std::uint32_t(before));
  return (std::uint32_t(d) << 1) ^ std::uint32_t(d >> 31);
}
std::int32_t unzigzag(std::uint32_t z, std::int32_t before) {
  return std::int32_t(std::uint32_t(before) + ((z >> 1) ^ (~(z & 1) + 1)));
}

/// The list of the same thing and size in the picture before; null: none.
const List* same(const std::vector<List>& lists, std::size_t at, const List& wanted) {
  if (at >= lists.size()) return nullptr;
  const List& l = lists[at];
  return l.kind == wanted.kind && l.index == wanted.index && l.coded.size() == wanted.coded.size() ? &l : nullptr;
}

int bytes_of(std::uint32_t all_bits) {
  int width = 0;
  for (; all_bits != 0; all_bits >>= 8) ++width;
  return width;
}

}  // namespace

void PictureEncoder::encode(const insula_lcm::render_frame_t& frame, bool key, mcap::Buffer& out) {
  const bool complete = key || last_.empty();
  now_.resize(frame.body.size() + frame.drawable.size());
  std::size_t n = 0;
  for (const auto& body : frame.body) {
    List& to = now_[n++];
    to.kind = ListKind::body;
    to.index = body.index;
    to.coded.clear();
    for (const auto& x : body.x_m)
      for (const float v : x) to.coded.push_back(coded(v));
  }
  for (const auto& drawable : frame.drawable) {
    List& to = now_[n++];
    to.kind = ListKind::drawable;
    to.index = drawable.index;
    to.coded.clear();
    for (const float v : drawable.data) to.coded.push_back(coded(v));
  }
  out.clear();
  mcap::Put put(out);
  put.number(complete ? is_key : std::uint8_t(0)).number(std::uint32_t(now_.size()));
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const List& list = now_[i];
    const List* before = complete ? nullptr : same(last_, i, list);
    const auto difference = [&](std::size_t k) { return zigzag(list.coded[k], before ? before->coded[k] : 0); };
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < list.coded.size(); ++k) bits |= difference(k);
    const int width = bytes_of(bits);
    put.number(std::uint8_t(list.kind)).number(std::uint8_t(width));
    put.number(list.index).number(std::uint32_t(list.coded.size()));
    const std::size_t at = out.size();
    const std::size_t count = list.coded.size();
    out.resize(at + count * std::size_t(width));
    for (std::size_t k = 0; k < count; ++k) {
      std::uint32_t d = difference(k);
      for (int plane = 0; plane < width; ++plane, d >>= 8) out[at + count * std::size_t(plane) + k] = std::uint8_t(d);
    }
  }
  last_.swap(now_);
}

bool PictureDecoder::decode(mcap::Bytes bytes, insula_lcm::render_frame_t& frame, std::string& why) {
  mcap::Take take(bytes);
  const auto fail = [&](const char* text) {
    why = text;
    begun_ = false;
    return false;
  };
  const auto key = take.number<std::uint8_t>();
  const auto lists = take.number<std::uint32_t>();
  if (!take.ok() || key > is_key || lists > most_lists || lists * list_head > take.left()) return fail("is no picture");
  if (key != is_key && !begun_) return fail("the picture before is missing");
  std::vector<List> now(lists);
  for (std::size_t i = 0; i < lists; ++i) {
    List& list = now[i];
    const auto kind = take.number<std::uint8_t>();
    const auto width = take.number<std::uint8_t>();
    list.index = take.number<std::int32_t>();
    const auto count = take.number<std::uint32_t>();
    if (!take.ok() || kind > 1 || width > 4 || list.index < 0 || count > most_numbers) return fail("is no picture");
    list.kind = ListKind(kind);
    const mcap::Bytes planes = take.raw(std::uint64_t(count) * width);
    if (!take.ok()) return fail("ends too early");
    list.coded.resize(count);
    const List* before = key == is_key ? nullptr : same(last_, i, list);
    for (std::size_t k = 0; k < count; ++k) {
      std::uint32_t z = 0;
      for (std::size_t plane = 0; plane < width; ++plane) z |= std::uint32_t(planes[count * plane + k]) << (8 * plane);
      list.coded[k] = unzigzag(z, before ? before->coded[k] : 0);
    }
  }
  if (take.left() != 0) return fail("has more bytes than a picture");
  last_ = std::move(now);
  begun_ = true;
  frame.body.clear();
  frame.drawable.clear();
  for (const List& list : last_) {
    if (list.kind == ListKind::drawable) {
      insula_lcm::render_drawable_t to{};
      to.index = list.index;
      to.floats = std::int32_t(list.coded.size());
      for (const std::int32_t c : list.coded) to.data.push_back(decoded(c));
      frame.drawable.push_back(std::move(to));
      continue;
    }
    insula_lcm::render_body_t to{};
    to.index = list.index;
    to.nodes = std::int32_t(list.coded.size() / 3);
    for (std::size_t k = 0; k + 2 < list.coded.size(); k += 3)
      to.x_m.push_back({decoded(list.coded[k]), decoded(list.coded[k + 1]), decoded(list.coded[k + 2])});
    frame.body.push_back(std::move(to));
  }
  frame.bodies = std::int32_t(frame.body.size());
  frame.drawables = std::int32_t(frame.drawable.size());
  return true;
}

}  // namespace insula
