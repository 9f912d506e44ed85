// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures of a session: the viewer's scene bundle once, and frames a few times a second, so that a page can show
// the session at any moment without a rerun.
#pragma once
#include <cstdint>
#include <insula_lcm/render_frame_t.hpp>

#include "core/container/mcap_writer.h"
#include "core/sim/simulation.h"
#include "engine/live/session_mode.h"
#include "engine/session/picture_codec.h"

namespace insula {

/// Attaches the files of the viewer's bundle, compressed, as "bundle/NAME.zst".
void put_bundle(McapWriter& file, const Simulation& simulation);

class PictureRecorder {
 public:
  static constexpr int pictures_a_second = 10;
  static constexpr int pictures_a_key = 20;  ///< one of so many is complete

  /// The picture of the last step. After it, frame() and geometry() are its two messages.
  void take(const Simulation& simulation, SessionMode mode);
  /// The next picture is complete, for example after a reset.
  void begin_again() { since_key_ = 0; }

  /// Whether the picture needs none before.
  bool key() const { return key_; }
  /// render_frame_t without bodies and drawables.
  mcap::Bytes frame() const { return frame_bytes_; }
  /// As picture_codec.h has it.
  mcap::Bytes geometry() const { return geometry_bytes_; }

 private:
  void exchange_geometry();

  insula_lcm::render_frame_t frame_{}, geometry_{};
  PictureEncoder encoder_;
  mcap::Buffer frame_bytes_, geometry_bytes_;
  std::int64_t number_ = 0;
  int since_key_ = 0;
  bool key_ = false;
};

}  // namespace insula
