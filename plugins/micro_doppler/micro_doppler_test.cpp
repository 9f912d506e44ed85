// SPDX-License-Identifier: GPL-3.0-or-later
// The probe against closed forms: a cylinder and a cone by hand, and a tube whose flow the network knows.
#include <numbers>

#include "core/testing/block_mesh.h"
#include "core/testing/held.h"
#include "plugins/blood_flow/network_for_test.h"
#include "plugins/micro_doppler/beam.h"

namespace insula {
namespace {

using std::numbers::pi;
constexpr double tube_radius = 0.0015;  // m

LumenPiece cylinder(double flow) {
  LumenPiece p;
  p.first = true;
  p.a = {Vec3(0, 0, -0.02), tube_radius, flow};
  p.b = {Vec3(0, 0, 0.02), tube_radius, flow};
  return p;
}

/// A beam to the axis of the cylinder, under an angle to it, from 3 mm above.
Beam under(double angle, double gate = 0.02) {
  Beam b;
  b.along = Vec3(std::sin(angle), 0, std::cos(angle));
  b.face = -0.003 / std::sin(angle) * b.along;
  b.farthest = gate;
  return b;
}

TEST(DopplerBeam, FollowsTheCosineOfTheAngle) {
  const double flow = 130 * test::ml_min, speed = flow / (pi * tube_radius * tube_radius);
  for (int degrees = 15; degrees <= 165; degrees += 5) {
    const double angle = degrees * pi / 180;
    const Insonation s = insonate(under(angle), std::array{cylinder(flow)});
    ASSERT_TRUE(s.lumen) << degrees;
    // A beam that goes on with the flow sees blood go away from it.
    EXPECT_TRUE(
        test::held("Doppler: cosine of the angle", std::abs(s.velocity + speed * std::cos(angle)), speed, 1e-12))
        << degrees;
    EXPECT_NEAR(s.depth, 0.003 / std::sin(angle), 1e-12) << degrees;
  }
}

TEST(DopplerBeam, FollowsFlowAndRadius) {
  const Beam beam = under(pi / 3);
  const double one = insonate(beam, std::array{cylinder(1e-6)}).velocity;
  EXPECT_NEAR(insonate(beam, std::array{cylinder(-3e-6)}).velocity, -3 * one, 1e-12);
  LumenPiece wide = cylinder(1e-6);
  wide.a.radius = wide.b.radius = 0.5 * tube_radius;
  EXPECT_NEAR(insonate(beam, std::array{wide}).velocity, 4 * one, 1e-12);
}

TEST(DopplerBeam, AveragesAConeAsTheIntegralOfItsSpeed) {
  LumenPiece cone = cylinder(2e-6);
  cone.b.radius = 0.9 * tube_radius;
  const Beam beam = under(pi / 3);
  const Chord chord = chord_of(beam, cone);
  const int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const Vec3 x = beam.face + (chord.from + (i + 0.5) / steps * (chord.to - chord.from)) * beam.along;
    const double r = tube_radius * (1 - 0.1 * (x.z() + 0.02) / 0.04);
    EXPECT_LT(Vec3(x.x(), x.y(), 0).norm(), r + 1e-12);
    sum += 2e-6 / (pi * r * r);
  }
  const Vec3 axis = Vec3::UnitZ();
  EXPECT_NEAR(insonate(beam, std::array{cone}).velocity, -sum / steps * axis.dot(beam.along), 1e-8);
}

TEST(DopplerBeam, AlongTheAxisItHearsTheWholeSpeed) {
  Beam beam;
  beam.face = Vec3(0.0005, 0, 0.03);
  beam.along = Vec3(0, 0, -1);
  beam.farthest = 0.015;
  const Insonation s = insonate(beam, std::array{cylinder(1e-6)});
  EXPECT_NEAR(s.velocity, 1e-6 / (pi * tube_radius * tube_radius), 1e-12) << "towards the probe";
  EXPECT_NEAR(s.depth, 0.5 * (0.01 + 0.015), 1e-12) << "from the end of the tube to the end of the gate";
}

TEST(DopplerBeam, IsSilentOutsideOfItsGateAndBesideTheVessel) {
  const auto tube = std::array{cylinder(1e-6)};
  const double front = (0.003 - tube_radius) / std::sin(pi / 3);
  EXPECT_FALSE(insonate(under(pi / 3, front - 1e-9), tube).lumen);
  EXPECT_TRUE(insonate(under(pi / 3, front + 1e-9), tube).lumen);
  Beam beyond = under(pi / 3);
  beyond.nearest = (0.003 + tube_radius) / std::sin(pi / 3) + 1e-9;
  EXPECT_FALSE(insonate(beyond, tube).lumen);
  Beam beside = under(pi / 3);
  beside.face.y() = tube_radius + 1e-9;
  EXPECT_FALSE(insonate(beside, tube).lumen);
  beside.face.y() = tube_radius - 1e-9;
  EXPECT_TRUE(insonate(beside, tube).lumen);
  Beam back = under(pi / 3);
  back.along = -back.along;
  EXPECT_FALSE(insonate(back, tube).lumen) << "behind the probe";
  EXPECT_FALSE(insonate(under(pi / 3), {}).lumen);
}

TEST(DopplerBeam, HearsTheVesselBehindAClosedOne) {
  LumenPiece closed = cylinder(0), behind = cylinder(1e-6);
  for (Vec3* x : {&behind.a.centre, &behind.b.centre}) *x += Vec3(0.005, 0, 0);
  Beam beam = under(pi / 3);
  beam.wall_filter = 0.004;
  const Insonation both = insonate(beam, std::array{closed, behind});
  EXPECT_TRUE(both.heard);
  EXPECT_NEAR(both.depth, 0.008 / std::sin(pi / 3), 1e-12);
  const Insonation one = insonate(beam, std::array{closed});
  EXPECT_TRUE(one.lumen);
  EXPECT_FALSE(one.heard);
  EXPECT_NEAR(insonate(beam, std::array{behind, cylinder(2e-6)}).depth, 0.003 / std::sin(pi / 3), 1e-12)
      << "the nearest of those that are heard";
}

TEST(DopplerBeam, ASacHasASizeAndNoDirection) {
  LumenPiece sac = cylinder(0);
  sac.sac = true;
  sac.exchange = 0.3e-6;
  const double mixing = 0.3e-6 / (pi * tube_radius * tube_radius);
  EXPECT_NEAR(insonate(under(pi / 3), std::array{sac}).velocity, mixing, 1e-12);
  EXPECT_TRUE(insonate(under(pi / 3), std::array{sac}).sac);
  for (const double filling : {-0.1e-6, 0.1e-6}) {
    sac.a.flow = sac.b.flow = filling;
    EXPECT_NEAR(insonate(under(pi / 3), std::array{sac}).velocity, mixing * (1 + 0.5 / 3), 1e-12) << filling;
  }
}

TEST(DopplerBeam, ThirtyCentimetresASecondAreFourKilohertz) {
  EXPECT_NEAR(doppler_shift(0.3 * std::cos(pi / 3), 20e6, 1540), 3896.1, 0.1);
  EXPECT_LT(doppler_shift(-0.1, 20e6, 1540), 0);
}

/// The bifurcation of the network's tests, with a probe.
struct ProbedVessel : test::Vessel {
  Instrument* probe = nullptr;
  ProbedVessel() {
    test::TestVessel v;
    v.add_tube("parent", "inlet", "bifurcation", Vec3(0, 0, 0), 0.0014, 0.014, 24, 14);
    v.add_tube("superior", "bifurcation", "superior_outlet", Vec3(0.01, 0, 0), 0.0011, 0.012, 24, 12);
    v.add_tube("sac", "bifurcation", "dome", Vec3(0.03, 0, 0), 0.002, 0.006, 24, 6);
    v.write(folder);
    folder.write("meshes/tool.urdf", test::test_tool_urdf(0.0005));
    load(R"(<scene time_step="10 ms"><solver tolerance="1e-14 m" max_sweeps="2000"/>
  <shell_body id="artery" wall="meshes/vessel.json"><test_wall stiffness="2000 N/m"/></shell_body>
  <blood_flow id="flow" pressure="p" thickness="0 mm"/><pressure id="p" on="artery" heart_rate="60 1/min"/>
  <micro_doppler id="doppler" model="meshes/tool.urdf" hand="right" home="0 0 0 m" shaft="0 0 1" flat="1 0 0"
                 gate_length="4 mm"/></scene>)");
    if (!s) return;
    pressure = &get<BloodPressure>("p");
    flow = &get<BloodFlow>("flow");
    probe = &get<Instrument>("doppler");
  }
  /// Holds the tip 3 mm from the axis of the tube at this place, under an angle to it.
  void hold(const Vec3& on_axis, double angle, double away = 0.003) const {
    HandState hand;
    hand.present = true;
    const Vec3 beam(std::sin(angle), 0, std::cos(angle));
    hand.device.p = on_axis - away / std::sin(angle) * beam;
    hand.device.q = Quat::FromTwoVectors(Vec3(0, 0, -1), beam);
    s->set_hand(1, hand);
  }
  double channel(std::string_view id) const {
    const ChannelEntry* e = s->channels().find(id);
    if (!e) throw std::runtime_error("no such channel");
    return *e->channel->values(e->item);
  }
  double velocity() const { return channel("doppler.doppler_velocity"); }
  /// Of the network: flow of a stretch over its lumen in the middle, m/s.
  double network_speed(std::size_t stretch) const {
    const auto& g = flow->graph();
    for (const Branch& b : g.branches)
      if (b.stretch == int(stretch)) return b.flow / g.stretches[stretch].stations[1].now.area;
    return 0;
  }
};

TEST(MicroDoppler, AgreesWithTheNetworkThroughTheBeat) {
  ProbedVessel t;
  ASSERT_TRUE(t.s) << t.messages;
  double least = 1e300, most = 0;
  for (const double angle : {pi / 3, 2 * pi / 3}) {
    t.hold(Vec3(0, 0, 0.003), angle);
    t.run(100);
    for (int i = 0; i < 100; ++i) {
      t.run(1);
      const double expected = -t.network_speed(0) * std::cos(angle);
      ASSERT_TRUE(
          test::held("Doppler: velocity of the network", std::abs(t.velocity() - expected), std::abs(expected), 1e-6));
      EXPECT_NEAR(t.channel("doppler.doppler_shift"), 2 * 20e6 * t.velocity() / 1540, 1e-6);
      least = std::min(least, std::abs(t.velocity()));
      most = std::max(most, std::abs(t.velocity()));
    }
  }
  EXPECT_GT(most, 1.2 * least) << "the flow beats with the heart";
  EXPECT_GT(least, 0.05);
}

TEST(MicroDoppler, AVesselThatIsShutFallsSilent) {
  ProbedVessel t;
  ASSERT_TRUE(t.s) << t.messages;
  t.hold(Vec3(0.01, 0, 0.009), pi / 3);
  t.run(200);
  EXPECT_LT(t.velocity(), -0.05);
  EXPECT_EQ(t.channel("doppler.insonated"), 1);
  t.squeeze("superior", 0.001, 0.0032, 0.01, 0);
  t.run(300);
  EXPECT_EQ(t.velocity(), 0);
  EXPECT_EQ(t.channel("doppler.insonated"), 1) << "the lumen is there still";
  t.release();
  t.run(300);
  EXPECT_LT(t.velocity(), -0.05);
}

TEST(MicroDoppler, ASacFallsSilentWhenItsNeckIsShut) {
  ProbedVessel t;
  ASSERT_TRUE(t.s) << t.messages;
  t.hold(Vec3(0.03, 0, 0.003), pi / 3, 0.0035);
  t.run(200);
  EXPECT_GT(t.velocity(), 0.01);
  EXPECT_EQ(t.channel("doppler.doppler_mixed"), 1);
  t.squeeze("sac", -0.001, 0.0012, 0.03, 0);
  t.run(300);
  EXPECT_EQ(t.velocity(), 0);
  EXPECT_EQ(t.channel("doppler.doppler_mixed"), 0);
}

TEST(MicroDoppler, HearsNothingFarFromAVesselAndIsUnknownOnTheTray) {
  ProbedVessel t;
  ASSERT_TRUE(t.s) << t.messages;
  t.hold(Vec3(0, 0, 0.003), pi / 3, 0.02);
  t.run(3);
  EXPECT_EQ(t.velocity(), 0);
  EXPECT_EQ(t.channel("doppler.insonated"), 0);
  EXPECT_TRUE(std::isnan(t.channel("doppler.doppler_depth")));
  EXPECT_EQ(t.probe->activity(), 0);
  t.probe->lay_down();
  t.run(1);
  EXPECT_TRUE(std::isnan(t.velocity()));
  EXPECT_TRUE(std::isnan(t.channel("doppler.doppler_shift")));
}

TEST(MicroDoppler, ReplaysWithTheSameBits) {
  ProbedVessel t;
  ASSERT_TRUE(t.s) << t.messages;
  std::vector<double> first, second;
  for (auto* heard : {&first, &second}) {
    t.s->reset();
    for (int i = 0; i < 150; ++i) {
      t.hold(Vec3(0, 0, 0.002 + 1e-5 * i), pi / 3);
      t.run(1);
      heard->push_back(t.velocity());
    }
  }
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace insula
