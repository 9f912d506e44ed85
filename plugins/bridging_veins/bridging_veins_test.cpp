// SPDX-License-Identifier: GPL-3.0-or-later
// Veins are kept out of the strands to divide; a torn one bleeds at its rate, and what it bleeds stands in the field.
#include "plugins/bridging_veins/bridging_veins.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/sim/report.h"
#include "core/testing/example.h"

namespace insula {
namespace {

constexpr double ml = 1e-6, h = 0.0166667;

std::unique_ptr<Simulation> example(const std::string& strength) {
  const auto file = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/bridging_veins/example.xml";
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  std::string xml = text.str();
  const std::string written = "strength=\"0.2 N\"";
  xml.replace(xml.find(written), written.size(), "strength=\"" + strength + "\"");
  return test::load_text(xml, file);
}

TEST(BridgingVeins, WholeOnesHoldAndAreNoStrandsToDivide) {
  const auto s = example("50 N");
  ASSERT_TRUE(s);
  const auto* veins = s->scene().find_as<BridgingVeins>("veins");
  ASSERT_GE(veins->count(), 2);
  for (int i = 0; i < 30; ++i) s->step();
  EXPECT_EQ(veins->veins_parted(), 0);
  EXPECT_EQ(veins->volume(), 0);
  EXPECT_EQ(Strands(*s).total(), 0);
  // Two lines a vein, which meet in the middle.
  ASSERT_EQ(veins->veins.count(), 2 * veins->count());
  const std::vector<float>& data = veins->veins.data();
  const std::size_t line = data.size() / std::size_t(veins->veins.count());
  for (std::size_t at = 0; at < data.size(); at += 2 * line)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(data[at + line - 4 + k], data[at + 2 * line - 4 + k]);
}

TEST(BridgingVeins, TornOnesBleedAtTheirRate) {
  const auto s = example("0.0001 N");  // shorter than the gap (slack 0.9), they tear in the first step
  ASSERT_TRUE(s);
  const auto* veins = s->scene().find_as<BridgingVeins>("veins");
  int torn = 0;
  const int steps = 60;
  for (int i = 0; i < steps; ++i) {
    s->step();
    for (const Event& e : s->events()) torn += e.kind == "vein_parted" && e.hand < 0;
  }
  EXPECT_EQ(torn, veins->count());
  EXPECT_EQ(veins->veins_parted(), veins->count());
  // dV/dt = veins * 4 ml/min - 1 ml/min, from the end of the first step on.
  EXPECT_NEAR(veins->volume(), steps * h * (4 * veins->count() - 1) * ml / 60, 1e-3 * veins->volume());
  s->reset();
  EXPECT_EQ(veins->volume(), 0);
  EXPECT_EQ(veins->veins_parted(), 0);
}

}  // namespace
}  // namespace insula
