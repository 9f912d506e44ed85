// SPDX-License-Identifier: GPL-3.0-or-later
// The geometry of a picture in a session file: node positions of bodies and data of drawables, as whole multiples of a
// unit, as differences from the picture before. docs/session-format.md has the layout.
#pragma once
#include <cstdint>
#include <insula_lcm/render_frame_t.hpp>
#include <string>
#include <vector>

#include "core/container/mcap_format.h"

namespace insula {

namespace picture {
/// Numbers are stored as multiples of this, SI: 4 um for positions. A microscope's picture shows no less than 8 um.
inline constexpr double unit = 4e-6;
/// Coded: a number that is not finite.
inline constexpr std::int32_t unknown = INT32_MIN;
enum class ListKind : std::uint8_t { body = 0, drawable = 1 };
/// Coded numbers of one body or drawable.
struct List {
  ListKind kind = ListKind::body;
  std::int32_t index = 0;
  std::vector<std::int32_t> coded;
};
}  // namespace picture

class PictureEncoder {
 public:
  /// Writes the frame's geometry to `out`, which keeps its capacity. `key`: complete; otherwise differences from the
  /// last call's frame. The first one is a key in any case.
  void encode(const insula_lcm::render_frame_t& frame, bool key, mcap::Buffer& out);

 private:
  std::vector<picture::List> last_, now_;
};

class PictureDecoder {
 public:
  /// Puts the geometry into the frame. Messages must come in order, from a key on. False with a reason for bytes that
  /// are no picture, or that need a picture before; the next key is decoded again.
  bool decode(mcap::Bytes bytes, insula_lcm::render_frame_t& frame, std::string& why);

 private:
  std::vector<picture::List> last_;
  bool begun_ = false;
};

}  // namespace insula
