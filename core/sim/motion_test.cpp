// SPDX-License-Identifier: GPL-3.0-or-later
// Scripted motions: interpolation against closed forms, and every error of a file.
#include "core/sim/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "core/base/input_error.h"
#include "core/base/this_process.h"

namespace insula {
namespace {

const std::string head = "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n";

std::string motion_error(const std::string& text) {
  try {
    parse_motion(text, "m.csv");
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Motion, InterpolatesLinearlyAndBySlerp) {
  const double c = std::sqrt(0.5);
  const Motion m = parse_motion(head +
                                    "0,left,0,0,0,1,0,0,0,0,1\n"
                                    "1,right,0.5,0,0,1,0,0,0,0,0\n"
                                    "2,left,0.1,-0.2,0.04," +
                                    std::to_string(c) + ",0,0," + std::to_string(c) + ",1,0\n",
                                "m.csv");
  const HandSample a = m.at(0, 0.5);
  EXPECT_NEAR((a.pose.p - Vec3(0.025, -0.05, 0.01)).norm(), 0, 1e-15);
  EXPECT_NEAR((rotation_vector(a.pose.q) - Vec3(0, 0, M_PI / 8)).norm(), 0, 1e-6);
  EXPECT_FALSE(a.button1);
  EXPECT_TRUE(a.button2);
  EXPECT_TRUE(m.at(0, 2.0).button1);
  EXPECT_EQ(m.duration(), 2.0);
  EXPECT_NEAR(m.at(1, 77).pose.p.x(), 0.5, 0);
}

TEST(Motion, ClampsAtItsEnds) {
  const Motion m = parse_motion(head + "1,left,0.1,0,0,1,0,0,0,1,0\n3,left,0.3,0,0,1,0,0,0,0,0\n", "m.csv");
  EXPECT_EQ(m.at(0, -5).pose.p.x(), 0.1);
  EXPECT_TRUE(m.at(0, -5).button1);
  EXPECT_EQ(m.at(0, 9).pose.p.x(), 0.3);
  EXPECT_EQ(m.at(0, std::numeric_limits<double>::quiet_NaN()).pose.p.x(), 0.1);
  EXPECT_FALSE(m.has(1));
  EXPECT_EQ(m.at(1, 0).pose.p, Vec3(0, 0, 0));
}

TEST(Motion, TakesTheShortWayRound) {
  const Motion m = parse_motion(head + "0,left,0,0,0,1,0,0,0,0,0\n1,left,0,0,0,-1,0,0,0,0,0\n", "m.csv");
  EXPECT_NEAR(rotation_vector(m.at(0, 0.5).pose.q).norm(), 0, 1e-12);
}

TEST(Motion, ReadsWindowsLineEndsAndBlankLines) {
  const Motion m = parse_motion(
      "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\r\n\r\n0,right,0,0,0.01,1,0,0,0,0,0\r\n", "m.csv");
  EXPECT_EQ(m.at(1, 0).pose.p.z(), 0.01);
}

TEST(Motion, SaysFileLineAndWhatIsWrong) {
  const std::string good = "0,left,0,0,0,1,0,0,0,0,0\n";
  const std::pair<std::string, std::string> bad[] = {
      {"", "m.csv:1: error: the first line must be"},
      {good, "m.csv:1: error: the first line must be"},
      {head, "m.csv:1: error: no rows"},
      {head + good + "1,left,0,0,0,1,0,0,0,0\n", "m.csv:3: error: 10 fields, expected 11"},
      {head + "0,left,0,0,0,1,0,0,0,0,0,7\n", "m.csv:2: error: 12 fields, expected 11"},
      {head + "0,middle,0,0,0,1,0,0,0,0,0\n", "m.csv:2: error: hand: \"middle\" is neither left nor right"},
      {head + "0,left,12O,0,0,1,0,0,0,0,0\n", "m.csv:2: error: px_m: \"12O\" is not a number"},
      {head + "0,left,,0,0,1,0,0,0,0,0\n", "m.csv:2: error: px_m: \"\" is not a number"},
      {head + "0,left,0,nan,0,1,0,0,0,0,0\n", "m.csv:2: error: py_m must be finite"},
      {head + "0,left,0,1e999,0,1,0,0,0,0,0\n", "m.csv:2: error: py_m: \"1e999\" is not a number"},
      {head + "0,left,0,0,55,1,0,0,0,0,0\n", "m.csv:2: error: pz_m: 55 m is outside the range"},
      {head + "0,left,0,0,0,1,1,0,0,0,0\n", "m.csv:2: error: the quaternion has length 1.41421, expected 1"},
      {head + "0,left,0,0,0,0,0,0,0,0,0\n", "m.csv:2: error: the quaternion has length 0, expected 1"},
      {head + "0,left,0,0,0,1,0,0,0,2,0\n", "m.csv:2: error: button1: \"2\" is neither 0 nor 1"},
      {head + "-1,left,0,0,0,1,0,0,0,0,0\n", "m.csv:2: error: time_s must not be negative"},
      {head + good + good, "m.csv:3: error: time_s of the left hand must rise"},
  };
  for (const auto& [text, expected] : bad)
    EXPECT_NE(motion_error(text).find(expected), std::string::npos) << motion_error(text);
}

TEST(Motion, HoldsCommandsInTheOrderOfTheirTimes) {
  const Motion m = parse_motion(head +
                                    "5,command,ask,applier load straight_9\n"
                                    "0,left,0,0,0,1,0,0,0,0,0\n"
                                    "2.5 , command , exchange , right applier\n"
                                    "5,command,message,\"Now, \"\"gently\"\"\"\n"
                                    "0.5,command,message,one, two\r\n"
                                    "1,left,0.1,0,0,1,0,0,0,0,0\n",
                                "m.csv");
  ASSERT_EQ(m.commands().size(), 4u);
  const MotionCommand expected[] = {{0.5, "message", "one, two"},
                                    {2.5, "exchange", "right applier"},
                                    {5, "ask", "applier load straight_9"},
                                    {5, "message", "Now, \"gently\""}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(m.commands()[i].time_s, expected[i].time_s);
    EXPECT_EQ(m.commands()[i].verb, expected[i].verb);
    EXPECT_EQ(m.commands()[i].argument, expected[i].argument);
  }
  EXPECT_EQ(m.duration(), 5.0);
  EXPECT_EQ(m.keys(0).size(), 2u);
  EXPECT_FALSE(m.has(1));
}

TEST(Motion, MayConsistOfCommandsAlone) {
  const Motion m = parse_motion(head + "3,command,exchange,left dissector\n", "m.csv");
  EXPECT_FALSE(m.empty());
  EXPECT_FALSE(m.has(0) || m.has(1));
  EXPECT_EQ(m.duration(), 3.0);
}

TEST(Motion, RefusesBadCommands) {
  const std::pair<std::string, std::string> bad[] = {
      {"1,command\n", "m.csv:2: error: a command needs a verb and an argument"},
      {"1,command,exchange\n", "m.csv:2: error: a command needs a verb and an argument"},
      {"1,command,exchagne,right a\n",
       "m.csv:2: error: verb: \"exchagne\" is none of exchange, ask, message; did you mean \"exchange\"?"},
      {"1,command,pause,now\n", "m.csv:2: error: verb: \"pause\" is none of"},
      {"1,command,ask,  \n", "m.csv:2: error: ask needs an argument"},
      {"1,command,ask,\"\"\n", "m.csv:2: error: ask needs an argument"},
      {"1,command,ask,\"a b\n", "m.csv:2: error: argument: the closing quote is missing"},
      {"1,command,ask,\"a\" b\n", "m.csv:2: error: argument: text after the closing quote"},
      {"1,command,message,a\x01z\n", "m.csv:2: error: argument: holds a control character"},
      {"1,command,message," + std::string(401, 'x') + "\n", "m.csv:2: error: argument: longer than 400 bytes"},
      {"-1,command,ask,a b\n", "m.csv:2: error: time_s must not be negative"},
      {"x,command,ask,a b\n", "m.csv:2: error: time_s: \"x\" is not a number"},
      {"nan,command,ask,a b\n", "m.csv:2: error: time_s must be finite"},
  };
  for (const auto& [text, expected] : bad)
    EXPECT_NE(motion_error(head + text).find(expected), std::string::npos) << motion_error(head + text);
}

TEST(Motion, ReadsFilesAndNamesMissingOnes) {
  EXPECT_THROW(load_motion("/nowhere/at_all.csv"), InputError);
  EXPECT_THROW(load_motion("/"), InputError);
  const auto file = std::filesystem::temp_directory_path() / ("insula_motion_" + std::to_string(process_id()) + ".csv");
  std::ofstream(file) << head << "0,left,0.01,0.02,0.03,1,0,0,0,0,0\n";
  EXPECT_EQ(load_motion(file).at(0, 0).pose.p, Vec3(0.01, 0.02, 0.03));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace insula
