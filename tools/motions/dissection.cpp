// SPDX-License-Identifier: GPL-3.0-or-later
/*
Writes the two scripted motions of exercise 2 by operating in its scene:

    ninja -C build dissection_motions
    build/bin/dissection_motions scenes/training/2_aneurysm_dissection.xml scenes/training

steady  steers the dissector to the nearest and outermost strand, turns the blade across it and sweeps it forth and
        back, with room to the vessel and the lobes measured on grids of distances, until no strand stands;
rough   shoves the sac aside until strands tear, leans on the frontal lobe and presses the blade into the bleb until it
bursts.

Then each motion is played once more through both simulated arms, as `insula run` does it, and its outcome printed. The
same scene gives the same files on the same processor (see docs/one-step.md on bits).
*/
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "core/base/input_error.h"
#include "plugins/bleeding/bleeding_state.h"
#include "tools/motions/dissection_play.h"
#include "tools/motions/surgeon.h"

namespace insula {
namespace {

constexpr double mm = 1e-3;

/// The hands of both motions, and what they say.
class Trainer : public Surgeon {
 public:
  using Surgeon::Surgeon;

  void steady(const fs::path& file) {
    const int left = divide({}, [this](const Sweep& w, int tries) {
      std::printf("%6.2f s strand %2d  room vessel %5.2f others %5.2f mm  %d stand, tries %d\n", time(), w.strand,
                  w.vessel / mm, w.others / mm, Strands(simulation_).left(), tries);
    });
    if (left > 0) say_left();
    if (left > 0) throw InputError(fmt::format("{} strands are out of reach", left));
    write(file);
  }

  /// Says which strands no sweep reaches as they stand at the start.
  void reach() const {
    for (const int i : out_of_reach()) {
      const StrandState& s = strands()[std::size_t(i)];
      const Vec3 m = ((s.a + s.b) / 2 - centre()) / mm;
      std::printf("strand %2d  length %.1f  at %5.1f %5.1f %5.1f mm from the sac, depth %4.1f: OUT OF REACH\n", i,
                  (s.a - s.b).norm() / mm, m.x(), m.y(), m.z(), -m.dot(outward()));
    }
  }

  void rough(const fs::path& file) {
    Wish left = left_rest(), right{tool_pose(centre_ + 12 * mm * outward_ + Vec3(0, 4, 0) * mm, lean_, Vec3::UnitZ())};
    hands_.move(1.2, left, right);
    // The suction tube shoves the sac away from the frontal lobe: strands between them tear.
    const Vec3 aside = Vec3(0, -1, -0.6).normalized();
    const int before = Strands(simulation_).left();
    press(
        0, left_shaft_, aside, [&] { return middle_of("sac"); }, 5 * mm,
        [&] { return Strands(simulation_).left() <= before - 4; });
    hands_.wait(0.2);
    hands_.move(0.7, left, right);
    // Then it leans on the parent artery.
    double over = 0;
    press(
        0, left_shaft_, -left_shaft_, [&] { return Vec3(middle_of("parent") - Vec3(0, 0, 1) * mm); }, 12 * mm,
        [&] {
          over = force(0, *artery_) > 0.36 ? over + 0.05 : 0;
          return over > 0.15;
        });
    hands_.wait(0.4);
    hands_.wait(0.3);
    hands_.move(0.7, left, right);
    // The dissector leans on the frontal lobe.
    const Body* frontal = simulation_.scene().find_as<Body>("frontal");
    if (!frontal) throw InputError("the scene has no frontal lobe");
    const MaterialPoint at = nearest(*frontal, centre_ + Vec3(4, 5, 0) * mm);
    over = 0;
    press(
        1, outward_, Vec3(-0.3, 0.6, 0.8).normalized(), [&] { return frontal->position(at); }, 16 * mm,
        [&] {
          over = force(1, *frontal) > 0.24 ? over + 0.05 : 0;
          return over > 0.2;
        });
    hands_.wait(0.4);
    hands_.move(0.6, right);
    // And presses the bleb with the flat of the blade.
    const Vec3 out = (middle_of("bleb") - middle_of("sac")).normalized(),
               shaft = (outward_ - 0.35 * Vec3::UnitY()).normalized();
    press(
        1, shaft, -out, [&] { return middle_of("bleb"); }, 9 * mm,
        [&] {
          const auto b = Bleedings(simulation_).now();
          return std::any_of(b.begin(), b.end(), [](const BleedingState& x) { return x.open; });
        },
        shaft.cross(out));
    hands_.move(0.7, right);
    hands_.wait(1);
    write(file);
  }

 private:
  void say_left() const {
    for (std::size_t i = 0; i < strands().size(); ++i)
      if (const StrandState& s = strands()[i]; s.integrity >= 0) {
        const Vec3 a = (s.a - centre_) / mm, b = (s.b - centre_) / mm;
        std::printf("strand %2zu stands: %.1f mm from (%.1f %.1f %.1f) to (%.1f %.1f %.1f) mm from the sac\n", i,
                    (a - b).norm(), a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
      }
  }
  /// Force of a hand on a body, N.
  double force(int hand, const Body& body) const {
    for (const StructureForce& f : simulation_.report().structures)
      if (f.body == &body) return f.of_hand[std::size_t(hand)].norm();
    return 0;
  }
  /// Leans with a tool on a place that gives way: the hand goes from 5 mm before it to `most` behind it, wherever it is
  /// by then, until `enough`.
  template <class Place, class Enough>
  void press(int hand, const Vec3& shaft, const Vec3& direction, Place place, double most, Enough enough,
             const Vec3& across = Vec3::UnitZ()) {
    const auto go_to = [&](double seconds, double depth) {
      Wish w[2] = {hands_.left(), hands_.right()};
      w[hand].pose = tool_pose(place() + depth * direction, shaft, across);
      hands_.move(seconds, w[0], w[1]);
    };
    double depth = -5 * mm, vessel = 0, lobe = 0;
    go_to(0.8, depth);
    bool done = false;
    for (; depth < most && !done; depth += 0.6 * mm) {
      go_to(3 * simulation_.h(), depth);
      vessel = std::max(vessel, force(hand, *artery_));
      if (const Body* b = simulation_.scene().find_as<Body>("frontal")) lobe = std::max(lobe, force(hand, *b));
      done = enough();
    }
    if (done) go_to(0.25, depth + 1.5 * mm);  // enough also where the arms follow a little differently
    std::printf(
        "%6.2f s pressed to %.1f mm: %s; up to %.3f N on the vessel, %.3f N on the frontal lobe, %d strands stand\n",
        hands_.time(), depth / mm, done ? "done" : "as far as it goes", vessel, lobe, Strands(simulation_).left());
  }
  MaterialPoint nearest(const Body& body, const Vec3& at) const {
    MaterialPoint out;
    double least = 1;
    for (Surface* s : simulation_.surfaces())
      if (&s->body() == &body)
        for (const MaterialPoint& p : s->points())
          if (const double d = (body.position(p) - at).norm(); d < least) least = d, out = p;
    return out;
  }
};

}  // namespace
}  // namespace insula

int main(int count, char** arguments) {
  using namespace insula;
  if (count < 3) {
    std::fprintf(stderr, "usage: dissection_motions SCENE FOLDER [steady|rough|reach]\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    const fs::path scene = arguments[1], stem = fs::path(arguments[2]) / scene.stem();
    if (count > 3 && arguments[3] == std::string("reach")) {
      const auto simulation = load(scene);
      Trainer(*simulation).reach();
      return 0;
    }
    for (const std::string id : {"steady", "rough"}) {
      if (count > 3 && id != arguments[3]) continue;
      const fs::path file = stem.string() + "_" + id + ".csv";
      const auto simulation = load(scene);
      Trainer surgeon(*simulation);
      id == "steady" ? surgeon.steady(file) : surgeon.rough(file);
      play(scene, file);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
