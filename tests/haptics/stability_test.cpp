// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a hand against something hard comes to rest, whatever the arm, the person and the engine's rate; and how
// stiff a wall may be. INSULA_SOAK=1: a minute each, all combinations, and the table of the manual.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <set>

#include "core/mechanics/instrument.h"
#include "tests/haptics/hand_rig.h"

namespace insula::test {
namespace {

bool soak() { return std::getenv("INSULA_SOAK") != nullptr; }

/// Rigid tools against a wall, so that the hand feels only the coupling.
constexpr double stiffest_N_m = 500;
/// What a hand may have had out of its arrival at the wall, however long it then stays, J: a tenth of a newton's way of
/// a tenth of a millimetre.
constexpr double enough_J = 1e-5;

TEST(Stability, NoExerciseHasAStifferToolInAHand) {
  double most = 0;
  for (const char* name : {"1_sylvian_fissure", "2_aneurysm_dissection", "3_clipping", "4_rupture"}) {
    const auto s = load(std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training" / (std::string(name) + ".xml"));
    ASSERT_TRUE(s);
    for (const Instrument* i : s->instruments())
      if (i->hand_index() >= 0) most = std::max(most, i->coupling());
  }
  EXPECT_DOUBLE_EQ(most, stiffest_N_m);
}

/// What a person's own spring and damper leave of a swing after so long, if nothing feeds it.
double own_decay(const Person& p, double seconds) {
  const double w2 = p.stiffness_N_m / p.mass_kg, b = p.damping_Ns_m / (2 * p.mass_kg);
  const double slowest = b * b > w2 ? b - std::sqrt(b * b - w2) : b;
  return std::exp(-slowest * seconds);
}

/// The person's own swing may not have died yet; nothing else moves the hand farther than the encoder sees.
bool at_rest(const Pressed& r, const Press& what, const Person& person) {
  return r.last_speed < r.first_speed * (0.1 + own_decay(person, what.seconds - 2.3)) ||
         r.swing < omni_profile().resolution_m;
}

void expect_rest(const Press& what, const Person& person) {
  SCOPED_TRACE(testing::Message() << what.engine_Hz << " Hz, coupling " << what.coupling_N_m << " N/m, "
                                  << person.mass_kg << " kg, " << person.damping_Ns_m << " N s/m, "
                                  << person.stiffness_N_m << " N/m");
  const Pressed r = press(what, person);
  ASSERT_TRUE(std::isfinite(r.swing));
  EXPECT_GT(r.force, 0.02) << "it touches";
  EXPECT_TRUE(at_rest(r, what, person)) << "speed " << r.first_speed << " then " << r.last_speed << " m/s, swing "
                                        << r.swing;
  EXPECT_LT(r.last_energy, enough_J) << "more was given back than put in, J; at most " << r.max_energy;
}

TEST(Stability, ArmsAndHandsAtEveryRateOfTheEngine) {
  for (const double rate : {25.0, 60.0, 120.0})
    for (const double coupling : {250.0, stiffest_N_m})
      for (const double mass : {0.05, 0.3, 2.0})
        for (const double damping : {1.0, 7.0, 50.0})
          for (const double stiffness : {50.0, 300.0, 2000.0}) {
            if (!soak() && rate == 60 && coupling != stiffest_N_m) continue;
            Press p;
            p.engine_Hz = rate;
            p.coupling_N_m = coupling;
            p.seconds = soak() ? 60 : 5;
            expect_rest(p, {mass, damping, stiffness});
            if (testing::Test::HasFatalFailure()) return;
          }
}

/// Tissue with inertia of its own between steps gives no hand energy, however light, stiff or weakly damped it is.
TEST(Stability, ArmsAndHandsOnTissueWithAReducedModel) {
  for (const double rate : {30.0, 60.0, 240.0})
    for (const double coupling : {250.0, stiffest_N_m})
      for (const Person& person :
           {Person{0.05, 1, 50}, Person{0.05, 1, 2000}, Person{0.3, 7, 300}, Person{2, 50, 2000}}) {
        Press p;
        p.soft = true;
        p.engine_Hz = rate;
        p.coupling_N_m = coupling;
        p.depth_m = 5e-3;
        SCOPED_TRACE(testing::Message() << rate << " Hz, coupling " << coupling << " N/m, " << person.mass_kg << " kg, "
                                        << person.damping_Ns_m << " N s/m, " << person.stiffness_N_m << " N/m");
        const Pressed r = press(p, person);
        EXPECT_GT(r.modelled, 100) << "problems with a model";
        EXPECT_GT(r.force, 0.01) << "it touches";
        EXPECT_TRUE(at_rest(r, p, person))
            << "speed " << r.first_speed << " then " << r.last_speed << " m/s, swing " << r.swing;
        EXPECT_LT(r.last_energy, enough_J) << "more was given back than put in, J; at most " << r.max_energy;
      }
}

TEST(Stability, AHandThatDrawsAToolAlongAWall) {
  for (const double rate : {25.0, 120.0})
    for (const Person& person : {Person{0.05, 1, 400}, Person{0.125, 10, 400}, Person{2, 20, 400}}) {
      Press p;
      p.engine_Hz = rate;
      p.coupling_N_m = stiffest_N_m;
      p.slide_m_s = 0.002;
      p.seconds = 6;
      const Pressed r = press(p, person);
      EXPECT_LT(r.last_speed, 2e-3) << rate << " Hz, " << person.mass_kg << " kg";
      EXPECT_LT(r.last_energy, 0) << "friction only takes";
    }
}

/// The stiffest coupling, of those 1.25 apart, that comes to rest with all softer ones.
double z_width(const Person& person, double rate, bool held) {
  double best = 0;
  for (double coupling = 20; coupling < 5000; coupling *= 1.25) {  // what a scene may ask for
    Press p;
    p.engine_Hz = rate;
    p.coupling_N_m = coupling;
    p.held = held;
    p.seconds = 4;
    const Pressed r = press(p, person);
    EXPECT_GT(r.force, 0.02) << "it touches";
    if (!at_rest(r, p, person) || !(r.last_energy < enough_J)) break;
    best = coupling;
  }
  return best;
}

TEST(Stability, WallsAreStifferThanWithAHeldForce) {
  struct Case {
    const char* name;
    Person person;
  };
  const std::vector<Case> cases{{"let go of", {0.05, 1, 50, 0}},
                                {"loosely held", {0.125, 3, 150, 0}},
                                {"held", {0.125, 10, 400, 0}},
                                {"held firmly", {0.3, 30, 1000, 0}}};
  for (const Case& c : cases)
    for (const double rate : {30.0, 60.0}) {
      if (!soak() && (rate != 30 || c.person.stiffness_N_m > 200)) continue;
      const double ours = z_width(c.person, rate, false), held = z_width(c.person, rate, true);
      if (soak()) std::printf("    %-14s %3.0f Hz: %5.0f N/m, with a held force %5.0f\n", c.name, rate, ours, held);
      EXPECT_GT(ours, (rate < 60 ? 3 : 1.5) * held) << c.name << " at " << rate;
    }
}

}  // namespace
}  // namespace insula::test
