// SPDX-License-Identifier: GPL-3.0-or-later
/*
# micro_doppler

A probe for microvascular Doppler sonography. Its tip is held on a vessel, and the blood below it is heard. After a
clip is placed, the parent artery and its branches must still flow, and the sac must be silent.

    <micro_doppler id="doppler" model="../../meshes/instruments/micro_doppler/micro_doppler.urdf" hand="right"
                   home="14 0 1 mm" shaft="1 0 0"/>

The beam is a line from the tip, on along the shaft. Between the depths of the gate it meets the lumens of every
`blood_flow` of the scene, as the deformed wall leaves them. With the flow Q of this moment, the lumen's radius r at
that place, and the angle theta between the vessel and the beam,

    v = Q / (pi r^2),    v_beam = v cos(theta),    f = 2 f0 v_beam / c

where f0 is `frequency` and c is `sound_speed`. The sign is positive towards the probe. Blood at 0.3 m/s under 60
degrees is 3.9 kHz at 20 MHz. Blood slower than `wall_filter` is not heard. The nearest vessel that is heard counts. So
a vessel behind a closed one may be heard in its place, as in an operation.

In a sac the network knows no directions. It knows the flow Q that passes its neck, into its wall or out of a tear, and
the blood Qx that its vortex exchanges with the vessel (`sac_exchange` of `blood_flow`). Over the sac's section of
radius r the probe hears

    v_beam = |Q cos(theta)| / (pi r^2) + Qx / (pi r^2)

without a direction: half of the section takes blood in and half lets it out, and a beam sees half of a speed whose
direction is not known. A neck that is closed ends both.

What lies between the probe and the vessel is taken to carry sound. Bone, metal and air do so here, unlike in an
operation. A probe that is not in its hand hears nothing.

Sources: Evans and McDicken, Doppler Ultrasound, 2000 (the shift; 1540 m/s in soft tissue); Stendel et al.,
Intraoperative microvascular Doppler sonography in aneurysm surgery, 2000 (probes of 1 mm, 20 MHz).
*/
#include <limits>
#include <vector>

#include "core/mechanics/instrument.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "plugins/micro_doppler/beam.h"

namespace insula {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class MicroDoppler final : public Instrument {
 public:
  Param<Frequency> frequency{
      this, {.name = "frequency", .fallback = "20 MHz", .min = "1 MHz", .max = "50 MHz", .doc = "of the ultrasound"}};
  Param<Speed> sound_speed{this,
                           {.name = "sound_speed",
                            .fallback = "1540 m/s",
                            .min = "1000 m/s",
                            .max = "2000 m/s",
                            .doc = "of sound in soft tissue"}};
  Param<Length> gate_from{this,
                          {.name = "gate_from",
                           .fallback = "0 mm",
                           .min = "0 mm",
                           .max = "20 mm",
                           .doc = "depth from the tip at which the gate begins"}};
  Param<Length> gate_length{this,
                            {.name = "gate_length",
                             .fallback = "5 mm",
                             .min = "0.1 mm",
                             .max = "20 mm",
                             .doc = "of the gate along the probe's axis"}};
  Param<Speed> wall_filter{this,
                           {.name = "wall_filter",
                            .fallback = "4 mm/s",
                            .min = "0 mm/s",
                            .max = "100 mm/s",
                            .doc = "slower blood is not heard; at 20 MHz 4 mm/s is a shift of 104 Hz"}};

  Channel<Speed> velocity{this,
                          {.name = "doppler_velocity",
                           .doc = "mean velocity of the blood along the beam, positive towards the probe; of a sac its "
                                  "size; 0: nothing is heard; unknown: the probe is not in the hand",
                           .shown = Shown::vital,
                           .display = "cm/s",
                           .digits = 0}};
  Channel<Frequency> shift{
      this, {.name = "doppler_shift", .doc = "Doppler shift of that velocity", .shown = Shown::none, .digits = 0}};
  Channel<Length> depth{this,
                        {.name = "doppler_depth",
                         .doc = "of the blood in the gate, from the tip; unknown: there is none",
                         .min = "0 mm",
                         .max = "40 mm",
                         .display = "mm",
                         .digits = 1}};
  Channel<Scalar> insonated{this,
                            {.name = "insonated",
                             .doc = "1: a lumen lies in the gate, open or closed; 0: none does",
                             .min = "0",
                             .max = "1",
                             .shown = Shown::none,
                             .digits = 0}};
  Channel<Scalar> mixed{this,
                        {.name = "doppler_mixed",
                         .doc = "1: blood of a sac, which moves both ways; 0: blood of a vessel",
                         .min = "0",
                         .max = "1",
                         .shown = Shown::none,
                         .digits = 0}};

  void join(PrepareContext&, Simulation& simulation) override {
    sources_ = simulation.scene().all<LumenSource>();
    std::size_t most = 0;
    for (const LumenSource* s : sources_) most += s->most_lumens();
    pieces_.reserve(most);
  }
  bool cutting() const override { return false; }
  double activity() const override { return sound_.heard ? 1 : 0; }
  void reset() override {
    Instrument::reset();
    sound_ = {};
  }

  void publish() override {
    sound_ = active() ? listen() : Insonation{};
    const double v = sound_.heard ? sound_.velocity : 0;
    velocity.set(active() ? v : unknown);
    shift.set(active() ? doppler_shift(v, frequency(), sound_speed()) : unknown);
    depth.set(sound_.lumen ? sound_.depth : unknown);
    insonated.set(sound_.lumen ? 1 : 0);
    mixed.set(sound_.heard && sound_.sac ? 1 : 0);
  }

 private:
  Insonation listen() {
    pieces_.clear();
    for (const LumenSource* s : sources_) s->append_lumens(pieces_);
    Beam beam;
    beam.face = pose().p;
    beam.along = pose().q * Vec3(0, 0, -1);
    beam.nearest = gate_from();
    beam.farthest = gate_from() + gate_length();
    beam.wall_filter = wall_filter();
    return insonate(beam, pieces_);
  }

  std::vector<LumenSource*> sources_;
  std::vector<LumenPiece> pieces_;
  Insonation sound_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(micro_doppler) {
  registry.add<insula::MicroDoppler>("micro_doppler", insula::Kind::instrument,
                                     "Doppler probe that hears the blood of the vessel below its tip");
}
