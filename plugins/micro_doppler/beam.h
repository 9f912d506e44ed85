// SPDX-License-Identifier: GPL-3.0-or-later
// What a narrow beam of ultrasound hears of the blood that it passes.
//
// The beam is a line from the probe's face. Along it the probe listens between two depths, the gate. A piece of lumen
// is the frustum of a cone, and the beam meets it along a chord. With the flow Q, the radius r at a place, and the
// angle theta between the vessel and the beam,
//
//   v = Q / (pi r^2),   v_beam = v cos(theta),   positive towards the probe,
//
// averaged over the chords in one vessel, since the power that comes back is in proportion to the blood in the gate.
//
// Blood that moves slower along the beam than the wall filter is not heard. The nearest vessel that is heard is the one
// reported. So a vessel behind a closed one may be heard in its place, as with a real probe.
//
// Source: Evans and McDicken, Doppler Ultrasound: Physics, Instrumentation and Signal Processing, 2000.
#pragma once
#include <span>

#include "plugins/blood_flow/lumen_piece.h"

namespace insula {

struct Beam {
  Vec3 face = Vec3::Zero();          ///< m, scene frame
  Vec3 along = Vec3(0, 0, -1);       ///< unit, out of the probe
  double nearest = 0, farthest = 0;  ///< the gate, m from the face
  double wall_filter = 0;            ///< m/s
};

/// What is heard of one vessel.
struct Insonation {
  bool lumen = false;   ///< a lumen lies in the gate
  bool sac = false;     ///< it is that of a sac
  double velocity = 0;  ///< m/s along the beam, positive towards the probe; of a sac its size, without a direction
  double depth = 0;     ///< of the middle of the blood in the gate, m from the face
  bool heard = false;   ///< the velocity is above the wall filter
};

/// The part of a beam inside a piece of lumen and the gate; empty (from = to) if there is none.
struct Chord {
  double from = 0, to = 0;  ///< m from the face
};
Chord chord_of(const Beam& beam, const LumenPiece& piece);

/// pieces: those of a vessel follow each other, as LumenSource gives them. Allocates nothing.
Insonation insonate(const Beam& beam, std::span<const LumenPiece> pieces);

/// Doppler shift, Hz: f = 2 f0 v / c. Negative away from the probe.
inline double doppler_shift(double velocity, double frequency, double sound_speed) {
  return 2 * frequency * velocity / sound_speed;
}

}  // namespace insula
